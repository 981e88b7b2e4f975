"""Recognise students of a gradebook under a new key: a later or corrected roster gives students other keys."""

from collections.abc import Callable, Iterable
from functools import cached_property
from json import dumps

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.stored import StoredSubmission
from grader.classroom.intake.layouts.layout import is_path_key
from grader.classroom.intake.roster import Roster, RosterEntry, entry_from_json
from grader.classroom.matching import NUMBERS, Clue, Clues, People, clues_of, numbers_of
from grader.classroom.students import ClassSubmission, Student


class Identities:
    """The students that were in a gradebook when a run began. `keys` returns the keys of the class that is graded now.

    A student whose key is in the class or on the roster keeps it, with all results. Of the others, one who was on a roster is
    recognised by LMS ids and by the data of the roster, never by the name of a folder; one who was not is recognised by the exact
    name as well, and by the path of the submission.
    """

    def __init__(self, book: Gradebook, root: str, roster: Roster | None, keys: Callable[[], Iterable[str]]) -> None:
        self._book, self._root, self._roster, self._keys = book, root, roster, keys

    @cached_property
    def _stored(self) -> list[StoredSubmission]:
        """The students whose key is neither in the class nor on the roster; most runs do not need them."""
        kept = set(self._keys()).union(student.key for student in (self._roster.students if self._roster else ()))
        return [stored for stored in self._book.stored_submissions() if stored.key not in kept]

    @cached_property
    def _people(self) -> People:
        return People(_clues(stored, self._root) for stored in self._stored)

    @cached_property
    def _not_on_roster(self) -> set[int]:
        return {index for index, stored in enumerate(self._stored) if not stored.is_on_roster}

    def of(self, submission: ClassSubmission) -> StoredSubmission | None:
        """Return the stored submission of the student who is certainly the same."""
        student = submission.student
        entry = self._roster.entry(student.key) if self._roster is not None else None
        from_roster = clues_of(entry.student, entry.aliases) if entry is not None else {}
        match = self._people.find({**from_roster, **numbers_of(student)}, (*NUMBERS, Clue.WORD))
        if not (match.people or match.contradicted) and (self._roster is None or entry is not None):
            # The login may be the name of a folder that another team has as well, or that could not be a key.
            login = "" if student.team or is_path_key(student.key) else student.login
            words = clues_of(Student(student.key, login=login, canvas=student.canvas, moodle=student.moodle))
            claims = {**words, Clue.PATH: (dumps(submission.paths),)}
            match = self._people.find(claims, (*NUMBERS, Clue.WORD, Clue.PATH), self._not_on_roster)
        return self._stored[match.only] if match.only is not None else None


def _clues(stored: StoredSubmission, root: str) -> Clues:
    """Return what identifies a stored student: the roster's data, else the key and the path (a login may be a folder's name)."""
    student, entry = stored.profile.student, stored.profile.enrolment.roster_entry
    if stored.is_on_roster:
        known = entry_from_json(entry) if entry else RosterEntry(student)
        return {**clues_of(known.student, known.aliases), **numbers_of(student)}
    path = (dumps(stored.paths),) if stored.source == root else ()
    return {**clues_of(Student(stored.key)), **numbers_of(student), Clue.PATH: path}
