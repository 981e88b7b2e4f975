"""Find the stored submission of each student while a class is graded, and those that are no longer in the class.

A later or corrected roster gives students other keys: they are recognised under the new key.
"""

from collections.abc import Callable, Iterable
from functools import cached_property
from json import dumps

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.run_writer import RunWriter
from grader.classroom.gradebook.stored import StoredSubmission
from grader.classroom.intake.attempts import home_of
from grader.classroom.intake.layouts.layout import is_path_key, path_key
from grader.classroom.intake.roster import Roster, RosterEntry, entry_from_json
from grader.classroom.matching import LMS_IDS, Clue, Clues, People, clues_of, lms_ids_of
from grader.classroom.students import ClassSubmission, Student


class Identities:
    """The students that were in a gradebook when a run began. `keys` returns the keys of the class that is graded now.

    A student whose key is in the class or on the roster keeps it, with all results. Of the others, one who was on a
    roster is recognised by LMS ids and by the data of the roster, never by the name of a folder; one who was not is
    recognised by the exact name as well, and by the path of the submission.
    """

    def __init__(self, book: Gradebook, root: str, roster: Roster | None, keys: Callable[[], Iterable[str]]) -> None:
        self.book, self.root, self.roster, self._keys = book, root, roster, keys

    @cached_property
    def _stored(self) -> list[StoredSubmission]:
        """The students whose key is neither in the class nor on the roster; most runs need none of them."""
        return [stored for stored in self.book.stored_submissions() if stored.key not in self._kept]

    @cached_property
    def _kept(self) -> set[str]:
        return set(self._keys()).union(student.key for student in (self.roster.students if self.roster else ()))

    @cached_property
    def _without(self) -> tuple[list[StoredSubmission], People]:
        """The same of students who have submitted nothing so far."""
        stored = [stored for stored in self.book.without_submission() if stored.key not in self._kept]
        return stored, People(_clues(one, self.root) for one in stored)

    @cached_property
    def _people(self) -> People:
        return People(_clues(stored, self.root) for stored in self._stored)

    @cached_property
    def _not_on_roster(self) -> set[int]:
        return {index for index, stored in enumerate(self._stored) if not stored.enrolment.is_on_roster}

    def knows(self, key: str) -> bool:
        """Return whether the gradebook has a student with this key."""
        return self.book.first("SELECT 1 FROM student WHERE key = ?", key) is not None

    def of(self, submission: ClassSubmission) -> StoredSubmission | None:
        """Return the stored submission of the student who is certainly the same."""
        student = submission.student
        entry = self.roster.entry(student.key) if self.roster is not None else None
        match = self._people.find(self._known(student), (*LMS_IDS, Clue.EXACT_ID))
        if not (match.people or match.contradicted) and (self.roster is None or entry is not None):
            # The login may be the name of a folder that another team has as well, or that could not be a key.
            login = "" if student.team or is_path_key(student.key) else student.login
            words = clues_of(Student(student.key, login=login, canvas=student.canvas, moodle=student.moodle))
            claims = {**words, Clue.PATH: (dumps(submission.paths),)}
            match = self._people.find(claims, (*LMS_IDS, Clue.EXACT_ID, Clue.PATH), self._not_on_roster)
        if match.only is not None:
            return self._stored[match.only]
        stored, people = self._without
        match = people.find(self._known(student), (*LMS_IDS, Clue.EXACT_ID)) if stored else match
        return stored[match.only] if match.only is not None else None

    def _known(self, student: Student) -> Clues:
        """Return the LMS ids of a student, and the data of the roster."""
        entry = self.roster.entry(student.key) if self.roster is not None else None
        from_roster = clues_of(entry.student, entry.aliases) if entry is not None else {}
        return {**from_roster, **lms_ids_of(student)}


def _clues(stored: StoredSubmission, root: str) -> Clues:
    """Return what identifies a stored student: the roster's data, else key and path (a login may be a folder name)."""
    student, entry = stored.student, stored.enrolment.roster_entry
    if stored.enrolment.is_on_roster:
        known = entry_from_json(entry) if entry else RosterEntry(student)
        return {**clues_of(known.student, known.aliases), **lms_ids_of(student)}
    path = (dumps(stored.paths),) if stored.source == root else ()
    return {**clues_of(Student(stored.key)), **lms_ids_of(student), Clue.PATH: path}


class StoredStudents:
    """The stored submissions of a gradebook, read side by side with the class: both are sorted by key.

    Students who are recognised under a new key are added to `notes`.
    """

    def __init__(self, identities: Identities, writer: RunWriter, notes: list[str]) -> None:
        self._identities, self._writer, self._notes = identities, writer, notes
        self._root, self._roster = identities.root, identities.roster
        self._rest = identities.book.stored_submissions()
        self._next = next(self._rest, None)
        self._has_any = self._next is not None
        self._passed: list[StoredSubmission] = []  # of this class folder, and not found yet
        self._renamed: set[int] = set()

    def find(self, submission: ClassSubmission) -> StoredSubmission | None:
        """Return the stored submission of a student; submissions have to be asked for in the order of their keys."""
        key = submission.student.key
        self._skip_to(key)
        stored = self._next
        if stored is not None and stored.key == key:
            self._next = next(self._rest, None)
            if not self._gives_way(stored, submission):
                return stored
        return self._under_new_key(submission) if self._has_any else None

    def is_doubtful(self, submission: ClassSubmission, stored: StoredSubmission) -> bool:
        """Return whether an uncertain submission replaces another one of the student in the same class."""
        return not (submission.is_certain or stored.source != self._root or self._is_same_path(submission, stored))

    def recognise(self, absent: Student) -> None:
        """Give the results and marks of a roster's student without a submission in this class the roster's key."""
        stored = self._identities.of(ClassSubmission(absent, ())) if not self._identities.knows(absent.key) else None
        if stored is not None and stored.student_id not in self._renamed:
            self._rename(stored, absent.key)

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
        if not self._rename(stored, key):
            return None
        self._renamed.add(stored.student_id)
        return stored

    def _rename(self, stored: StoredSubmission, key: str) -> bool:
        """Give a stored student another key, and return whether that was possible."""
        is_renamed = self._writer.rename(stored.student_id, key)
        if is_renamed:
            self._notes.append(f"{stored.key} is {key} now, with all manual marks")
        else:
            self._notes.append(f"{stored.key} and {key} seem to be the same student, but both have results: not merged")
        return is_renamed

    def _gives_way(self, stored: StoredSubmission, submission: ClassSubmission) -> bool:
        """Return whether a folder had a key until the roster gave it to another student, who is in the gradebook too.

        The folder's results and marks then get the key of its path.
        """
        if self._roster is None or stored.enrolment.is_on_roster or stored.source != self._root:
            return False
        if self._is_same_path(submission, stored) or self._identities.of(submission) is None:
            return False
        self._passed.append(stored)
        return self._writer.rename(stored.student_id, path_key(stored.paths[0]))

    def _is_same_path(self, submission: ClassSubmission, stored: StoredSubmission) -> bool:
        return home_of(stored.paths[0]) == home_of(submission.paths[0])
