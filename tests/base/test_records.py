"""Values that load quickly behave as those of the standard library."""

import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import pytest

from grader.base.records import Named, Record


class Quick(Named):
    """A wheel."""

    name: str
    radius: float = 0.1
    holes: int = 0


class Usual(NamedTuple):
    """The same as a named tuple."""

    name: str
    radius: float = 0.1
    holes: int = 0


class QuickView(Quick):
    """A value that is made of another one."""

    _of: Quick  # no field


class Wheel(Record):
    """A wheel that keeps its width."""

    name: str
    holes: list[int] = field(default_factory=list)
    radius: float = 0.1
    area: float = field(init=False)

    def __post_init__(self) -> None:
        vars(self)["area"] = self.radius * self.radius

    @cached_property
    def width(self) -> float:
        """Half of its radius."""
        return self.radius / 2


class Tyre(Wheel):
    """A wheel with one more field."""

    profile: str = "slick"


class Open(Record, frozen=False):
    """A record whose fields change."""

    count: int = 0


@pytest.mark.parametrize(
    "use",
    [
        lambda kind: kind("a"),
        lambda kind: kind("a", 0.2, 3),
        lambda kind: kind("a", holes=2),
        lambda kind: kind(radius=0.3, name="b"),
        lambda kind: kind("a")._replace(radius=1),
        lambda kind: kind("a")._asdict(),
        lambda kind: pickle.loads(pickle.dumps(kind("a", 1))),
        lambda kind: (kind("a").name, kind("a").holes, kind._fields, kind._field_defaults),
        lambda kind: repr(kind("a")).removeprefix(kind.__name__),
        lambda kind: hash(kind("a")),
    ],
)
def test_a_named_value_is_as_a_named_tuple(use: Callable[[Any], object]) -> None:
    """It is made, changed, compared, printed and pickled in the same way."""
    assert use(Quick) == use(Usual)


@pytest.mark.parametrize("kind", [Quick, Usual])
@pytest.mark.parametrize(
    ("values", "named"),
    [
        ((), {}),
        (("a", 1, 2, 3), {}),
        (("a",), {"radus": 1}),
        ((), {"radus": 1}),
        (("a", 1, 2, 3), {"holes": 1}),
    ],
)
def test_wrong_fields_are_refused(kind: Any, values: tuple[Any, ...], named: Any) -> None:
    """A missing field, one too many and an unknown name raise TypeError, as for a named tuple."""
    with pytest.raises(TypeError):
        kind(*values, **named)


def test_a_named_value_has_nothing_but_its_fields() -> None:
    """No attribute can be set, a class pattern takes its places, and a subclass has the same fields."""
    value: Any = Quick("a")
    for name in ("radius", "other"):
        with pytest.raises(AttributeError):
            setattr(value, name, 1)
    match value:
        case Quick(name, radius):
            assert (name, radius) == ("a", 0.1)
        case _:
            pytest.fail("it does not match")
    view = QuickView("b")
    view._of = Quick("a")
    assert (QuickView._fields, view._of.name, view.name) == (Quick._fields, "a", "b")


def test_a_record_is_as_a_frozen_dataclass() -> None:
    """It has defaults, computed fields and changed copies, and is equal to itself only."""
    wheel = Wheel("a", radius=2)
    assert (wheel.name, wheel.holes, wheel.area, wheel.width) == ("a", [], 4, 1)
    assert wheel.holes is not Wheel("b").holes
    assert replace(wheel, name="b").area == 4
    assert replace(Tyre("c", profile="deep"), radius=3).profile == "deep"
    assert wheel == wheel and wheel != Wheel("a", radius=2)
    changed: Any = wheel
    with pytest.raises(FrozenInstanceError):
        changed.radius = 1
    with pytest.raises(FrozenInstanceError):
        del changed.radius


def test_a_record_can_be_open() -> None:
    """With `frozen=False` its fields change."""
    record = Open()
    record.count += 1
    assert (record.count, Open().count) == (1, 0)


@pytest.mark.parametrize(
    ("values", "named"), [((), {}), (("a",), {"size": 1}), (tuple("abcde"), {})]
)
def test_wrong_fields_of_a_record_are_refused(values: tuple[Any, ...], named: Any) -> None:
    """A missing field, one too many and an unknown name raise TypeError."""
    kind: Any = Wheel
    with pytest.raises(TypeError):
        kind(*values, **named)
