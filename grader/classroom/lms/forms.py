"""The grade files of learning management systems as a table.

It says what is where in each, and what its import does.

Canvas (lib/gradebook_importer.rb, gradebook_exporter.rb) does not translate headers, and imports
empty cells as well. Moodle (mod/assign/feedback/offline, mod/assign/gradingtable.php) has the
site's language and a fixed order; it skips a grade that is empty, locked or above the maximum, and
imports every comment. Blackboard: "Work offline with grade data", help.blackboard.com. Brightspace
has # before ids: "Importing grades", community.d2l.com, 3538. Neither says what an empty cell does.
"""

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

IDS = ("login", "sis", "email", "canvas", "moodle")
# those of Moodle as the language packs have them (assign.php), as far as they were looked up
_COLUMNS = {
    "login": "username | sis login id",
    "sis": "sis user id | student id | orgdefinedid | id number | id-nummer",
    "email": "email | email address | e-mail-adresse | adresse de courriel | dirección de correo | "
    "indirizzo email"
    " | endereço de email | e-mailadres",
    "name": (
        "student | full name | vollständiger name | nom complet | nombre completo | nome "
        "completo | volledige naam"
    ),
}


class Form(NamedTuple):
    """A grade file of an LMS. With a column `maximum`, the grade is in the column before it."""

    lms: str
    columns: Mapping[str, str]  # the headers of each role in lower case, besides those of all files
    needed: Sequence[str]  # the roles that a file must have
    grade: re.Pattern[
        str
    ]  # the header of an assignment; groups: `title`, perhaps `number` and `maximum`
    kept: Sequence[str] = ()  # headers that stay beside those of roles if other columns go
    excuse: str = ""  # in place of points
    locked: Mapping[
        str, str
    ] = {}  # a row keeps its grade if the cell of a role is among these words, in lower case
    above: str = ""  # what to do about points above the maximum, where these are refused

    def roles(self, titles: Sequence[str]) -> dict[str, int]:
        """Return the columns of a file by role; of several the first."""
        columns = (*_COLUMNS.items(), *self.columns.items())
        role_of = {header: role for role, headers in columns for header in headers.split(" | ")}
        return {
            role: at
            for at, title in reversed(list(enumerate(titles)))
            if (role := role_of.get(title.casefold()))
        }


_CANVAS = Form(
    "Canvas",
    {"canvas": "id", "section": "section"},
    ("canvas", "section"),
    re.compile(r"(?P<title>.*\S)\s+\((?P<number>[0-9]+)\)", re.DOTALL),
    kept=("lastname", "firstname", "integration id", "root account"),
    excuse="EX",
    locked={"grade": "ex n/a"},
)
_MOODLE = Form(
    "Moodle",
    {
        "moodle": "identifier | id | identifiant | identificador | identificativo | identificatie",
        "maximum": "maximum grade | bestwertung | note maximale | calificación máxima"
        " | valutazione massima | nota máxima | maximaal cijfer",
        "locked": "grade can be changed | bewertung kann geändert werden"
        " | la note peut être modifiée"
        " | la calificación puede ser cambiada | la calificación puede cambiarse"
        " | la valutazione può essere cambiata"
        " | a nota pode ser alterada. | nota pode ser alterada",
        "comment": "feedback comments | feedback als kommentar | feedback par commentaires"
        " | comentarios de retroalimentación | commenti | comentários de feedback | feedback",
    },
    ("moodle", "maximum"),
    re.compile("(?P<title>.*)", re.DOTALL),
    above="raise the maximum there, or give a final mark",
    locked={"locked": "no nein non não nee"},
)
_BLACKBOARD = Form(
    "Blackboard",
    {},
    (),
    # Not a total, which cannot be filled: Total [Total Pts: up to 100 Score] |123457
    re.compile(
        (
            r"(?P<title>.*?) \[Total Pts: (?P<maximum>[0-9.,]+)(?: [^][]*)?\](?: "
            r"\|(?P<number>[0-9]+))?"
        ),
        re.DOTALL,
    ),
    kept=("last name", "first name", "child course id", "last access", "availability"),
)
_BRIGHTSPACE = Form(
    "Brightspace",
    {},
    (),
    re.compile(
        r"(?P<title>.*?) Points Grade(?: <Numeric MaxPoints:(?P<maximum>[0-9.,]++)[^<>]*+>)?",
        re.DOTALL,
    ),
    kept=("last name", "first name", "end-of-line indicator"),
)
FORMS = {form.lms.lower(): form for form in (_CANVAS, _MOODLE, _BLACKBOARD, _BRIGHTSPACE)}
