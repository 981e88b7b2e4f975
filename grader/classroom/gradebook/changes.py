"""The differences between two runs, or two gradebooks: which students, by how much, in which criteria, and why."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import NamedTuple

from grader.classroom.gradebook.snapshots import NOBODY, Snapshot, StudentState, states_of
from grader.grading.rubric_changes import RubricChange, concerning, rubric_changes
from grader.text import format_points


class PointsChange(NamedTuple):
    """The points of a criterion before and after; None if it was not graded, or not decided."""

    criterion: str
    before: Decimal | None
    after: Decimal | None


@dataclass(frozen=True, slots=True)
class Change:
    """The changes for one student, and their causes. A grade that counts is None if there was none.

    `is_regraded` is False if only points of criteria changed, and the grade did not. `rubric` are the changes of the
    rubric that concern the criteria in `steps`.
    """

    key: str
    before: Decimal | None
    after: Decimal | None
    steps: tuple[PointsChange, ...]
    why: tuple[str, ...]
    name: str = ""
    rubric: tuple[RubricChange, ...] = ()
    is_regraded: bool = True


_Comparison = Callable[[str, str, tuple[str, ...]], tuple[RubricChange, ...]]


def changes(before: Snapshot, after: Snapshot) -> list[Change]:
    """Return the students for whom something changed, in the order of their keys."""
    old, new = states_of(before), states_of(after)
    rubrics = {state.sha256: state.rubric for state in (*old.values(), *new.values()) if state.rubric is not None}

    @cache
    def changed(before: str, after: str) -> Mapping[str, tuple[RubricChange, ...]]:
        return rubric_changes(rubrics[before], rubrics[after])

    @cache
    def comparison(before: str, after: str, names: tuple[str, ...]) -> tuple[RubricChange, ...]:
        return tuple(concerning(names, changed(before, after), rubrics[before], rubrics[after]))

    keys = sorted(old.keys() | new.keys())
    found = (_change(key, old.get(key, NOBODY), new.get(key, NOBODY), comparison) for key in keys)
    return [change for change in found if change is not None]


def _change(key: str, old: StudentState, new: StudentState, comparison: _Comparison) -> Change | None:
    whole = (key, old.total, new.total)
    name = new.name or old.name
    final = tuple(_final_mark(old, new))
    if not (old.verdict and new.verdict):
        why = (*_submission_change(old, new), *final)
        return Change(*whole, (), why, name) if why else None
    steps = tuple(_steps(old, new))
    removed = tuple(name for name in old.points if name in new.marks and name not in new.points)
    late = (f"late penalty: {format_points(-old.late)} to {format_points(-new.late)}",) * (old.late != new.late)
    is_other = bool(final or removed) or old.verdict != new.verdict
    if not (steps or late or is_other):
        return None
    why = (*_reasons(old, new), *late, *final)
    why += tuple(f"the manual mark of {name} no longer counts: the rubric no longer has it" for name in removed)
    names = (*(step.criterion for step in steps), *removed) or ("",) * bool(late)
    found = comparison(old.sha256, new.sha256, names) if old.sha256 != new.sha256 else ()
    return Change(*whole, steps, why, name, found, is_other or old.total != new.total)


def _submission_change(old: StudentState, new: StudentState) -> Iterator[str]:
    """Yield that a student has a submission in one of two runs only."""
    if new.verdict:
        yield "first submission"
    elif old.verdict:
        yield "no longer there"


def _steps(old: StudentState, new: StudentState) -> Iterator[PointsChange]:
    for name in dict.fromkeys((*old.points, *new.points)):
        before, after = old.points.get(name), new.points.get(name)
        if before != after:
            yield PointsChange(name, before, after)


def _reasons(old: StudentState, new: StudentState) -> Iterator[str]:
    """Yield what may have changed the points of criteria."""
    reasons = (
        (old.digest != new.digest, "the submission changed"),
        (old.sha256 != new.sha256, "the rubric changed"),
        (old.version != new.version, "the grader changed"),
        (old.sha256 == new.sha256 and old.parts != new.parts, "graded on other parts"),
        (_has_other_marks(old, new), "manual marks changed"),
        (old.verdict != new.verdict, f"it was {old.verdict}, and is {new.verdict}"),
    )
    yield from (reason for holds, reason in reasons if holds)


def _has_other_marks(old: StudentState, new: StudentState) -> bool:
    changed = {name for name, _ in old.marks.items() ^ new.marks.items()}
    return bool(changed and changed - old.uncounted - new.uncounted)


def _final_mark(old: StudentState, new: StudentState) -> Iterator[str]:
    """Yield what changed in the final mark and the excuse, in words."""
    if old.final != new.final:
        before, after = ("none" if one.final is None else format_points(one.final) for one in (old, new))
        yield f"final mark: {before} to {after}"
    if old.is_excused != new.is_excused:
        yield "excused" if new.is_excused else "no longer excused"
