"""The submissions of a class, each assigned to a student on the roster: which are unmatched, and who has submitted nothing."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from grader.classroom.intake.groups import CanvasGroups, GroupClaim, add_doubts, share
from grader.classroom.intake.layouts.layout import Submissions, path_key
from grader.classroom.intake.names import is_course_folder
from grader.classroom.intake.roster import Roster
from grader.classroom.matching import CERTAIN, Clue, plain_word
from grader.classroom.students import ClassSubmission, Student
from grader.text import enumerated, first_lines, printable_path

_UNMATCHED = -1
_MAX_NOTES = 200
_MAX_NAMED = 10
# canvas-lms, app/models/abstract_assignment.rb, anonymize_students: names come back when all grades are posted or published.
_ANONYMOUS = (
    "this is an anonymous download: its submissions (anon_...) match no student. Canvas shows the names when the grades are"
    " posted: download again then"
)


class _Placed(NamedTuple):
    """A submission, by its number in `found`, with the key and the roster's entry of its student; a shared one counts for several."""

    key: str
    number: int
    owner: int = _UNMATCHED
    is_shared: bool = False
    is_certain: bool = True


@dataclass(frozen=True, slots=True)
class Intake:
    """The submissions of a class. `ignored` says in lines what in the folder is not a submission, and why.

    With a roster, `unmatched` are the keys of submissions of students who are not on it (they are graded too), `absent` are students
    without a submission, `contested` students with several possible submissions: none is assigned, and the gradebook keeps the
    earlier one. `notes` says which submissions are ambiguous, and `ambiguous` how many. `assignments` are the names of the
    assignment in nbgrader or Canvas.
    """

    layout: str
    ignored: tuple[str, ...]
    found: Submissions
    roster: Roster | None = None
    placed: Sequence[_Placed] = ()
    unmatched: tuple[str, ...] = ()
    absent: tuple[Student, ...] = ()
    contested: tuple[Student, ...] = ()
    notes: tuple[str, ...] = ()
    ambiguous: int = 0

    def __len__(self) -> int:
        return len(self.found) if self.roster is None else len(self.placed)

    @property
    def matched(self) -> int:
        """The number of submissions that belong to students on the roster, or may belong to several of them."""
        return len({placed.number for placed in self.placed if placed.owner != _UNMATCHED}) + self.ambiguous

    @property
    def assignments(self) -> frozenset[str]:
        """The names of the assignment."""
        return self.found.assignments | (self.roster.assignments if self.roster is not None else frozenset())

    def keys(self) -> Iterator[str]:
        """Yield the keys of the submissions, in order."""
        if self.roster is None:
            return (student.key for student in self.named_students())
        return (placed.key for placed in self.placed)

    def named_students(self) -> Iterator[Student]:
        """Yield the students as the names of the submissions tell."""
        return map(self.found.student, range(len(self.found)))

    def submissions(self) -> Iterator[ClassSubmission]:
        """Yield the submissions in the order of their students' keys."""
        if self.roster is None:
            yield from map(self.found.submission, range(len(self.found)))
        for key, index, owner, is_shared, is_certain in self.placed:
            submission = self.found.submission(index)
            if self.roster is None or owner == _UNMATCHED:
                yield replace(submission, student=replace(submission.student, key=key))
                continue
            if is_shared:  # the names and ids are the team's, not its member's
                submission = replace(submission, student=self.roster.entries[owner].student)
            yield replace(self.roster.complete(owner, submission), is_certain=is_certain)


def assign(
    layout: str,
    ignored: tuple[str, ...],
    submissions: Submissions,
    roster: Roster | None,
    holds_students: Callable[[str], bool],
) -> Intake:
    """Assign each submission to a student.

    Of several submissions that may belong to one student, the only one with the student's own id, key or login exactly counts; without
    such a one none does, and the student is contested. An unmatched submission that is named like a group counts for each member
    without another submission, unless its folder `holds_students`: then the group is a section.
    """
    notes = (*submissions.notes, *((_ANONYMOUS,) if submissions.is_anonymous else ()))
    if roster is None:
        folders = filter(is_course_folder, map(submissions.path, range(len(submissions))))
        if names := [printable_path(folder) for folder in folders]:
            notes += (f"{enumerated(names, _MAX_NAMED)} may be a template of the course: graded like a student's",)
        return Intake(layout, ignored, submissions, contested=submissions.contested, notes=notes)
    entries = roster.entries
    matches = _match(submissions, roster)
    own = {owner: index for index, owner in matches.owners.items()}
    claimants = matches.claimants
    for index in matches.unmatched:
        if members := roster.members(submissions.student(index)):
            claimants.setdefault(tuple(members), []).append(index)
    shared = share(submissions, roster, claimants, own, matches.contested, matches.notes, holds_students)
    courses = [
        index for index in matches.unmatched if index not in shared and is_course_folder(submissions.path(index))
    ]
    taken = {plain_word(entry.student.key) for entry in entries}
    keys = {
        index: submissions.student(index).key
        for index in range(len(submissions))
        if index not in matches.owners and index not in shared and index not in courses
    }
    # An unmatched submission must not get the key of a student on the roster.
    keys |= {index: path_key(submissions.path(index)) for index, key in keys.items() if plain_word(key) in taken}
    owners = matches.owners.items()
    placed = [
        _Placed(entries[owner].student.key, i, owner, is_certain=i not in matches.uncertain) for i, owner in owners
    ]
    placed += [_Placed(key, index) for index, key in keys.items()]
    placed += [
        _Placed(entries[owner].student.key, i, owner, is_shared=True) for i, of in shared.items() for owner in of
    ]
    present = {owner for _, _, owner, *_ in placed} | matches.contested
    absent = [index for index in range(len(entries)) if index not in present]
    if submissions.is_anonymous:  # any of its submissions may be theirs
        matches.contested.update(absent)
        absent = []
    return Intake(
        layout,
        (*_course_line(map(submissions.path, courses)), *ignored),
        submissions,
        roster,
        sorted(placed),
        () if submissions.is_anonymous else tuple(sorted(keys.values())),
        tuple(entries[index].student for index in absent),
        tuple(entries[index].student for index in sorted(matches.contested)),
        (*roster.notes, *notes, *first_lines(sorted(matches.notes), _MAX_NOTES)),
        len(matches.ambiguous),
    )


def _course_line(folders: Iterable[str]) -> Iterator[str]:
    """Yield one line that names the course's own folders, if there are any."""
    names = [printable_path(folder) for folder in folders]
    if names:
        one = len(names) == 1
        yield f"{enumerated(names, _MAX_NAMED)} {'is a folder' if one else 'are folders'} of the course, not of a student"


class _Matches(NamedTuple):
    """The owners of submissions by index, the unmatched submissions, the contested students, the uncertain submissions.

    `claimants` are the files of Canvas that are named like a group, by the positions of its members.
    """

    owners: dict[int, int]
    unmatched: list[int]
    contested: set[int]
    uncertain: set[int]
    notes: list[str]
    claimants: dict[tuple[int, ...], list[int]]
    ambiguous: set[int]


def _match(submissions: Submissions, roster: Roster) -> _Matches:
    matches = _Matches({}, [], set(), set(), [], {}, set())
    groups = CanvasGroups(roster)
    doubts: list[tuple[str, GroupClaim]] = []
    otherwise: list[str] = []
    claims: dict[int, list[tuple[Clue, int]]] = {}  # by owner, the submissions that may be theirs
    for index in range(0 if submissions.is_anonymous else len(submissions)):
        student = submissions.student(index)
        match = roster.match(student)
        claim = groups.claim(student, match.position)
        if claim is not None and claim.doubt:
            doubts.append((student.key, claim))
        if claim is not None and claim.owner is None:
            if not claim.doubt:
                matches.claimants.setdefault(claim.members, []).append(index)
        elif match.position is not None:
            if claim is None and match.clue is Clue.CANVAS and groups.is_named_otherwise(student, match.position):
                otherwise.append(student.key)
            claims.setdefault(match.position, []).append((match.clue, index))
        elif match.doubt:
            matches.notes.append(f"{student.key} {match.doubt}: left unassigned")
            matches.contested.update(match.several)
            matches.ambiguous.update({index} if match.several else ())
        else:
            matches.unmatched.append(index)
    add_doubts(doubts, matches.claimants, roster, matches.contested, matches.notes)
    if otherwise:
        matches.notes.append(
            f"{enumerated(otherwise, _MAX_NAMED)}: not named like the student with this id on the roster; if this is a group"
            " assignment, add a column `group` to the roster, and the submission counts for each member"
        )
    for owner, claimants in claims.items():
        clues, indices = zip(*sorted(claimants), strict=True)
        first, *others = (submissions.student(index).key for index in indices)
        key = roster.entries[owner].student.key
        if others and (clues[0] > CERTAIN or clues[1] == clues[0]):
            names = ", ".join((first, *others))
            matches.contested.add(owner)
            matches.ambiguous.update(indices)
            matches.notes.append(
                f"{names} may each belong to {key}: left unassigned; {key} keeps an earlier submission"
            )
            continue
        matches.owners[indices[0]] = owner
        if clues[0] > CERTAIN:
            matches.uncertain.add(indices[0])
        matches.notes.extend(
            f"{other} may belong to {key} as well, but {first} counts: left unassigned" for other in others
        )
    for student in submissions.contested:
        matches.contested.update(roster.candidates(student))
    matches.contested.difference_update(matches.owners.values())
    return matches
