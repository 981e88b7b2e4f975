"""Who of those in the gradebook is meant by a new key: a roster that comes later, or is left out, names the same people otherwise."""

import json

from grader.classroom.gradebook import Gradebook
from grader.classroom.known import Known
from grader.classroom.students import HandIn, Student


class Identities:
    """Those whom a gradebook knew when a run began, by all that is theirs alone."""

    def __init__(self, book: Gradebook, root: str) -> None:
        self._found: dict[tuple[str, str], Known | None] = {}
        for known in book.all_known():
            key, _, email, login, sis, canvas, moodle, *_ = known.told
            self._enter("canvas", canvas, known)
            self._enter("moodle", moodle, known)
            for word in {key, email, login, sis}:
                self._enter("word", str(word).casefold(), known)
            if known.source == root:
                self._enter("place", _place(known), known)

    def _enter(self, kind: str, value: str, known: Known) -> None:
        if value:
            self._found[kind, value] = known if (kind, value) not in self._found else None  # of several nobody is meant

    def of(self, hand_in: HandIn) -> Known | None:
        """The one who is surely the same: by the number in the LMS, else by a login or key, else by the place of the hand-in."""
        student = hand_in.student
        ways = [("canvas", student.canvas), ("moodle", student.moodle)]
        ways += [("word", word.casefold()) for word in (student.login, student.sis, student.email, student.key) if word]
        ways.append(("place", json.dumps(hand_in.paths)))
        for way in ways:
            known = self._found.get(way) if way[1] else None
            if known is not None and not _differ(known, student):
                return known
        return None


def _place(known: Known) -> str:
    return json.dumps(json.loads(known.place)[0])


def _differ(known: Known, student: Student) -> bool:
    """Whether two are surely not the same: an LMS knows them by other numbers."""
    *_, canvas, moodle = known.told[:7]
    return any(old and new and old != new for old, new in ((canvas, student.canvas), (moodle, student.moodle)))
