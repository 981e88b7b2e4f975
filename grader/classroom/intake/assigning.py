"""Assign submissions to the students on a roster: whose each one is, which are unmatched, and who has submitted nothing."""

from array import array
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import Submissions, path_key
from grader.classroom.intake.roster import Roster
from grader.classroom.matching import CERTAIN, Clue, plain_word
from grader.classroom.students import ClassSubmission, Student
from grader.text import first_lines

_UNMATCHED = -1
_MAX_NOTES = 200


@dataclass(frozen=True, slots=True)
class Assigned:
    """The submissions in the order of their final keys, with their students.

    `order` has an index into the submissions for each; a team's submission is there once for each member, and in `shared`.
    `owners` has an index into the roster for each, or -1; `renamed` the keys of unmatched submissions that have an odd name.
    `contested` are students with several possible submissions: none is assigned, and the gradebook keeps the earlier one.
    `uncertain` has the indices of submissions that do not have their student's own id, key or login exactly.
    """

    order: Sequence[int]
    owners: Sequence[int] = ()
    shared: Mapping[int, Sequence[int]] = field(default_factory=dict)
    renamed: Mapping[int, str] = field(default_factory=dict)
    unmatched: tuple[str, ...] = ()
    absent: tuple[Student, ...] = ()
    contested: tuple[Student, ...] = ()
    uncertain: Collection[int] = ()
    notes: tuple[str, ...] = ()

    def final(self, roster: Roster | None, position: int, submission: ClassSubmission) -> ClassSubmission:
        """Return the submission at a position with its final student."""
        if roster is None:
            return submission
        index, owner = self.order[position], self.owners[position]
        if index in self.shared:  # the names and ids are the team's, not its member's
            submission = replace(submission, student=roster.entries[owner].student)
        if owner != _UNMATCHED:
            return replace(roster.complete(owner, submission), is_certain=index not in self.uncertain)
        key = self.renamed.get(index)
        return replace(submission, student=replace(submission.student, key=key)) if key else submission


def assign(
    submissions: Submissions,
    roster: Roster | None,
    *,
    holds_students: Callable[[str], bool] = lambda _: False,
) -> Assigned:
    """Assign each submission to a student.

    Of several submissions that may belong to one student, the only one with the student's own id, key or login exactly counts; without
    such a one none does, and the student is contested. An unmatched submission that is named like a group counts for each member
    without another submission, unless its folder `holds_students`: then the group is a section.
    """
    if roster is None:
        return Assigned(range(len(submissions)), contested=submissions.contested)
    entries = roster.entries
    matches = _match(submissions, roster)
    shared = _share(submissions, roster, matches, holds_students)
    taken = {plain_word(entry.student.key) for entry in entries}
    unmatched = [index for index, owner in enumerate(matches.owners) if owner == _UNMATCHED and index not in shared]
    keys = {index: submissions.student(index).key for index in unmatched}
    # An unmatched submission must not get the key of a student on the roster.
    renamed = {index: path_key(submissions.path(index)) for index, key in keys.items() if plain_word(key) in taken}
    keys |= renamed
    placed = [(entries[owner].student.key, index, owner) for index, owner in enumerate(matches.owners) if owner >= 0]
    placed += [(key, index, _UNMATCHED) for index, key in keys.items()]
    placed += [(entries[owner].student.key, index, owner) for index, members in shared.items() for owner in members]
    placed.sort()
    present = {owner for *_, owner in placed} | matches.contested
    return Assigned(
        array("l", (index for _, index, _ in placed)),
        array("l", (owner for *_, owner in placed)),
        shared,
        renamed,
        tuple(sorted(keys.values())),
        tuple(entry.student for index, entry in enumerate(entries) if index not in present),
        tuple(entries[index].student for index in sorted(matches.contested)),
        matches.uncertain,
        tuple(first_lines(sorted(matches.notes), _MAX_NOTES)),
    )


class _Claim(NamedTuple):
    """A submission that may belong to a student, and by which clue."""

    clue: Clue
    submission: int


class _Matches(NamedTuple):
    """The owner of each submission, the unmatched ones, the contested students and the uncertain submissions."""

    owners: "array[int]"
    unmatched: list[int]
    contested: set[int]
    uncertain: set[int]
    notes: list[str]


def _match(submissions: Submissions, roster: Roster) -> _Matches:
    matches = _Matches(array("l", [_UNMATCHED]) * len(submissions), [], set(), set(), [])
    claims: dict[int, list[_Claim]] = {}
    for index in range(len(submissions)):
        student = submissions.student(index)
        match = roster.match(student)
        if match.position is not None:
            claims.setdefault(match.position, []).append(_Claim(match.clue, index))
        elif match.doubt:
            matches.notes.append(f"{student.key} {match.doubt}: left unassigned")
            matches.contested.update(match.several)
        else:
            matches.unmatched.append(index)
    for owner, claimants in claims.items():
        first, *others = sorted(claimants)
        key = roster.entries[owner].student.key
        if others and (first.clue > CERTAIN or others[0].clue == first.clue):
            names = ", ".join(submissions.student(claim.submission).key for claim in (first, *others))
            matches.contested.add(owner)
            matches.notes.append(
                f"{names} may each belong to {key}: left unassigned; {key} keeps an earlier submission"
            )
            continue
        matches.owners[first.submission] = owner
        if first.clue > CERTAIN:
            matches.uncertain.add(first.submission)
        counts = submissions.student(first.submission).key
        matches.notes.extend(
            f"{submissions.student(claim.submission).key} may belong to {key} as well, but {counts} counts: left unassigned"
            for claim in others
        )
    for student in submissions.contested:
        matches.contested.update(roster.candidates(student))
    matches.contested.difference_update(matches.owners)
    return matches


def _share(
    submissions: Submissions, roster: Roster, matches: _Matches, holds_students: Callable[[str], bool]
) -> dict[int, list[int]]:
    """Return the members that each team's submission counts for: those without another submission."""
    own = {owner: index for index, owner in enumerate(matches.owners) if owner != _UNMATCHED}
    by_group: dict[tuple[int, ...], list[int]] = {}
    for index in matches.unmatched:
        if members := roster.members(submissions.student(index)):
            by_group.setdefault(tuple(members), []).append(index)
    shared: dict[int, list[int]] = {}
    for members, claimants in by_group.items():
        alone = [index for index in claimants if not any(map(holds_students, submissions.submission(index).paths))]
        keys = {index: submissions.student(index).key for index in claimants}
        matches.notes.extend(
            f"{keys[index]} is named like a group, but holds submissions of several students"
            for index in claimants
            if index not in alone
        )
        without = [member for member in members if member not in own and member not in matches.contested]
        if len(alone) > 1:
            names = ", ".join(keys[index] for index in alone)
            matches.notes.append(f"{names} are each named like one group: left unassigned")
            matches.contested.update(without)
        elif alone:
            matches.notes.extend(
                f"{roster.entries[member].student.key} has submitted {submissions.student(own[member]).key}, which counts for them,"
                f" not {keys[alone[0]]} of their group"
                for member in members
                if member in own
            )
            if without:
                shared[alone[0]] = without
    if shared:
        matches.notes.append(f"group submissions that count for each member: {len(shared)}")
    return shared
