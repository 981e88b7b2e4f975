"""Hand-ins and a roster brought together: whose each of them is, whose nobody's, and who has handed in nothing."""

from array import array
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace

from grader.classroom.intake.layouts.shelf import Shelf, unique
from grader.classroom.intake.roster import Roster
from grader.classroom.students import HandIn, Student

_NOBODY = -1
_MOST_NOTES = 200


@dataclass(frozen=True, slots=True)
class Placement:
    """The hand-ins in the order of their final keys, and what the roster makes of them.

    `order` has an index into the shelf for each of them; that of a team is there once for each of its members, and in `shared`.
    `whose` has beside each an index into the roster, or -1; `renamed` the keys of strangers whose own are taken.
    """

    order: Sequence[int]
    whose: Sequence[int] = ()
    shared: Mapping[int, Sequence[int]] = field(default_factory=dict)
    renamed: Mapping[int, str] = field(default_factory=dict)
    strangers: tuple[str, ...] = ()
    absent: tuple[Student, ...] = ()
    notes: tuple[str, ...] = ()

    def final(self, roster: Roster | None, position: int, hand_in: HandIn) -> HandIn:
        """The hand-in at this position of the order as it is graded: that of the student in the roster, or of a stranger."""
        if roster is None:
            return hand_in
        index, owner = self.order[position], self.whose[position]
        if index in self.shared:  # the names and numbers are the team's, and not its member's
            hand_in = replace(hand_in, student=roster.entries[owner].student)
        if owner != _NOBODY:
            return roster.complete(owner, hand_in)
        key = self.renamed.get(index)
        return replace(hand_in, student=replace(hand_in.student, key=key)) if key else hand_in


def place(
    shelf: Shelf,
    roster: Roster | None,
    *,
    surnames: bool = False,
    holds_students: Callable[[str], bool] = lambda _: False,
) -> Placement:
    """Whose each hand-in is.

    Of two that belong to one student the one that was found more surely is theirs, or else the first by key; the other is
    kept as a stranger's under its own key. One that is of no student, but called like a group, is that of each member who has
    none of their own, unless its folder `holds_students`: then the group is a section.
    """
    if roster is None:
        return Placement(range(len(shelf)))
    whose, unmatched, notes = _join(shelf, roster, surnames=surnames)
    shared = _share(shelf, roster, whose, unmatched, notes, holds_students)
    taken = {entry.student.key for entry in roster.entries}
    renamed: dict[int, str] = {}
    strangers: list[str] = []
    for index, owner in enumerate(whose):
        if owner == _NOBODY and index not in shared:
            own = shelf.student(index).key
            key = unique(own, taken)
            taken.add(key)
            strangers.append(key)
            if key != own:
                renamed[index] = key

    def final_key(placed: tuple[int, int]) -> str:
        index, owner = placed
        return roster.entries[owner].student.key if owner != _NOBODY else renamed.get(index) or shelf.student(index).key

    placed = [(index, owner) for index, owner in enumerate(whose) if index not in shared]
    placed += [(index, member) for index, members in shared.items() for member in members]
    placed.sort(key=final_key)
    there = {owner for _, owner in placed}
    shown = sorted(notes)[:_MOST_NOTES]
    return Placement(
        array("l", (index for index, _ in placed)),
        array("l", (owner for _, owner in placed)),
        shared,
        renamed,
        tuple(sorted(strangers)),
        tuple(entry.student for index, entry in enumerate(roster.entries) if index not in there),
        (*shown, f"and {len(notes) - len(shown)} more") if len(notes) > len(shown) else tuple(shown),
    )


def _join(shelf: Shelf, roster: Roster, *, surnames: bool) -> tuple["array[int]", list[int], list[str]]:
    """Whose each hand-in is by what is said of them; those of which nobody in the roster may be meant; and notes."""
    whose = array("l", [_NOBODY]) * len(shelf)
    holders: dict[int, tuple[int, int]] = {}
    unmatched: list[int] = []
    notes: list[str] = []
    several: list[tuple[int, int]] = []
    for index in range(len(shelf)):
        student = shelf.student(index)
        match = roster.match(student, surnames=surnames)
        if match.place is None:
            if match.doubt:
                notes.append(f"{student.key} {match.doubt}: it counts as nobody's there")
            else:
                unmatched.append(index)
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
    return whose, unmatched, notes


def _share(
    shelf: Shelf,
    roster: Roster,
    whose: Sequence[int],
    unmatched: Sequence[int],
    notes: list[str],
    holds_students: Callable[[str], bool],
) -> dict[int, list[int]]:
    """Of each hand-in of a team the members that it counts for: those who have none of their own."""
    own = {owner: index for index, owner in enumerate(whose) if owner != _NOBODY}
    shared: dict[int, list[int]] = {}
    counts: dict[int, int] = {}  # for each member, the team's hand-in
    for index in unmatched:
        team = shelf.student(index)
        members = roster.members(team)
        if not members:
            continue
        if any(map(holds_students, shelf.hand_in(index).paths)):
            notes.append(f"{team.key} is called like a group, but holds what several students have handed in")
            continue
        first = counts.get(members[0])
        if first is not None:
            notes.append(f"{team.key} is called like a group as well, whose {shelf.student(first).key} counts")
            continue
        counts |= dict.fromkeys(members, index)
        without = [member for member in members if member not in own]
        for member in members:
            if member in own:
                theirs = shelf.student(own[member]).key
                key = roster.entries[member].student.key
                notes.append(f"{key} has handed in {theirs}, which counts for them, and not {team.key} of their group")
        if without:
            shared[index] = without
    if shared:
        notes.append(f"handed in by groups, and counted for each of their members: {len(shared)}")
    return shared
