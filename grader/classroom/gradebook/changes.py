"""What changed between two runs, or two gradebooks: who, by how much, in which criteria, and why."""

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook, Run
from grader.classroom.gradebook.result import UNITS_PER_POINT
from grader.errors import InputError
from grader.grading.rubric import Rubric
from grader.text import printable_path

_STATE = """
SELECT student.id, student.key, result.signs, result.verdict, result.digest, result.rubric, result.version
FROM student JOIN seen ON seen.student = student.id AND seen.run =
    (SELECT max(run) FROM seen AS newer WHERE newer.student = student.id AND newer.run <= ?)
JOIN result ON result.id = seen.result ORDER BY student.key
"""
_RULINGS = """
SELECT student, criterion, points FROM mark WHERE points IS NOT NULL AND id =
    (SELECT max(id) FROM mark AS newer WHERE newer.student = mark.student AND newer.criterion = mark.criterion AND newer.id <= ?)
"""
_EVER = 2**62


class Snapshot(NamedTuple):
    """One of the two that are compared: a run in a gradebook, with the marks by hand up to one of them."""

    book: Gradebook
    run: int
    last_mark: int = _EVER

    @property
    def newest_run(self) -> Run:
        """The run itself, or the newest one up to it; raises InputError where there is none."""
        runs = [run for run in self.book.runs() if run.id <= self.run]
        if not runs:
            raise self.book.nothing_graded()
        return runs[-1]


class PointsChange(NamedTuple):
    """A criterion before and after; None where it was not graded, or nobody had decided."""

    criterion: str
    before: Decimal | None
    after: Decimal | None


@dataclass(frozen=True, slots=True)
class Change:
    """What changed for one student. A score is None where there was none; `why` names what was another before."""

    key: str
    before: Decimal | None
    after: Decimal | None
    steps: tuple[PointsChange, ...]
    why: tuple[str, ...]


class _State(NamedTuple):
    verdict: str
    digest: str
    rubric: str
    version: str
    points: Mapping[str, Decimal | None]
    rulings: Mapping[str, int]

    @property
    def score(self) -> Decimal:
        return sum((each for each in self.points.values() if each is not None), Decimal(0))


def last_two(book: Gradebook, before: int | None = None, after: int | None = None) -> tuple[Snapshot, Snapshot]:
    """The last two runs in a gradebook, or two that are named by their numbers; raises InputError.

    The older is taken with the marks by hand that there were when it began, the newer with those that followed it.
    """
    runs = {run.id: run for run in book.runs()}
    if len(runs) < 2:
        again = f"grader batch PATH --gradebook {printable_path(book.path)}"
        raise InputError(f"there are no two runs to compare: {again} makes one more, or name a second gradebook")
    for run in (before, after):
        if run is not None and run not in runs:
            raise InputError(f"there is no run {run}; there are: {', '.join(map(str, runs))}")
    newer = max(runs) if after is None else after
    older = max((run for run in runs if run < newer), default=newer) if before is None else before
    if older >= newer:
        raise InputError(f"run {older} is not before run {newer}")
    later = [run.last_mark for run in runs.values() if run.id > newer]
    return Snapshot(book, older, runs[older].last_mark), Snapshot(book, newer, min(later, default=_EVER))


def newest(book: Gradebook) -> Snapshot:
    """The newest state of a gradebook."""
    return Snapshot(book, _EVER)


def changes(before: Snapshot, after: Snapshot) -> list[Change]:
    """Everyone for whom something changed, in the order of their keys."""
    old, new = _states(before), _states(after)
    found = []
    for key in sorted(old.keys() | new.keys()):
        change = _change(key, old.get(key), new.get(key))
        if change is not None:
            found.append(change)
    return found


def _states(side: Snapshot) -> dict[str, _State]:
    rulings: dict[int, dict[str, int]] = {}
    for student, criterion, points in side.book.rows(_RULINGS, side.last_mark):
        rulings.setdefault(student, {})[criterion] = points
    rubrics: dict[str, Rubric] = {}
    states: dict[str, _State] = {}
    for student, key, signs, verdict, digest, rubric, version in side.book.rows(_STATE, side.run):
        if rubric not in rubrics:
            rubrics[rubric] = side.book.rubric(rubric)
        given = rulings.get(student, {})
        points = _points(rubrics[rubric], signs, given)
        states[key] = _State(verdict, digest, rubric, version, points, given)
    return states


def _points(rubric: Rubric, signs: str, rulings: Mapping[str, int]) -> dict[str, Decimal | None]:
    worth = {"f": Decimal(0), "s": Decimal(0)}
    return {
        criterion.id: Decimal(rulings[criterion.id]) / UNITS_PER_POINT
        if criterion.id in rulings
        else criterion.points
        if sign == "p"
        else worth.get(sign)
        for criterion, sign in zip(rubric.criteria, signs, strict=True)
    }


def _change(key: str, old: _State | None, new: _State | None) -> Change | None:
    if old is None or new is None:
        why = "handed in for the first time" if old is None else "not there any more"
        return Change(key, old.score if old else None, new.score if new else None, (), (why,))
    names = dict.fromkeys((*old.points, *new.points))
    steps = tuple(
        PointsChange(name, old.points.get(name), new.points.get(name))
        for name in names
        if old.points.get(name) != new.points.get(name)
    )
    if not steps and old.verdict == new.verdict:
        return None
    reasons = (
        (old.digest != new.digest, "the submission changed"),
        (old.rubric != new.rubric, "the rubric changed"),
        (old.version != new.version, "the grader changed"),
        (old.rulings != new.rulings, "marked by hand"),
        (old.verdict != new.verdict, f"it was {old.verdict}, and is {new.verdict}"),
    )
    return Change(key, old.score, new.score, steps, tuple(words for holds, words in reasons if holds))
