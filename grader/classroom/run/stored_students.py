"""Find the stored submission of each student while a class is graded, and those that are no longer in the class."""

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.run_writer import RunWriter
from grader.classroom.gradebook.stored import StoredSubmission
from grader.classroom.intake.layouts.attempts import home_of
from grader.classroom.intake.layouts.layout import path_key
from grader.classroom.intake.roster import Roster
from grader.classroom.run.identity import Identities
from grader.classroom.students import ClassSubmission


class StoredStudents:
    """The stored submissions of a gradebook, read side by side with the class: both are sorted by key.

    Students who are recognised under a new key are added to `notes`.
    """

    def __init__(
        self,
        book: Gradebook,
        writer: RunWriter,
        identities: Identities,
        root: str,
        roster: Roster | None,
        notes: list[str],
    ) -> None:
        self._writer, self._identities, self._root, self._roster = writer, identities, root, roster
        self._rest = book.stored_submissions()
        self._next = next(self._rest, None)
        self._has_any = self._next is not None
        self._passed: list[StoredSubmission] = []  # of this class folder, and not found yet
        self._renamed: set[int] = set()
        self._notes = notes

    def find(self, submission: ClassSubmission) -> StoredSubmission | None:
        """Return the stored submission of a student; submissions have to be asked for in the order of their keys."""
        key = submission.student.key
        self._skip_to(key)
        stored = self._next if self._next is not None and self._next.key == key else None
        if stored is not None:
            self._next = next(self._rest, None)
            return self._under_new_key(submission) if self._gives_way(stored, submission) else stored
        return self._under_new_key(submission) if self._has_any else None

    def is_doubtful(self, submission: ClassSubmission, stored: StoredSubmission) -> bool:
        """Return whether an uncertain submission replaces another one of the student in the same class."""
        return not (submission.is_certain or stored.source != self._root or self._is_same_path(submission, stored))

    def gone(self) -> list[StoredSubmission]:
        """Return the stored submissions of this class folder that were not asked for."""
        self._skip_to(None)
        return [stored for stored in self._passed if stored.student_id not in self._renamed]

    def _skip_to(self, key: str | None) -> None:
        """Skip stored submissions up to a key, or to the end."""
        while self._next is not None and (key is None or self._next.key < key):
            if self._next.source == self._root and not self._next.is_gone:
                self._passed.append(self._next)
            self._next = next(self._rest, None)

    def _under_new_key(self, submission: ClassSubmission) -> StoredSubmission | None:
        """Return the stored submission of the same student under another key, and give the student the new key."""
        stored, key = self._identities.of(submission), submission.student.key
        if stored is None or stored.student_id in self._renamed or stored.key == key:
            return None
        if not self._writer.rename(stored.student_id, key):
            self._notes.append(f"{stored.key} and {key} seem to be the same student, but both have results: not merged")
            return None
        self._renamed.add(stored.student_id)
        self._notes.append(f"{stored.key} is {key} now, with all manual marks")
        return stored

    def _gives_way(self, stored: StoredSubmission, submission: ClassSubmission) -> bool:
        """Return whether a key was that of a folder until the roster gave it to another student, who is in the gradebook too.

        The folder's results and marks then get the key of its path.
        """
        if self._roster is None or stored.is_on_roster or stored.source != self._root:
            return False
        if self._is_same_path(submission, stored) or self._identities.of(submission) is None:
            return False
        self._passed.append(stored)
        return self._writer.rename(stored.student_id, path_key(stored.paths[0]))

    def _is_same_path(self, submission: ClassSubmission, stored: StoredSubmission) -> bool:
        return home_of(stored.paths[0]) == home_of(submission.paths[0])
