"""The files of Canvas that are named like a group on the roster."""

from collections.abc import Sequence
from typing import NamedTuple

from grader.classroom.intake.roster import Roster
from grader.classroom.matching import Clue, canvas_name, canvas_names
from grader.classroom.students import Student


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
        # A user's name may end in the id of a member: of an ambiguous name, only the last number is certainly no part
        # of a name.
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
        shown = self._entries[groups[0][0]].team
        every = tuple(sorted({member for members in groups for member in members}))
        owner = self._by_number.get(number)
        if owner is not None:
            return self._claim_of(owner, groups, plain, every)
        doubt = ""
        if position is not None:
            doubt = f"may be named after {self._entries[position].student.key} or the group {shown!r}"
            every = (*every, position)
        elif len(groups) > 1:
            doubt = "is named like several groups"
        elif all(self._entries[member].student.canvas for member in every):
            doubt = f"is named like the group {shown!r}, but {number} is not the id of a member"
        return GroupClaim(every, doubt)

    def _claim_of(
        self, owner: int, groups: Sequence[tuple[int, ...]], plain: str, every: tuple[int, ...]
    ) -> GroupClaim:
        """Return the claim of a file with the number of a student, who is in one of the groups of its name or not."""
        entry, shown = self._entries[owner], self._entries[groups[0][0]].team
        own = next((members for members in groups if owner in members), None)
        if own is None:
            group = f"whose group is {entry.team!r}" if entry.team else "who has no group on the roster"
            number, key = entry.student.canvas, entry.student.key
            return GroupClaim(every, f"is named like the group {shown!r}, but {number} is {key}, {group}", owner)
        if plain in canvas_names(entry.student.name):
            return GroupClaim(own, f"may be named after a student or the group {shown!r}", owner)
        return GroupClaim(own)
