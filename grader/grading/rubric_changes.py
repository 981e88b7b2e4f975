"""The differences between two rubrics, as far as they can change points."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from operator import attrgetter
from typing import Any, NamedTuple

from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric

_Values = Callable[[Any], object]
_KEYS_OF_RUBRIC: Mapping[str, _Values] = {
    **{
        name: attrgetter(name)
        for name in ("urdf", "package", "folders", "reference", "without_urdf", "without_package")
    },
    "part": lambda rubric: tuple((part.id, part.needs) for part in rubric.parts),
}
_KEYS_OF_CRITERION: Mapping[str, _Values] = {
    **{name: attrgetter(name) for name in ("bonus", "part", "requires", "at")},
    "check": lambda row: row.check.name,
    "carried": lambda row: [(one.causes, one.check.name, one.arguments) for one in row.carried] or None,
}


class RubricChange(NamedTuple):
    """A key with another value: of a criterion, or of the rubric itself where `criterion` is empty.

    The key `criterion` means that a criterion was added or removed. A key that criteria do not have is an argument of
    the check. A missing value is None.
    """

    criterion: str
    key: str
    before: object
    after: object


def rubric_changes(before: Rubric, after: Rubric) -> Mapping[str, tuple[RubricChange, ...]]:
    """Return what changed in each criterion, in the order of the newer rubric; under "" what changed in the rest."""
    old = {row.id: row for row in before.criteria}
    new = {row.id: row for row in after.criteria}
    found = {name: tuple(_of_criterion(name, old.get(name), new.get(name))) for name in {**new, **old}}
    found[""] = tuple(_different("", _KEYS_OF_RUBRIC, before, after))
    return {name: some for name, some in found.items() if some}


def concerning(
    names: Iterable[str], changes: Mapping[str, tuple[RubricChange, ...]], *rubrics: Rubric
) -> Iterator[RubricChange]:
    """Yield the changes that concern some criteria.

    These are their own changes, else those of the criteria that they depend on, else those of the rubric itself.
    """
    needs: dict[str, set[str]] = {}
    for row in (row for rubric in rubrics for row in rubric.criteria):
        needs.setdefault(row.id, set()).update(row.requires, *(one.causes for one in row.carried))
    concerned: set[str] = set()
    for name in names:
        level = {name}
        while level and not level & changes.keys():
            level = {other for one in level for other in needs.get(one, ())}
        concerned |= level & changes.keys() or {""}
    for name, some in changes.items():
        if name in concerned:
            yield from some


def _of_criterion(name: str, old: Criterion | None, new: Criterion | None) -> Iterator[RubricChange]:
    if old is None or new is None:
        yield RubricChange(name, "criterion", old and old.points, new and new.points)
        return
    if old.adjustment != new.adjustment:
        yield RubricChange(name, "adjust", old.adjustment, new.adjustment)
    if old.points != new.points and not any(row.adjustment is not None and not row.is_given for row in (old, new)):
        yield RubricChange(name, "points", old.points, new.points)
    yield from _different(name, _KEYS_OF_CRITERION, old, new)
    arguments = {**old.arguments, **new.arguments}
    yield from _different(name, {key: partial(_argument, key) for key in arguments}, old, new)


def _argument(key: str, criterion: Criterion) -> object:
    return criterion.arguments.get(key)


def _different(name: str, keys: Mapping[str, _Values], old: object, new: object) -> Iterator[RubricChange]:
    for key, value_of in keys.items():
        before, after = value_of(old), value_of(new)
        if before != after:
            yield RubricChange(name, key, before, after)
