"""Which students on a roster a submission belongs to: by an LMS's id, any other id, or a full name, in this order."""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from grader.classroom.roster import Student, plain

CERTAIN = 1  # the rank of an id as it is spelt; an LMS's own has 0
_MAX_WORDS = 8
Words = tuple[Iterable[str], ...]


class Match(NamedTuple):
    """The indices of the students that a submission may belong to: of one, or of a group; several others are no match.

    `rank` grows with the doubt.
    """

    students: tuple[int, ...]
    rank: int = 0
    is_group: bool = False


class People:
    """The students on a roster, by ids, names and groups."""

    def __init__(self, students: Sequence[Student]) -> None:
        self.students = students
        self._tables: tuple[dict[str, list[int]], ...] = tuple(defaultdict(list) for _ in range(4))
        self._groups: dict[str, list[int]] = defaultdict(list)
        for index, one in enumerate(students):
            for words, table in zip(_words_of(one), self._tables, strict=True):
                for word in {*words} - {""}:
                    table[word].append(index)
            if team := one.group or one.section:
                for name in {plain(team), f"canvas\n{letters(team)}"}:
                    self._groups[name].append(index)

    def knows(self, name: str, team: str = "") -> bool:
        """Return whether a name is that of one student (in a team also the surname), or of a group."""
        return self.knows_student(name, team) or (not team and plain(name) in self._groups)

    def knows_student(self, name: str, team: str = "") -> bool:
        """Return whether a name is that of one student."""
        return len(self._person(Student(name, name, login=name, group=team)).students) == 1

    def match(self, claim: Student) -> Match:
        """Return whose a submission is by the ids and names in its own; with a `group`, only of a member of that team.

        A file of Canvas that is named like a group belongs to it only if its id is that of a member, or unknown.
        """
        if claim.aliases:  # an id of Canvas is one of these, and it is not clear which
            several = {index for user in claim.aliases for index in self._tables[0].get(f"canvas {user}", ())}
            return Match(tuple(sorted(several)), len(self._tables))
        found = self._person(claim)
        if claim.group:
            return found
        group = tuple(
            self._groups.get(f"canvas\n{letters(claim.name)}" if claim.canvas else plain(claim.name or claim.login), ())
        )
        if claim.canvas and found.students and found.rank == 0:
            is_own_name = letters(claim.name) in _in_canvas(self.students[found.students[0]].name)
            return found if is_own_name or found.students[0] not in group else Match(group, is_group=True)
        if claim.canvas and group and (found.students or any(self.students[index].canvas for index in group)):
            return Match((*found.students, *group), found.rank)
        return found if found.students or not group else Match(group, is_group=True)

    def _person(self, claim: Student) -> Match:
        """Return the students with the best of the words in a name, without those whom the LMS knows by another id."""
        team = self._groups.get(plain(claim.group), ()) if claim.group else range(len(self.students))
        for rank, words in enumerate(_words_in(claim)):
            found = {index for word in words if word for index in self._tables[rank].get(word, ()) if index in team}
            if found:
                return Match(tuple(sorted(index for index in found if not self._is_other(index, claim))), rank)
        return Match(())

    def _is_other(self, index: int, claim: Student) -> bool:
        one = self.students[index]
        return any(
            mine and its and mine != its for mine, its in ((one.canvas, claim.canvas), (one.moodle, claim.moodle))
        )


def _words_of(one: Student) -> Words:
    """Return what identifies a student on a roster: ids of an LMS, ids, ids in another spelling, names."""
    ids = {one.key, one.login, one.sis, one.email, *one.aliases} - {""}
    names = {plain(one.name), plain(one.email.partition("@")[0]), _surname(one.name)}
    return (
        _numbers(one),
        map(_composed, ids),
        map(plain, ids),
        names | set(map("canvas\n{}".format, _in_canvas(one.name))),
    )


def _words_in(claim: Student) -> Words:
    """Return the same of a submission: a login may be any id or a name, a name is only a name."""
    names = [f"canvas\n{letters(claim.name)}"] if claim.canvas else [plain(claim.name), plain(claim.login)]
    surname = [_surname(claim.login)] if claim.group else []
    return _numbers(claim), [_composed(claim.login)], [plain(claim.login)], [*names, *surname]


def _numbers(one: Student) -> list[str]:
    return [f"{lms} {number}" for lms, number in (("canvas", one.canvas), ("moodle", one.moodle)) if number]


def _composed(word: str) -> str:
    return unicodedata.normalize("NFC", word)


def _surname(name: str) -> str:
    last, comma, _ = name.partition(",")
    words = plain(last if comma else last.rpartition(" ")[2])
    return f"surname\n{words}" if words else ""


def letters(name: str) -> str:
    """Return a name as Canvas writes it into names of files (canvas-lms, content_zipper.rb)."""
    return re.sub(r"\W", "", re.sub(r"_(\d+)_", r"\1", unicodedata.normalize("NFC", name))).casefold()


def _in_canvas(name: str) -> set[str]:
    """Return what Canvas may call a student in names of files: sorted by any word of the name, or as the user set."""
    words = name.split()[:_MAX_WORDS]
    orders = [name] if "," in name else [" ".join(words[index:] + words[:index]) for index in range(len(words))]
    return {letters(order) for order in orders}
