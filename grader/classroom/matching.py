"""Find out which student is meant: one matcher for class folders, rosters, gradebooks, LMS files and typed names.

A student is identified by clues. The first kind of clue with a match decides; if it matches several students, or one
whom an LMS knows by another id, the match is ambiguous and no student is chosen. Spelling is normalised in one place
(`clues_of`, `claims_of`).
"""

import re
import unicodedata
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from functools import lru_cache
from typing import NamedTuple

from grader.classroom.students import Student
from grader.text import printable_path

# canvas-lms, app/models/user.rb, SUFFIXES: the sortable name of John Doe Jr. is Doe, John, Jr.
_SUFFIX = re.compile(r"(sn?r|senior|jn?r|junior|i{2,3}|iv|vi?|esq|esquire)\.?", re.IGNORECASE)
_IGNORED_CHARACTERS = str.maketrans("", "", "&<>\"`|':\\/")
_ASCII_OTHERS = re.compile(r"[^0-9A-Za-z_]+")
_WORD_CATEGORIES = frozenset({"Lu", "Ll", "Lt", "Lm", "Lo", "Mn", "Mc", "Me", "Nd", "Pc"})
_MAX_WORDS = 8


class Clue(IntEnum):
    """The kinds of data that identify a student, the most reliable first."""

    CANVAS = 0  # the user id
    MOODLE = 1  # the participant id
    EXACT_ID = 2  # key, login, SIS id or email address, exactly
    ANY_CASE = 3  # the same in upper or lower case
    LOCAL_PART = 4  # of an email address
    CANVAS_NAME = 5  # a full name as Canvas writes it into file names
    NAME = 6
    SURNAME = 7
    PATH = 8  # where the submission was in an earlier run


Clues = Mapping[Clue, Collection[str]]
LMS_IDS = (Clue.CANVAS, Clue.MOODLE)
_NAMES = (Clue.CANVAS_NAME, Clue.NAME, Clue.SURNAME)
CERTAIN = Clue.EXACT_ID  # a match by this kind or a more reliable one is certain
OF_FOLDERS = tuple(clue for clue in Clue if clue < Clue.SURNAME)  # for the name of a submission
OF_TEAM_FOLDERS = (*OF_FOLDERS, Clue.SURNAME)
OF_RECORDS = (*LMS_IDS, Clue.EXACT_ID, Clue.ANY_CASE, Clue.NAME, Clue.CANVAS_NAME)  # for two lists of students


class Match(NamedTuple):
    """The positions of the people that the first matching kind of clue finds.

    `contradicted` are those whom it finds as well, but whom an LMS knows by another id.
    """

    people: tuple[int, ...]
    clue: Clue = Clue.SURNAME
    contradicted: tuple[int, ...] = ()

    @property
    def only(self) -> int | None:
        """The only match; None if there is none or several."""
        return self.people[0] if len(self.people) == 1 else None


class People:
    """An index of people by their clues."""

    def __init__(self, people: Iterable[Clues]) -> None:
        self.clues = tuple(people)
        self._tables: dict[Clue, dict[str, tuple[int, ...]]] = {clue: {} for clue in Clue}
        for index, clues in enumerate(self.clues):
            for clue, values in clues.items():
                table = self._tables[clue]
                for value in values:
                    table[value] = (*table.get(value, ()), index)

    def find(self, claims: Clues, kinds: Sequence[Clue] = OF_FOLDERS, among: Collection[int] | None = None) -> Match:
        """Find people by clues, among all or among the positions in `among`; `kinds` are tried in order."""
        for clue in kinds:
            table = self._tables[clue]
            found = {index for value in claims.get(clue, ()) for index in table.get(value, ())}
            if among is not None:
                found.intersection_update(among)
            if found:
                against = {index for index in found if _contradict(claims, self.clues[index], by_name=clue in _NAMES)}
                return Match(tuple(sorted(found - against)), clue, tuple(sorted(against)))
        return Match(())


def clues_of(student: Student, aliases: Iterable[str] = ()) -> Clues:
    """Return the clues in a record: a row of a roster or LMS file, or a student of the gradebook."""
    local_part, at, _ = student.email.partition("@")
    words = {_compose(word.strip()) for word in (student.key, student.login, student.sis, student.email, *aliases)}
    return _present(
        {
            Clue.CANVAS: (student.canvas,),
            Clue.MOODLE: (student.moodle,),
            Clue.EXACT_ID: words,
            Clue.ANY_CASE: {plain_word(word) for word in words},
            Clue.LOCAL_PART: {plain_word(local_part)} if at else (),
            Clue.CANVAS_NAME: set(canvas_names(student.name)),
            Clue.NAME: {plain_name(student.name), plain_name(printable_path(student.name))},
            Clue.SURNAME: (surname(student.name),),
        }
    )


def claims_of(student: Student) -> Clues:
    """Return the clues in the name of a submission, or in what a person types: a word may be any kind of id."""
    words = {_compose(word) for word in (student.key, student.login, student.name if student.team else "")}
    lower = {plain_word(word) for word in words}
    in_canvas = student.key.rpartition("_")[0] if student.readings else ""
    return _present(
        {
            Clue.CANVAS: (student.canvas, *(number for _, number in student.readings)),
            Clue.MOODLE: (student.moodle,),
            Clue.EXACT_ID: words,
            Clue.ANY_CASE: lower,
            Clue.LOCAL_PART: lower,
            Clue.CANVAS_NAME: (canvas_name(in_canvas),),
            Clue.NAME: {plain_name(student.name), plain_name(student.key)},
            Clue.SURNAME: (plain_name(student.name or student.key),),
        }
    )


def lms_ids_of(student: Student) -> Clues:
    """Return only the ids that an LMS gives a student."""
    return _present({Clue.CANVAS: (student.canvas,), Clue.MOODLE: (student.moodle,)})


def _present(clues: Mapping[Clue, Collection[str]]) -> Clues:
    return {clue: kept for clue, values in clues.items() if (kept := {value for value in values if value})}


def _compose(word: str) -> str:
    return word if word.isascii() else unicodedata.normalize("NFC", word)


def _contradict(left: Clues, right: Clues, *, by_name: bool) -> bool:
    """Return whether two are different people: ids of an LMS differ or, for the same name, are of different LMS."""
    shared = [set(left[clue]).intersection(right[clue]) for clue in LMS_IDS if clue in left and clue in right]
    has_ids = all(any(clue in one for clue in LMS_IDS) for one in (left, right))
    return not all(shared) or (by_name and has_ids and not shared)


def plain_word(word: str) -> str:
    """Normalise a login, id or address: case, spaces and the encoding of accents are ignored."""
    if word.isalnum() and word.isascii():
        return word.lower()
    return " ".join(_compose(word).casefold().split())


def plain_name(name: str) -> str:
    """Normalise a full name: compatible characters, case and spaces; `Doe, Jane` becomes `jane doe`.

    Apostrophes and similar characters are ignored: Moodle removes them from file names (moodlelib.php, PARAM_FILE).
    """
    words = name.casefold().replace("_", " ")
    if not words.isascii():
        words = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", name).casefold()).replace("_", " ")
        words = "".join(letter for letter in words if unicodedata.category(letter) != "Cf")  # direction marks
    last, comma, first = words.translate(_IGNORED_CHARACTERS).partition(",")
    return " ".join(f"{first} {last}".split()) if comma else " ".join(last.split())


def plain_group(name: str) -> str:
    """Normalise the name of a group or team: case is ignored, and a space, `_` and `-` are the same."""
    return " ".join(plain_word(name).replace("_", " ").replace("-", " ").split())


def word_characters(text: str) -> str:
    """Return the word characters of Ruby, in which Canvas is written: letters, marks, digits and connectors."""
    if text.isascii():
        return _ASCII_OTHERS.sub("", text)
    return "".join(letter for letter in text if unicodedata.category(letter) in _WORD_CATEGORIES)


@lru_cache(maxsize=1024)
def canvas_name(sortable: str) -> str:
    """Normalise a sortable name as Canvas writes it into file names (canvas-lms, content_zipper.rb)."""
    plain = unicodedata.normalize("NFC", re.sub(r"_(\d+)_", r"\1", sortable))
    return word_characters(plain).casefold()


def canvas_names(name: str) -> Iterator[str]:
    """Yield what Canvas may call a student in file names: sorted by the last word of the name, or as the user set."""
    if "," in name:
        yield canvas_name(name)
        return
    words = name.split()[:_MAX_WORDS]
    for index in range(len(words)):
        yield canvas_name("".join(words[index:] + words[:index]))
    if len(words) > 2 and _SUFFIX.fullmatch(words[-1]):
        *given, last, suffix = words
        yield canvas_name("".join([last, *given, suffix]))


def surname(name: str) -> str:
    """Return the surname in a full name: the words before a comma, or the last word."""
    last, comma, _ = name.partition(",")
    words = last.split()
    return plain_name(last) if comma else plain_name(words[-1] if words else "")
