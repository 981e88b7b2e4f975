"""Which students on a roster a submission belongs to: by an LMS's id, any other id, or a full name, in this order."""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from grader.classroom.roster import Student, plain

CERTAIN = 1  # the rank of an id as it is spelt; an LMS's own has 0
GROUP, _UNCLEAR = 4, 5
_MAX_WORDS = 8


class Match(NamedTuple):
    """The indices of the students that a submission may belong to, of a group to each; `rank` grows with the doubt."""

    students: tuple[int, ...] = ()
    rank: int = 0

    @property
    def is_certain(self) -> bool:
        """Whether it belongs to one student, or to each of a group."""
        return bool(self.students) and (self.rank == GROUP or (len(self.students) == 1 and self.rank < GROUP))


class People:
    """The students on a roster, by ids, names and groups."""

    def __init__(self, students: Sequence[Student]) -> None:
        self.students = students
        self._tables: tuple[dict[str, tuple[int, ...]], ...] = ({}, {}, {}, {})
        self._groups: dict[str, list[int]] = defaultdict(list)
        for index, one in enumerate(students):
            own = (index,)  # kept once for all words that only this student has
            ids = [one.key, one.login, one.sis, one.email, *one.aliases]
            names = [plain(one.name), plain(one.email.partition("@")[0]), _surname(one.name), *_in_canvas(one.name)]
            for words, table in zip((_numbers(one), ids, map(plain, ids), names), self._tables, strict=True):
                for word in {unicodedata.normalize("NFC", word) for word in words if word}:
                    table[word] = table[word] + own if word in table else own
            for name in {plain(one.group or one.section), letters(one.group or one.section)} - {""}:
                self._groups[name].append(index)

    def knows(self, name: str, team: str = "") -> bool:
        """Return whether a name is that of one student, in a team also the surname, or of a group."""
        return self.knows_student(name, team) or (not team and plain(name) in self._groups)

    def knows_student(self, name: str, team: str = "") -> bool:
        """Return whether a name is that of one student."""
        return self._person(Student(name, login=name, group=team)).is_certain

    def match(self, claim: Student) -> Match:
        """Return whose a submission is by what its name claims; with a `group`, only of a member of that team.

        Named like a group, it belongs to that only if its id of Canvas is a member's, or no member has one, and if its
        number in Moodle, that of the group, is no participant's. Of `aliases` it is not clear which is the user's id.
        """
        if claim.aliases:
            users = {index for user in claim.aliases for index in self._tables[0].get(f"canvas {user}", ())}
            return Match(tuple(sorted(users)), _UNCLEAR)
        found, name = self._person(claim), letters(claim.name) if claim.canvas else plain(claim.name or claim.login)
        group = () if claim.group else tuple(self._groups.get(name, ()))
        if not group:
            return found
        if found.students and found.rank == 0:
            owner = found.students[0]
            own = self.students[owner].name
            if name in (plain(own), *_in_canvas(own)) or (claim.canvas and owner not in group):
                return found
            return Match(group, GROUP) if claim.canvas else Match((*found.students, *group), _UNCLEAR)
        if claim.canvas and (found.students or any(self.students[index].canvas for index in group)):
            return Match((*found.students, *group), _UNCLEAR)
        return found if found.students else Match(group, GROUP)

    def _person(self, claim: Student) -> Match:
        """Return the students with the best of the words in a claim, without those whom the LMS knows by another id."""
        login, team = plain(claim.login), self._groups.get(plain(claim.group), ()) if claim.group else None
        names = [plain(claim.name), login, _surname(login) if claim.group else ""]
        names = [letters(claim.name)] if claim.canvas else names
        ranked = (_numbers(claim), [unicodedata.normalize("NFC", claim.login)], [login], names)
        for rank, (words, table) in enumerate(zip(ranked, self._tables, strict=True)):
            found = {index for word in words for index in table.get(word, ()) if team is None or index in team}
            if found:
                return Match(tuple(sorted(at for at in found if not _is_other(self.students[at], claim))), rank)
        return Match()


def _is_other(one: Student, claim: Student) -> bool:
    """Return whether the LMS knows a student by another id than that in a claim."""
    ids = ((one.canvas, claim.canvas), (one.moodle, claim.moodle))
    return any(own and given and own != given for own, given in ids)


def _numbers(one: Student) -> list[str]:
    return [f"{lms} {number}" for lms, number in (("canvas", one.canvas), ("moodle", one.moodle)) if number]


def _surname(name: str) -> str:
    last, comma, _ = name.partition(",")
    word = plain(last if comma else last.rpartition(" ")[2])
    return f"surname\n{word}" if word else ""


def letters(name: str) -> str:
    """Return a name as Canvas writes it into names of files (canvas-lms, content_zipper.rb)."""
    composed = re.sub(r"_(\d+)_", r"\1", unicodedata.normalize("NFC", name))
    letters = re.sub(r"\W", "", composed).casefold()
    return f"canvas\n{letters}" if letters else ""


def _in_canvas(name: str) -> Iterable[str]:
    """Return what Canvas may call a student in names of files: sorted by any word of the name, or as the user set."""
    words = name.split()[:_MAX_WORDS]
    orders = [name] if "," in name else [" ".join(words[index:] + words[:index]) for index in range(len(words))]
    return map(letters, orders)
