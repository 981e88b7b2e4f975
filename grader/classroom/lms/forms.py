"""The grade files of learning management systems as a table: what is where in each, and what its import does.

Canvas (lib/gradebook_importer.rb, gradebook_exporter.rb) does not translate headers, imports empty cells as well, and
writes a name that begins with = as ="...". Moodle (mod/assign/feedback/offline, mod/assign/gradingtable.php) has the
site's language and a fixed order; it skips a grade that is empty, locked or above the maximum, and imports every
comment; a suspended student's name is in a span. Blackboard: "Work offline with grade data", help.blackboard.com.
Brightspace has # before ids: "Importing grades", community.d2l.com, 3538. Neither says what an empty cell does.
"""

import html
import re
from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

from grader.classroom.roster import Student
from grader.classroom.tables import TableRow

IDS = ("login", "sis", "email", "canvas", "moodle")
WHO = ("name", "last", "first", *IDS)
TEST_STUDENT = re.compile(r"(?i)student, test|test student|.*_previewuser\d*(, .*)?")  # of Canvas and Blackboard
_GUARD = re.compile(r'="(.*)"', re.DOTALL)
_TAG = re.compile(r"<[^<>]*+>")


class Form(NamedTuple):
    """A grade file of an LMS: `columns` are the headers of each role in lower case, `needed` names roles that it has.

    `grade` matches the header of an assignment, with the groups `title`, and perhaps `number` and `maximum`; else the
    maximum is in the row that begins with `points_row`. With a column `maximum`, the grade is in the column before it.
    A row keeps its grade if one of its cells is in `locked`, in lower case by role; `above` is what to do about points
    above the maximum, where these are refused.
    """

    lms: str
    columns: Mapping[str, str]
    needed: tuple[str, ...]
    grade: re.Pattern[str]
    clean: Callable[[str], str] = str.strip
    points_row: str = ""
    excuse: str = ""
    locked: Mapping[str, tuple[str, ...]] = {}
    above: str = ""

    def roles(self, titles: Sequence[str]) -> dict[str, int]:
        """Return the columns of a file by role; of several the first."""
        role_of = {header: role for role, headers in self.columns.items() for header in headers.split(" | ")}
        return {role: at for at, title in reversed([*enumerate(titles)]) if (role := role_of.get(title.casefold()))}

    def student(self, row: TableRow, roles: Mapping[str, int]) -> Student:
        """Return the student in a row."""
        value = {role: self.clean(row.value(roles.get(role))) for role in WHO}
        name = value["name"] or ", ".join(filter(None, (value["last"], value["first"])))
        number = re.split(r"\D", value["moodle"])[-1]  # of Participant 123, in any language
        return Student("", name, value["email"], value["login"], value["sis"], value["canvas"], number)


CANVAS = Form(
    "Canvas",
    {
        "canvas": "id", "sis": "sis user id", "login": "sis login id", "name": "student", "last": "lastname",
        "first": "firstname", "section": "section", "integration": "integration id", "account": "root account",
    },
    ("name last", "canvas", "section"),
    re.compile(r"(?P<title>.*\S)\s+\((?P<number>[0-9]+)\)", re.DOTALL),
    clean=lambda text: _GUARD.sub(r"\1", text),
    points_row="Points Possible",
    excuse="EX",
    locked={"grade": ("ex", "n/a")},
)  # fmt: skip
MOODLE = Form(
    "Moodle",
    {  # as the language packs have them (assign.php, assignfeedback_comments.php), as far as they were looked up
        "moodle": "identifier | id | identifiant | identificador | identificativo | identificatie",
        "name": "full name | vollständiger name | nom complet | nombre completo | nome completo | volledige naam",
        "email": "email address | e-mail-adresse | adresse de courriel | dirección de correo | indirizzo email"
        " | endereço de email | e-mailadres",
        "sis": "id number | id-nummer",
        "login": "username",
        "maximum": "maximum grade | bestwertung | note maximale | calificación máxima | valutazione massima"
        " | nota máxima | maximaal cijfer",
        "locked": "grade can be changed | bewertung kann geändert werden | la note peut être modifiée"
        " | la calificación puede ser cambiada | la calificación puede cambiarse"
        " | la valutazione può essere cambiata | a nota pode ser alterada. | nota pode ser alterada",
        "comment": "feedback comments | feedback als kommentar | feedback par commentaires"
        " | comentarios de retroalimentación | commenti | comentários de feedback | feedback",
    },
    ("moodle", "maximum"),
    re.compile("(?P<title>.*)", re.DOTALL),
    clean=lambda text: " ".join(html.unescape(_TAG.sub(" ", text)).split()),
    above="raise the maximum there, or give a final mark",
    locked={"locked": ("no", "nein", "non", "não", "nee")},
)
BLACKBOARD = Form(
    "Blackboard",
    {
        "login": "username", "sis": "student id", "email": "email", "last": "last name", "first": "first name",
        "course": "child course id", "access": "last access", "availability": "availability",
    },
    ("login sis",),
    # Not a total, which cannot be filled: Total [Total Pts: up to 100 Score] |123457
    re.compile(r"(?P<title>.*?) \[Total Pts: (?P<maximum>[0-9.,]+)(?: [^][]*)?\](?: \|(?P<number>[0-9]+))?", re.DOTALL),
)  # fmt: skip
BRIGHTSPACE = Form(
    "Brightspace",
    {
        "login": "username", "sis": "orgdefinedid", "email": "email", "last": "last name", "first": "first name",
        "end": "end-of-line indicator",
    },
    ("login sis",),
    re.compile(r"(?P<title>.*?) Points Grade(?: <Numeric MaxPoints:(?P<maximum>[0-9.,]+)[^>]*>)?", re.DOTALL),
    clean=lambda text: text.removeprefix("#"),
)  # fmt: skip
FORMS = {form.lms.lower(): form for form in (CANVAS, MOODLE, BLACKBOARD, BRIGHTSPACE)}
