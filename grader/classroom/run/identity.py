"""Who of those in the gradebook is meant by a new key: a roster that comes later, or is corrected, gives people other keys."""

from collections.abc import Callable, Iterable
from functools import cached_property
from json import dumps, loads

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.stored import StoredSubmission
from grader.classroom.intake.layouts.layout import is_place_key
from grader.classroom.intake.roster import Roster, RosterEntry, entry_from_json
from grader.classroom.matching import NUMBERS, Clue, Clues, People, clues_of, numbers_of
from grader.classroom.students import ClassSubmission, Student


class Identities:
    """Those whom a gradebook knew when a run began. `keys` are those of the class that is graded now.

    A student whose key is in the class or on the roster keeps it, and everything with it. Of the others, one who was on a roster is
    recognised by the numbers of the LMS and by what the roster says, never by what a folder is named; one who never was is
    recognised by the exact name as well, and by the place of the submission.
    """

    def __init__(self, book: Gradebook, root: str, roster: Roster | None, keys: Callable[[], Iterable[str]]) -> None:
        self._book, self._root, self._roster, self._keys = book, root, roster, keys

    @cached_property
    def _known(self) -> list[StoredSubmission]:
        """Those whose key is neither in the class nor on the roster: in most runs nobody asks for them."""
        kept = set(self._keys()).union(student.key for student in (self._roster.students if self._roster else ()))
        return [each for each in self._book.all_known() if each.key not in kept]

    @cached_property
    def _people(self) -> People:
        return People(_clues(each, self._root) for each in self._known)

    @cached_property
    def _never_on_roster(self) -> set[int]:
        return {index for index, each in enumerate(self._known) if not each.is_expected}

    def of(self, hand_in: ClassSubmission) -> StoredSubmission | None:
        """The one who is certainly the same."""
        student = hand_in.student
        entry = self._roster.entry(student.key) if self._roster is not None else None
        told = clues_of(entry.student, entry.aliases) if entry is not None else {}
        found = self._people.find({**told, **numbers_of(student)}, (*NUMBERS, Clue.WORD))
        if not (found.people or found.contradicted) and (self._roster is None or entry is not None):
            # Another folder may have the same name: in another team, or where the name could not be the key.
            login = "" if student.team or is_place_key(student.key) else student.login
            words = clues_of(Student(student.key, login=login, canvas=student.canvas, moodle=student.moodle))
            claims = {**words, Clue.PLACE: (dumps(hand_in.paths),)}
            found = self._people.find(claims, (*NUMBERS, Clue.WORD, Clue.PLACE), self._never_on_roster)
        return self._known[found.only] if found.only is not None else None


def _clues(known: StoredSubmission, root: str) -> Clues:
    """What identifies a student of the gradebook: what a roster said; else the key and the place, for a login may be a folder's name."""
    if known.is_expected:
        entry = entry_from_json(known.entry) if known.entry else RosterEntry(known.record)
        return {**clues_of(entry.student, entry.aliases), **numbers_of(known.record)}
    place = (dumps(loads(known.place)[0]),) if known.source == root else ()
    return {**clues_of(Student(known.key)), **numbers_of(known.record), Clue.PLACE: place}
