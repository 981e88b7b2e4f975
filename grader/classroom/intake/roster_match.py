"""Submissions and a roster brought together: whose each of them is, which are unmatched, and who has submitted nothing."""

from array import array
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import Submissions, place_key
from grader.classroom.intake.roster import Roster
from grader.classroom.matching import CERTAIN, Clue, plain_word
from grader.classroom.students import ClassSubmission, Student

_NOBODY = -1
_MAX_NOTES = 200


@dataclass(frozen=True, slots=True)
class RosterMatches:
    """The submissions in the order of their final keys, and what the roster makes of them.

    `order` has an index into the shelf for each of them; a team's submission is there once for each member, and in `shared`.
    `whose` has beside each an index into the roster, or -1; `renamed` the keys of unmatched submissions that have an odd name.
    `contested` are students whom several submissions may belong to: none is assigned, and what the gradebook has of them stays.
    `uncertain` has the indices of submissions that do not bear their student's own number, key or login exactly.
    """

    order: Sequence[int]
    whose: Sequence[int] = ()
    shared: Mapping[int, Sequence[int]] = field(default_factory=dict)
    renamed: Mapping[int, str] = field(default_factory=dict)
    unmatched: tuple[str, ...] = ()
    absent: tuple[Student, ...] = ()
    contested: tuple[Student, ...] = ()
    uncertain: Collection[int] = ()
    notes: tuple[str, ...] = ()

    def key(self, roster: Roster | None, position: int, student: Student) -> str:
        """The final key of the submission at this position, of which `student` says what its name says."""
        owner = self.whose[position] if roster is not None else _NOBODY
        if roster is not None and owner != _NOBODY:
            return roster.entries[owner].student.key
        return self.renamed.get(self.order[position]) or student.key

    def final(self, roster: Roster | None, position: int, hand_in: ClassSubmission) -> ClassSubmission:
        """The submission at this position of the order as it is graded: that of a student in the roster, or an unmatched one."""
        if roster is None:
            return hand_in
        index, owner = self.order[position], self.whose[position]
        if index in self.shared:  # the names and numbers are the team's, not its member's
            hand_in = replace(hand_in, student=roster.entries[owner].student)
        if owner != _NOBODY:
            return replace(roster.complete(owner, hand_in), is_certain=index not in self.uncertain)
        key = self.renamed.get(index)
        return replace(hand_in, student=replace(hand_in.student, key=key)) if key else hand_in


def place(
    shelf: Submissions,
    roster: Roster | None,
    *,
    holds_students: Callable[[str], bool] = lambda _: False,
) -> RosterMatches:
    """Whose each submission is.

    Of several that may belong to one student, the only one that bears the student's own number, key or login exactly counts; without
    it none does, and the student is contested. What belongs to no student, but is named like a group, counts for each member who has
    submitted nothing else, unless its folder `holds_students`: then the group is a section.
    """
    if roster is None:
        return RosterMatches(range(len(shelf)), contested=shelf.contested)
    joined = _join(shelf, roster)
    shared = _share(shelf, roster, joined, holds_students)
    taken = {plain_word(entry.student.key) for entry in roster.entries}
    open_ones = [index for index, owner in enumerate(joined.whose) if owner == _NOBODY and index not in shared]
    keys = {index: shelf.student(index).key for index in open_ones}
    # It must not be mistaken for the student's own.
    renamed = {index: place_key(shelf.place(index)) for index, key in keys.items() if plain_word(key) in taken}
    keys |= renamed
    placed = [
        (roster.entries[owner].student.key, index, owner) for index, owner in enumerate(joined.whose) if owner >= 0
    ]
    placed += [(key, index, _NOBODY) for index, key in keys.items()]
    placed += [(roster.entries[each].student.key, index, each) for index, members in shared.items() for each in members]
    placed.sort()
    there = {owner for *_, owner in placed} | joined.contested
    shown, more = sorted(joined.notes)[:_MAX_NOTES], len(joined.notes) - _MAX_NOTES
    return RosterMatches(
        array("l", (index for _, index, _ in placed)),
        array("l", (owner for *_, owner in placed)),
        shared,
        renamed,
        tuple(sorted(keys.values())),
        tuple(entry.student for index, entry in enumerate(roster.entries) if index not in there),
        tuple(roster.entries[index].student for index in sorted(joined.contested)),
        joined.uncertain,
        (*shown, f"and {more} more") if more > 0 else tuple(shown),
    )


class _Claim(NamedTuple):
    """A submission that may belong to a student, and by which clue."""

    clue: Clue
    at: int


class _Joined(NamedTuple):
    """What the names of submissions say: whose each is, which may be a group's, and which students are contested.

    `uncertain` are submissions that do not bear the student's own number, key or login exactly.
    """

    whose: "array[int]"
    open: list[int]
    contested: set[int]
    uncertain: set[int]
    notes: list[str]


def _join(shelf: Submissions, roster: Roster) -> _Joined:
    joined = _Joined(array("l", [_NOBODY]) * len(shelf), [], set(), set(), [])
    claims: dict[int, list[_Claim]] = {}
    for index in range(len(shelf)):
        student = shelf.student(index)
        match = roster.match(student)
        if match.place is not None:
            claims.setdefault(match.place, []).append(_Claim(match.clue, index))
        elif match.doubt:
            joined.notes.append(f"{student.key} {match.doubt}: left unassigned")
            joined.contested.update(match.several)
        else:
            joined.open.append(index)
    for owner, claimants in claims.items():
        first, *others = sorted(claimants)
        key = roster.entries[owner].student.key
        if others and (first.clue > CERTAIN or others[0].clue == first.clue):
            names = ", ".join(shelf.student(each.at).key for each in (first, *others))
            joined.contested.add(owner)
            joined.notes.append(f"{names} may each be of {key}: left unassigned, and what {key} had before stays")
            continue
        joined.whose[first.at] = owner
        if first.clue > CERTAIN:
            joined.uncertain.add(first.at)
        theirs = shelf.student(first.at).key
        joined.notes.extend(
            f"{shelf.student(each.at).key} may be of {key} as well, whose {theirs} counts: left unassigned"
            for each in others
        )
    for student in shelf.contested:
        joined.contested.update(roster.candidates(student))
    joined.contested.difference_update(joined.whose)
    return joined


def _share(
    shelf: Submissions,
    roster: Roster,
    joined: _Joined,
    holds_students: Callable[[str], bool],
) -> dict[int, list[int]]:
    """Of each submission of a team the members that it counts for: those who have submitted nothing else."""
    own = {owner: index for index, owner in enumerate(joined.whose) if owner != _NOBODY}
    by_group: dict[tuple[int, ...], list[int]] = {}
    for index in joined.open:
        if members := roster.members(shelf.student(index)):
            by_group.setdefault(tuple(members), []).append(index)
    shared: dict[int, list[int]] = {}
    for members, claimants in by_group.items():
        alone = [index for index in claimants if not any(map(holds_students, shelf.hand_in(index).paths))]
        keys = {index: shelf.student(index).key for index in claimants}
        joined.notes.extend(
            f"{keys[index]} is named like a group, but holds submissions of several students"
            for index in claimants
            if index not in alone
        )
        without = [member for member in members if member not in own and member not in joined.contested]
        if len(alone) > 1:
            names = ", ".join(keys[index] for index in alone)
            joined.notes.append(f"{names} are each named like one group: left unassigned")
            joined.contested.update(without)
        elif alone:
            joined.notes.extend(
                f"{roster.entries[member].student.key} has submitted {shelf.student(own[member]).key}, which counts for them,"
                f" not {keys[alone[0]]} of their group"
                for member in members
                if member in own
            )
            if without:
                shared[alone[0]] = without
    if shared:
        joined.notes.append(f"submitted by groups, and counted for each of their members: {len(shared)}")
    return shared
