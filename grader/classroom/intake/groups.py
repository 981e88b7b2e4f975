"""Group submissions: which students on the roster the submission of a team counts for."""

from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import Submissions
from grader.classroom.intake.roster import Roster
from grader.classroom.matching import Clue, canvas_name, canvas_names
from grader.classroom.students import Student
from grader.text import enumerated

_MAX_NAMED = 10


class GroupClaim(NamedTuple):
    """The members of the group that a Canvas file is named like.

    With a `doubt` the submission counts for `owner`, the student with its number, and for no other member.
    """

    members: tuple[int, ...]
    doubt: str = ""
    owner: int | None = None


class CanvasGroups:
    """The groups of a roster as Canvas names their files: the group's name, and the user id of one member."""

    def __init__(self, roster: Roster) -> None:
        self._entries, self._names = roster.entries, roster.clues
        self._by_number = {entry.student.canvas: index for index, entry in enumerate(roster.entries)}
        self._groups: dict[str, list[tuple[int, ...]]] = {}
        for members in roster.groups.values():
            self._groups.setdefault(canvas_name(roster.entries[members[0]].team), []).append(tuple(members))

    def claim(self, student: Student, position: int | None) -> GroupClaim | None:
        """Return the claim of the group that a submission is named like; None if there is no such group.

        `position` is the student that all other clues identify.
        """
        # A user's name may end in the id of a member: of an ambiguous name, only the last number is certainly no part of a name.
        readings = student.readings if student.canvas else student.readings[-1:]
        claims = [claim for reading in readings if (claim := self._read(*reading, position))]
        numbers = {number for _, number in student.readings}
        if claims and len(numbers) < len(student.readings):  # files of two names, which no download of Canvas has
            return claims[0]._replace(doubt="has files with different names", owner=self._by_number.get(min(numbers)))
        if len(claims) > 1 and len(set(claims)) > 1:
            members = {member for claim in claims for member in claim.members}
            return GroupClaim(tuple(sorted(members)), "can be read as the name of several groups")
        return claims[0] if claims else None

    def is_named_otherwise(self, student: Student, owner: int) -> bool:
        """Return whether a file has another name than its student, who has no group."""
        entry = self._entries[owner]
        own = self._names[owner].get(Clue.CANVAS_NAME, ())
        return bool(own) and not entry.group and all(canvas_name(name) not in own for name, _ in student.readings)

    def _read(self, name: str, number: str, position: int | None) -> GroupClaim | None:
        """Return the claim of a name and a user id; None if no group has that name."""
        plain = canvas_name(name)
        groups = self._groups.get(plain)
        if not groups:
            return None
        owner = self._by_number.get(number)
        own = [members for members in groups if owner in members]
        shown = self._entries[groups[0][0]].team
        every = tuple(sorted({member for members in groups for member in members}))
        if owner is not None and own:
            if plain in canvas_names(self._entries[owner].student.name):
                return GroupClaim(own[0], f"may be named after a student or the group {shown!r}", owner)
            return GroupClaim(own[0])
        if owner is not None:
            entry = self._entries[owner]
            group = f"whose group is {entry.team!r}" if entry.team else "who has no group on the roster"
            return GroupClaim(
                every, f"is named like the group {shown!r}, but {number} is {entry.student.key}, {group}", owner
            )
        if position is not None:
            key = self._entries[position].student.key
            return GroupClaim((*every, position), f"may be named after {key} or the group {shown!r}")
        if len(groups) > 1:
            return GroupClaim(every, "is named like several groups")
        if all(self._entries[member].student.canvas for member in every):
            return GroupClaim(every, f"is named like the group {shown!r}, but {number} is not the id of a member")
        return GroupClaim(every)


def share(
    submissions: Submissions,
    roster: Roster,
    claimants: Mapping[tuple[int, ...], list[int]],
    own: Mapping[int, int],
    contested: set[int],
    notes: list[str],
    holds_students: Callable[[str], bool],
) -> dict[int, list[int]]:
    """Return the members that each group's submission counts for: those without another submission.

    `claimants` are the submissions with the name of each group, by its members. `own` is each student's own submission. Students
    with several possible submissions are added to `contested`, and messages for the user to `notes`.
    """
    shared: dict[int, list[int]] = {}
    for members, named in claimants.items():
        alone = [index for index in named if not any(map(holds_students, submissions.submission(index).paths))]
        keys = {index: submissions.student(index).key for index in named}
        notes.extend(
            f"{keys[index]} is named like a group, but contains submissions of several students"
            for index in named
            if index not in alone
        )
        without = [member for member in members if member not in own and member not in contested]
        if len(alone) > 1:
            notes.append(f"{', '.join(keys[index] for index in alone)} are named like the same group: left unassigned")
            contested.update(without)
        elif alone:
            notes.extend(
                f"{roster.entries[member].student.key} has submitted {submissions.student(own[member]).key},"
                f" which counts instead of the group's {keys[alone[0]]}"
                for member in members
                if member in own
            )
            if without:
                shared[alone[0]] = without
    if shared:
        notes.append(f"group submissions that count for each member: {len(shared)}")
    return shared


def add_doubts(
    doubts: Iterable[tuple[str, GroupClaim]],
    claimants: Mapping[tuple[int, ...], list[int]],
    roster: Roster,
    contested: set[int],
    notes: list[str],
) -> None:
    """Add the members of doubtful claims to `contested`, and a message for each of these claims to `notes`.

    Members of a group with a clear claim keep it: a student with the name of a group cannot take its submission away.
    """
    clear = {member for members in claimants for member in members}
    for key, claim in doubts:
        members = [member for member in claim.members if member not in clear]
        contested.update(members)
        others = [roster.entries[member].student.key for member in members if member != claim.owner]
        owner = roster.entries[claim.owner].student.key if claim.owner is not None else ""
        only = f"counts for {owner} only" if owner else "left unassigned"
        keep = f"; {enumerated(others, _MAX_NAMED)} {'keeps' if len(others) == 1 else 'keep'} an earlier submission"
        notes.append(f"{key} {claim.doubt}: {only}{keep if others else ''}")
