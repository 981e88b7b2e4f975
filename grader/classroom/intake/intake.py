"""The submissions of a class, each assigned to a student on the roster: which are unmatched, who submitted nothing."""

from collections.abc import Callable, Container, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

from grader.classroom.intake.layouts.layout import Submissions, path_key
from grader.classroom.intake.matches import Matches, match_class
from grader.classroom.intake.names import is_course_folder
from grader.classroom.intake.roster import Roster
from grader.classroom.matching import plain_word
from grader.classroom.students import ClassSubmission, Student
from grader.text import enumerated, first_lines, printable_path

_UNMATCHED = -1
_MAX_NOTES = 200
_MAX_NAMED = 10
# canvas-lms, app/models/abstract_assignment.rb, anonymize_students: names come back when all grades are posted or
# published.
_ANONYMOUS = (
    "this is an anonymous download: its submissions (anon_...) match no student. "
    "Canvas shows the names when the grades are posted: download again then"
)


class _Placed(NamedTuple):
    """A submission, by its number in `found`, with its student's key and roster entry; several for a shared one."""

    key: str
    number: int
    owner: int = _UNMATCHED
    is_shared: bool = False
    is_certain: bool = True


@dataclass(frozen=True, slots=True)
class Intake:
    """The submissions of a class. `ignored` says in lines what in the folder is not a submission, and why.

    With a roster, `unmatched` are the keys of submissions of students who are not on it (they are graded too), `absent`
    are students without a submission, `contested` students with several possible submissions: none is assigned, and the
    gradebook keeps the earlier one. `notes` says which submissions are ambiguous, and `ambiguous` how many.
    `assignments` are the names of the assignment in nbgrader or Canvas.
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

    Of several submissions that may belong to one student, the only one with the student's own id, key or login exactly
    counts; without such a one none does, and the student is contested. An unmatched submission that is named like a
    group counts for each member without another submission, unless its folder `holds_students`: then the group is a
    section.
    """
    notes = (*submissions.notes, *((_ANONYMOUS,) if submissions.is_anonymous else ()))
    if roster is None:
        folders = filter(is_course_folder, map(submissions.path, range(len(submissions))))
        if names := [printable_path(folder) for folder in folders]:
            notes += (f"{enumerated(names, _MAX_NAMED)} may be a template of the course: graded like a student's",)
        return Intake(layout, ignored, submissions, contested=submissions.contested, notes=notes)
    matches = match_class(submissions, roster, holds_students)
    outside = [index for index in matches.unmatched if index not in matches.shared]
    courses = [index for index in outside if is_course_folder(submissions.path(index))]
    keys = _keys(submissions, roster, {*matches.owners, *matches.shared, *courses})
    placed = _place(matches, roster, keys)
    present = {one.owner for one in placed} | matches.contested
    absent = [index for index in range(len(roster.entries)) if index not in present]
    if submissions.is_anonymous:  # any of its submissions may be theirs
        matches.contested.update(absent)
        absent = []
    return Intake(
        layout,
        (*_course_line(map(submissions.path, courses)), *ignored),
        submissions,
        roster,
        placed,
        () if submissions.is_anonymous else tuple(sorted(keys.values())),
        tuple(roster.entries[index].student for index in absent),
        tuple(roster.entries[index].student for index in sorted(matches.contested)),
        (*roster.notes, *notes, *first_lines(sorted(matches.notes), _MAX_NOTES)),
        len(matches.ambiguous),
    )


def _keys(submissions: Submissions, roster: Roster, assigned: Container[int]) -> dict[int, str]:
    """Return the keys of unassigned submissions: never that of a student on the roster."""
    taken = {plain_word(entry.student.key) for entry in roster.entries}
    keys = {index: submissions.student(index).key for index in range(len(submissions)) if index not in assigned}
    return keys | {index: path_key(submissions.path(index)) for index, key in keys.items() if plain_word(key) in taken}


def _place(matches: Matches, roster: Roster, keys: dict[int, str]) -> list[_Placed]:
    """Return all submissions in the order of their students' keys; that of a group once for each member."""
    key_of = [entry.student.key for entry in roster.entries]
    placed = [_Placed(key, index) for index, key in keys.items()]
    for index, owner in matches.owners.items():
        placed.append(_Placed(key_of[owner], index, owner, is_certain=index not in matches.uncertain))
    for index, members in matches.shared.items():
        placed += [_Placed(key_of[member], index, member, is_shared=True) for member in members]
    return sorted(placed)


def _course_line(folders: Iterable[str]) -> Iterator[str]:
    """Yield one line that names the course's own folders, if there are any."""
    names = [printable_path(folder) for folder in folders]
    if names:
        are_folders = "is a folder" if len(names) == 1 else "are folders"
        yield f"{enumerated(names, _MAX_NAMED)} {are_folders} of the course, not of a student"
