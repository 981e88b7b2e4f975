"""What is wrong with a rubric that is valid.

This is what its reference does not pass, and what an edit likely forgot.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from math import degrees, inf, pi, radians
from typing import Any, NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.quantities import point
from grader.base.text import counted, enumerated
from grader.base.toml_file import TomlPath, one_line_each
from grader.lab.checks.outcome import Outcome
from grader.lab.grading.deciding import decide
from grader.lab.grading.grade import grade
from grader.lab.grading.subjects import check_selectors, joints_at
from grader.lab.rubric.criterion import Criterion
from grader.lab.rubric.rubric import Rubric, load_rubric, shipped_rubrics, unknown_causes
from grader.lab.rubric.validation import Complaint

_SIZES = ("size", "box", "cylinder", "capsule", "sphere", "radius", "length", "mass")
_PLACES, _NEAR = (
    ("xyz", "height"),
    0.05,
)  # metres: the origin can be meant, with any usual tolerance
_MAX_CAUSES = 5  # criteria in the note on those that `carried` names
_NUMBER = on_use(r"-?\d+(?:\.\d+)?")
# Of a sentence: with a decimal point, or before a unit. Others count something, or are names: ROS
# 2.
_MEASURE = on_use(
    r"(?<![\w.])(-?\d+(?:\.\d+)?(?:e[-+]?\d{1,3})?)(?!\.?\d)"
    r"(?: ?(degrees?|mm|cm|kg|percent|m|N)\b)?"
)
_ANGLES = (radians(1.0), degrees(1.0))
_UNITS = {
    "mm": (1000.0,),
    "cm": (100.0,),
    "degrees": _ANGLES,
    "degree": _ANGLES,
}  # of metres and radians in `with`
_DERIVED = (1.0, 2.0, 0.5)  # feedback may explain a diameter, or half of a height
_RIGHT_ANGLE, _LEAST_ANGLE = 90, 0.1  # degrees
_ROUNDED = {
    "m": 1e-4,
    "degrees": 0.1,
}  # how far positions may be beyond a limit: 90 degrees are above 1.57


class _Failures(NamedTuple):
    """What the reference does not pass.

    It has the lines that say it, whether it fails one, and how many are only undecided.
    """

    lines: Sequence[str]
    is_failed: bool
    undecided: int


def reference_failures(rubric: Rubric) -> _Failures:
    """Return what the reference does not pass.

    These are automatic criteria, and checks in `carried` tables.

    Criteria with one message share a line.
    """
    assert rubric.solution
    unearned = grade(rubric, rubric.solution.submission).unearned
    failures = [
        (_make_path(result.criterion), result.criterion.id, result.outcome) for result in unearned
    ]
    failures += _carried_failures(rubric)
    failures.sort(key=lambda failure: failure[0][1])
    unresolved = {path[1]: (path, line) for path, line in _unresolved_selectors(rubric)}
    places = _places_by_message(failures, unresolved)
    mistakes = list(unresolved.values())
    undecided = 0
    for outcome, places_of_outcome in places.items():
        names = [name for _, name in places_of_outcome]
        verb = "fails" if len(names) == 1 else "fail"
        what_fails = f"{enumerated(names)} {verb} on the reference: {outcome.message}"
        mistakes.append((places_of_outcome[0][0], what_fails))
        if outcome.status == "pending":
            undecided += len(names)
    is_failed = bool(unresolved) or undecided < sum(map(len, places.values()))
    return _Failures(_lines(rubric, mistakes), is_failed, undecided)


def _lines(rubric: Rubric, notes: Iterable[Complaint]) -> Sequence[str]:
    return tuple(
        one_line_each(rubric.path, [(rubric.find_line(path), what) for path, what in notes])
    )


def _make_path(criterion: Criterion) -> TomlPath:
    return ("criterion", criterion.position, "with")


def _places_by_message(
    failures: Iterable[tuple[TomlPath, str, Outcome]], unresolved: Collection[int | str]
) -> dict[Outcome, list[Complaint]]:
    """Return the places and criteria of failures with one status and message.

    Criteria whose selectors are `unresolved` are not among them.
    """
    places: dict[Outcome, list[Complaint]] = {}
    for path, name, outcome in failures:
        if path[1] not in unresolved:
            what = Outcome(outcome.status, outcome.message)
            places.setdefault(what, []).append((path, name))
    return places


def _carried_failures(rubric: Rubric) -> Iterator[tuple[TomlPath, str, Outcome]]:
    """Yield what counts instead of a criterion, if the reference does not pass it.

    It counts where an error is carried forward.
    """
    assert rubric.solution
    for criterion in rubric.criteria:
        if criterion.adjustment or criterion.bonus:
            continue
        for index, one in enumerate(criterion.carried):
            if one.at:  # a fact of robots with that mistake only
                continue
            row = criterion._replace(
                check=one.check, arguments=one.arguments, carried=(), requires=()
            )
            alone = replace(rubric, criteria=(row,))
            for result in decide(alone, rubric.solution.submission, {row.id}):
                if result.outcome.status != "passed":
                    # Of a single table the place has no index; `find_place` then finds the
                    # criterion's.
                    several = (index,) if len(criterion.carried) > 1 else ()
                    path = ("criterion", criterion.position, "carried", *several, "with")
                    yield path, f"carried of {criterion.id}", result.outcome


def _unresolved_selectors(rubric: Rubric) -> Iterator[Complaint]:
    """Yield the place of each criterion whose link cannot be told, and why.

    It names the link by a place that not exactly one has.
    """
    assert rubric.solution
    for criterion in rubric.criteria:
        if "robot" in criterion.check.examined:
            try:
                check_selectors(rubric.solution.robot, criterion)
            except (MissingElement, NotDecided) as error:
                what = (
                    f"{criterion.id} names a link by its place in the tree, and the reference "
                    "has no such link"
                )
                yield _make_path(criterion), f"{what}: {error}"


def likely_mistakes(rubric: Rubric) -> Sequence[str]:
    """Return warnings: what is valid, and hardly meant."""
    notes: list[Complaint] = []
    if _is_changed_copy(rubric):
        notes.append(
            (("id",), "the id is still that of the grader's own rubric: give this one another")
        )
    if note := _unknown_causes_note(rubric):
        notes.append(note)
    everywhere = [number for criterion in rubric.criteria for number in _numbers_given(criterion)]
    for criterion in rubric.criteria:
        for key, message in _warnings_about(rubric, criterion, everywhere):
            notes.append((("criterion", criterion.position, key), message))
    return _lines(rubric, notes)


def _unknown_causes_note(rubric: Rubric) -> Complaint | None:
    """Return one note on all criteria that `carried` names and that do not exist, at the first."""
    unknown = unknown_causes(rubric)
    if not unknown:
        return None
    names = dict.fromkeys(name for _, name in unknown)
    known = [criterion.id for criterion in rubric.criteria]
    # Of a criterion that was deleted, another one is often similar.
    meant = near(next(iter(names)), known) if len(names) == 1 else None
    guess = f"; did you mean {meant!r}?" if meant is not None else ""
    listed = enumerated(names, _MAX_CAUSES)
    what = "a criterion that does" if len(names) == 1 else "criteria that do"
    return unknown[0][0], f"carried names {what} not exist, which has no effect: {listed}{guess}"


def _is_changed_copy(rubric: Rubric) -> bool:
    """Return whether a rubric is a changed copy of one of the grader's.

    It has its id and most of its criteria, but not quite the same.
    """
    if rubric.id not in shipped_rubrics() or rubric.is_shipped:
        return False
    shipped = load_rubric(rubric.id).criteria
    ids = {criterion.id for criterion in rubric.criteria}
    copied = {criterion.id for criterion in shipped}
    return rubric.criteria != shipped and 2 * len(ids & copied) > len(ids)


def _warnings_about(
    rubric: Rubric, criterion: Criterion, everywhere: list[float]
) -> Iterator[tuple[str, str]]:
    """Yield warnings about a criterion, each with the key that it is about."""
    numbers_given = list(_numbers_given(criterion))
    if stale := _unknown_measures(criterion.title, numbers_given):
        yield "title", f"the title says {enumerated(stale)}, which `with` does not"
    known = [number * factor for number in (*everywhere, _RIGHT_ANGLE) for factor in _DERIVED]
    if stale := _unknown_measures(" ".join(criterion.feedback.values()), known):
        yield "feedback", f"the feedback says {enumerated(stale)}, which no criterion does"
    arguments = criterion.arguments
    tolerance = criterion.arguments.get("tolerance", 0)
    if tolerance >= max(_measured_sizes(arguments), default=inf):
        yield (
            "with",
            (
                f"the tolerance {tolerance:g} is not below what {criterion.check.name} "
                "measures: anything passes"
            ),
        )
    for key, value in arguments.items():
        unit = criterion.check.documentation.arguments.get(key, "")
        if "metres" in unit and tolerance < _LEAST_ANGLE:  # the limits of a slider
            continue
        yield from (
            ("with", message) for message in _other_angles(key, unit, list(_numbers(value)))
        )
    if rubric.solution and criterion.at and rubric.solution.reading.robot is not None:
        yield from (("at", message) for message in _beyond_limits(rubric, criterion))


def _measured_sizes(arguments: Mapping[str, Any]) -> Iterator[float]:
    """Yield how large what a check measures is.

    This is lengths, a mass, a range, or the distance of a place.
    """
    yield from (number for key in _SIZES for number in _numbers(arguments.get(key)) if number > 0)
    ends = list(_numbers([arguments.get("lower"), arguments.get("upper")]))
    if len({*ends}) > 1:
        yield max(ends) - min(ends)
    if "angle" not in arguments:  # else only the orientation may be meant
        yield from (
            max(_NEAR, *map(abs, _numbers(arguments[key]))) for key in _PLACES if key in arguments
        )


def _numbers_given(criterion: Criterion) -> Iterator[float]:
    """Yield every number that a rubric gives for a criterion, except in its texts."""
    carried = [one.arguments for one in criterion.carried]
    yield from _numbers(
        [criterion.arguments, criterion.at, criterion.args, carried, criterion.choices]
    )


def _numbers(value: Any) -> Iterator[float]:
    match value:
        case bool():
            return
        case str():
            yield from map(float, _NUMBER.findall(value))
        case Mapping():
            yield from _numbers([*value, *value.values()])
        case Iterable():
            for item in value:
                yield from _numbers(item)
        case None:
            return
        case number:
            yield float(number)


def _unknown_measures(sentence: str, numbers: Sequence[float]) -> list[str]:
    """Return the measures in a sentence that are none of these numbers.

    They are compared as exactly as they are written.
    """
    unknown_measures = []
    for text, unit in _MEASURE.findall(sentence):
        scales = (1.0, *_UNITS.get(unit, _ANGLES))
        digits = -int(Decimal(text).as_tuple().exponent)
        fitting = {round(abs(number) * scale, digits) for number in numbers for scale in scales}
        if (digits or unit) and abs(float(text)) not in fitting:
            unknown_measures.append(text)
    return unknown_measures


def _other_angles(key: str, unit: str, values: list[float]) -> Iterator[str]:
    """Yield that angles seem to be in another unit than is asked.

    These are radians in place of degrees, or degrees in place of radians.
    """
    for value in values:
        if "in degrees" in unit and _is_like_radians(value):
            yield (
                f"{key} is in degrees, and {value:g} looks like radians: "
                f"{counted(round(degrees(value)), 'degree')}?"
            )
        elif "in radians" in unit and abs(value) > 2 * pi + 1e-3:
            yield f"{key} is in radians, and {value:g} looks like degrees: {radians(value):.4f}?"


def _is_like_radians(value: float) -> bool:
    """Return whether a number is a multiple of 45 degrees in radians.

    With more decimals than two, multiples of 15 degrees count, with more than three of 1.
    """
    digits = len(f"{value:.10g}".partition(".")[2])
    step = radians({2: 45, 3: 15}.get(digits, 1))
    return (
        digits >= 2
        and 0 < abs(value) <= 2 * pi
        and round(round(value / step) * step, digits) == value
    )


def _beyond_limits(rubric: Rubric, criterion: Criterion) -> Iterator[str]:
    """Yield positions of joints that the reference's limits exclude, or that seem to be radians."""
    assert rubric.solution
    try:
        joints = joints_at(rubric.solution.robot, criterion.at)
    except (MissingElement, NotDecided):
        return  # the criterion fails on the reference
    for joint, value, unit in joints:
        if unit == "degrees":
            yield from _other_angles(f"at of {joint.name}", "in degrees", [value])
        if not joint.limit or joint.type == "continuous":
            continue
        ends = (joint.limit.lower, joint.limit.upper)
        lower, upper = ends if unit == "m" else map(degrees, ends)
        if not lower - _ROUNDED[unit] <= value <= upper + _ROUNDED[unit]:
            limits = f"{point((lower,))} to {point((upper,))} {unit}"
            yield (
                f"at puts {joint.name} at {value:g} {unit}, outside of its limits in the "
                f"reference: {limits}"
            )
