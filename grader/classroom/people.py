"""Which students on a roster a submission belongs to: by an LMS's id, any other id, or a full name, in this order."""

import re
import unicodedata
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from grader.classroom.roster import Student, plain

# What identifies the student: an id of the LMS, another id as it is spelt, in another spelling or a name; a group.
_LMS_ID, _EXACT, _WORD, GROUP, _UNCLEAR = range(5)
_MAX_WORDS = 8


class Match(NamedTuple):
    """The indices of the students that a submission may belong to, and by what."""

    students: tuple[int, ...] = ()
    by: int = _UNCLEAR

    @property
    def owners(self) -> tuple[int, ...]:
        """The student whom it belongs to, or each member of its group; empty if that is not certain."""
        return self.students if self.by == GROUP or (len(self.students) == 1 and self.by < GROUP) else ()


class People:
    """The students on a roster, by ids, names and groups."""

    def __init__(self, students: Sequence[Student]) -> None:
        self.students = students
        self._known: tuple[dict[str, tuple[int, ...]], ...] = ({}, {}, {}, {})
        self._groups: dict[str, list[int]] = defaultdict(list)
        for index, one in enumerate(students):
            own = (index,)  # kept once for all words that only this student has
            ids = [one.key, one.login, one.sis, one.email, *one.aliases]
            names = [plain(one.name), plain(one.email.partition("@")[0]), _surname(one.name), *_in_canvas(one.name)]
            for words, table in zip((_lms_ids(one), ids, map(plain, ids), names), self._known, strict=True):
                for word in {unicodedata.normalize("NFC", word) for word in words if word}:
                    table[word] = table[word] + own if word in table else own
            for word in {plain(one.group), letters(one.group)} - {""}:
                self._groups[word].append(index)

    def members(self, group: str) -> Sequence[int]:
        """Return the students of a group."""
        return self._groups.get(plain(group), ())

    def knows(self, name: str, team: str = "") -> bool:
        """Return whether a name is that of one student, in a team also the surname, or else of a group."""
        return bool(self.match(Student(name, login=name, group=team)).owners)

    def match(self, claim: Student) -> Match:
        """Return whose a submission is by what its name claims; with a `group`, only of a member of that team.

        What has the name of a group is the group's, unless an id in it is that of another student: Canvas writes the id
        of a member, Moodle a number of the group's own. Of `aliases` it is not clear which is the user's id.
        """
        if claim.aliases:
            users = [f"canvas {user}" for user in claim.aliases]
            return Match(self._having(users, self._known[_LMS_ID]))
        name = letters(claim.name) if claim.canvas else plain(claim.name or claim.login)
        found, group = self._person(claim, name), [] if claim.group else self._groups.get(name, [])
        is_own_name = found.by == _LMS_ID and found.students[0] in self._known[-1].get(name, ())
        if is_own_name or not {*group}.difference(found.students):
            return found
        if found.by == _LMS_ID and claim.canvas:
            return Match(tuple(group), GROUP) if found.students[0] in group else found
        if found.students or (claim.canvas and any(self.students[index].canvas for index in group)):
            return Match(tuple(sorted({*found.students, *group})))
        return Match(tuple(group), GROUP)

    def _person(self, claim: Student, name: str) -> Match:
        """Return the students with the best words of a claim, without those whom the LMS knows by another id."""
        login = plain(claim.login)
        names = [name, login, _surname(login) if claim.group else ""]
        ranked = (_lms_ids(claim), [unicodedata.normalize("NFC", claim.login)], [login], names)
        for by, (words, table) in enumerate(zip(ranked, self._known, strict=True)):
            found = self._having(words, table)
            if claim.group:
                found = tuple(index for index in found if index in self.members(claim.group))
            if found:
                return Match(tuple(at for at in found if not _is_other(self.students[at], claim)), min(by, _WORD))
        return Match()

    def _having(self, words: Iterable[str], table: Mapping[str, tuple[int, ...]]) -> tuple[int, ...]:
        return tuple(sorted({index for word in words for index in table.get(word, ())}))


def _is_other(one: Student, claim: Student) -> bool:
    """Return whether the LMS knows a student by another id than that in a claim."""
    ids = ((one.canvas, claim.canvas), (one.moodle, claim.moodle))
    return any(own and given and own != given for own, given in ids)


def _lms_ids(one: Student) -> list[str]:
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
