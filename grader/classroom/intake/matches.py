"""Which student on the roster each submission belongs to, and which students the submission of a group counts for."""

from collections.abc import Callable, Iterable, Sequence

from grader.classroom.intake.groups import CanvasGroups, GroupClaim
from grader.classroom.intake.layouts.layout import Submissions
from grader.classroom.intake.roster import Roster
from grader.classroom.matching import CERTAIN, Clue
from grader.text import enumerated

_MAX_NAMED = 10


def match_class(submissions: Submissions, roster: Roster, holds_students: Callable[[str], bool]) -> "Matches":
    """Return which student each submission of a class belongs to, or which members of a group it counts for.

    A folder that `holds_students` is a section, and not the work of a group.
    """
    matches = Matches(submissions, roster)
    matches.match(roster)
    matches.contest(roster)
    matches.share(holds_students)
    return matches


class Matches:
    """The submissions of a class, an `index` each, matched with a roster's entries, a `position` each.

    `owners` are the positions of the students by the indices of their submissions. `shared` are the members that a
    group's submission counts for. `contested` are the students with several possible submissions, `ambiguous` these
    submissions, `uncertain` those that may be another student's, `unmatched` those of nobody on the roster. `notes` are
    messages for the user.
    """

    def __init__(self, submissions: Submissions, roster: Roster) -> None:
        self._submissions, self._entries = submissions, roster.entries
        self.owners: dict[int, int] = {}
        self.shared: dict[int, list[int]] = {}
        self.unmatched: list[int] = []
        self.contested: set[int] = set()
        self.ambiguous: set[int] = set()
        self.uncertain: set[int] = set()
        self.notes: list[str] = []
        # Submissions that are named like a group, by its members.
        self._claimants: dict[tuple[int, ...], list[int]] = {}

    def match(self, roster: Roster) -> None:
        """Match each submission, then decide between those of one student; none of an anonymous class."""
        groups = CanvasGroups(roster)
        doubts: list[tuple[str, GroupClaim]] = []
        otherwise: list[str] = []
        claims: dict[int, list[tuple[Clue, int]]] = {}  # by owner, the submissions that may be theirs
        for index in range(0 if self._submissions.is_anonymous else len(self._submissions)):
            student = self._submissions.student(index)
            match = roster.match(student)
            claim = groups.claim(student, match.position)
            if claim is not None and claim.doubt:
                doubts.append((student.key, claim))
            if claim is not None and claim.owner is None:
                if not claim.doubt:
                    self._claimants.setdefault(claim.members, []).append(index)
            elif match.position is not None:
                if claim is None and match.clue is Clue.CANVAS and groups.is_named_otherwise(student, match.position):
                    otherwise.append(student.key)
                claims.setdefault(match.position, []).append((match.clue, index))
            elif match.doubt:
                self.notes.append(f"{student.key} {match.doubt}: left unassigned")
                self.contested.update(match.several)
                self.ambiguous.update({index} if match.several else ())
            else:
                self.unmatched.append(index)
        self._add_doubts(doubts)
        if otherwise:
            self.notes.append(
                f"{enumerated(otherwise, _MAX_NAMED)}: not named like the student with this id on the roster; if this"
                " is a group assignment, add a column `group` to the roster, and the submission counts for each member"
            )
        for owner, claimants in claims.items():
            self._decide(owner, sorted(claimants))

    def contest(self, roster: Roster) -> None:
        """Contest the students who may have a submission that was ignored, and add the unmatched groups."""
        for student in self._submissions.contested:
            self.contested.update(roster.candidates(student))
        self.contested.difference_update(self.owners.values())
        for index in self.unmatched:
            if members := roster.members(self._submissions.student(index)):
                self._claimants.setdefault(tuple(members), []).append(index)

    def _add_doubts(self, doubts: Iterable[tuple[str, GroupClaim]]) -> None:
        """Contest the members of doubtful claims, except those of a group with a clear claim.

        A student with the name of a group cannot take its submission away.
        """
        clear = {member for members in self._claimants for member in members}
        for key, claim in doubts:
            members = [member for member in claim.members if member not in clear]
            self.contested.update(members)
            others = [self._key(member) for member in members if member != claim.owner]
            only = f"counts for {self._key(claim.owner)} only" if claim.owner is not None else "left unassigned"
            keep = f"; {enumerated(others, _MAX_NAMED)} {'keeps' if len(others) == 1 else 'keep'} an earlier submission"
            self.notes.append(f"{key} {claim.doubt}: {only}{keep if others else ''}")

    def _decide(self, owner: int, claimants: Sequence[tuple[Clue, int]]) -> None:
        """Give a student the submission with the best clue, unless another one has the same, or none is certain."""
        clues, indices = zip(*claimants, strict=True)
        key = self._key(owner)
        first, *others = (self._submissions.student(index).key for index in indices)
        if others and (clues[0] > CERTAIN or clues[1] == clues[0]):
            names = ", ".join((first, *others))
            self.contested.add(owner)
            self.ambiguous.update(indices)
            self.notes.append(f"{names} may each belong to {key}: left unassigned; {key} keeps an earlier submission")
            return
        self.owners[indices[0]] = owner
        if clues[0] > CERTAIN:
            self.uncertain.add(indices[0])
        for other in others:
            self.notes.append(f"{other} may belong to {key} as well, but {first} counts: left unassigned")

    def share(self, holds_students: Callable[[str], bool]) -> None:
        """Let a group's submission count for its members without another one; that of a section counts for nobody."""
        own = {owner: index for index, owner in self.owners.items()}
        for members, named in self._claimants.items():
            keys = {index: self._submissions.student(index).key for index in named}
            alone = [
                index for index in named if not any(map(holds_students, self._submissions.submission(index).paths))
            ]
            for index in named:
                if index not in alone:
                    self.notes.append(
                        f"{keys[index]} is named like a group, but contains submissions of several students"
                    )
            without = [member for member in members if member not in own and member not in self.contested]
            if len(alone) > 1:
                names = ", ".join(keys[index] for index in alone)
                self.notes.append(f"{names} are named like the same group: left unassigned")
                self.contested.update(without)
            elif alone:
                self._share(alone[0], members, own)
                self.shared |= {alone[0]: without} if without else {}
        if self.shared:
            self.notes.append(f"group submissions that count for each member: {len(self.shared)}")

    def _share(self, index: int, members: Iterable[int], own: dict[int, int]) -> None:
        """Say which members of a group have submitted something else."""
        for member in members:
            if member in own:
                name, group = (self._submissions.student(one).key for one in (own[member], index))
                self.notes.append(
                    f"{self._key(member)} has submitted {name}, which counts instead of the group's {group}"
                )

    def _key(self, position: int) -> str:
        return self._entries[position].student.key
