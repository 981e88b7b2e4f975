"""Hand-ins and a roster brought together: whose each of them is, whose nobody's, and who has handed in nothing."""

from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from grader.classroom.intake.layouts.shelf import Shelf, unique
from grader.classroom.intake.roster import Roster
from grader.classroom.students import HandIn, Student

_NOBODY = -1
_MOST_NOTES = 200


@dataclass(frozen=True, slots=True)
class Placement:
    """The order of the hand-ins by their final keys, and what the roster makes of them.

    `whose` has for each hand-in an index into the roster, or -1; `renamed` the keys of strangers whose own are taken.
    """

    order: Sequence[int]
    whose: Sequence[int] = ()
    renamed: Mapping[int, str] = field(default_factory=dict)
    strangers: tuple[str, ...] = ()
    absent: tuple[Student, ...] = ()
    notes: tuple[str, ...] = ()

    def final(self, roster: Roster | None, index: int, hand_in: HandIn) -> HandIn:
        """A hand-in as it is graded: that of the student in the roster, or of a stranger."""
        if roster is None:
            return hand_in
        if self.whose[index] != _NOBODY:
            return roster.complete(self.whose[index], hand_in)
        key = self.renamed.get(index)
        return replace(hand_in, student=replace(hand_in.student, key=key)) if key else hand_in


def place(shelf: Shelf, roster: Roster | None, *, surnames: bool = False) -> Placement:
    """Whose each hand-in is.

    Of two that belong to one student the one that was found more surely is theirs, or else the first by key; the other is
    kept as a stranger's under its own key.
    """
    if roster is None:
        return Placement(range(len(shelf)))
    whose, notes = _join(shelf, roster, surnames=surnames)
    taken = {entry.student.key for entry in roster.entries}
    renamed: dict[int, str] = {}
    strangers: list[str] = []
    for index, owner in enumerate(whose):
        if owner == _NOBODY:
            own = shelf.student(index).key
            key = unique(own, taken)
            taken.add(key)
            strangers.append(key)
            if key != own:
                renamed[index] = key

    def final_key(index: int) -> str:
        owner = whose[index]
        return roster.entries[owner].student.key if owner != _NOBODY else renamed.get(index) or shelf.student(index).key

    there = set(whose)
    return Placement(
        array("l", sorted(range(len(shelf)), key=final_key)),
        whose,
        renamed,
        tuple(sorted(strangers)),
        tuple(entry.student for index, entry in enumerate(roster.entries) if index not in there),
        notes,
    )


def _join(shelf: Shelf, roster: Roster, *, surnames: bool) -> tuple["array[int]", tuple[str, ...]]:
    whose = array("l", [_NOBODY]) * len(shelf)
    holders: dict[int, tuple[int, int]] = {}
    notes: list[str] = []
    several: list[tuple[int, int]] = []
    for index in range(len(shelf)):
        student = shelf.student(index)
        match = roster.match(student, surnames=surnames)
        if match.place is None:
            if match.doubt:
                notes.append(f"{student.key} {match.doubt}: it counts as nobody's there")
            continue
        step, holder = holders.get(match.place, (match.step + 1, index))
        if match.step < step:
            holders[match.place] = match.step, index
        if holder != index:
            several.append((match.place, index if match.step >= step else holder))
    for owner, (_, index) in holders.items():
        whose[index] = owner
    for owner, index in several:
        theirs = shelf.student(holders[owner][1]).key
        name = shelf.student(index).key
        notes.append(f"{name} seems to be of {roster.entries[owner].student.key} as well, whose {theirs} counts")
    shown = sorted(notes)[:_MOST_NOTES]
    return whose, (*shown, f"and {len(notes) - len(shown)} more") if len(notes) > len(shown) else tuple(shown)
