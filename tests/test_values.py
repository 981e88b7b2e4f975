"""Dataclasses behave as those of the standard library, and equal small files are read once."""

import dataclasses
from dataclasses import field, replace
from typing import Any

import pytest

from grader.values import dataclass, reuse


@dataclass(frozen=True, slots=True)
class _Point:
    x: int
    names: tuple[str, ...] = ()
    table: dict[str, int] = field(default_factory=dict)
    seen: list[int] = field(default_factory=list, init=False, compare=False)


@dataclass(frozen=True)
class _Empty: ...


@dataclass(frozen=True)
class _Checked:
    x: int
    twice: int = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "twice", 2 * self.x)


def test_an_instance_gets_its_arguments_and_its_defaults() -> None:
    """Arguments may be given by position or name; a default factory is called for each instance."""
    first, second = _Point(1, ("a",)), _Point(x=1, names=("a",), table={})
    assert (first.x, first.names, first.table, first.seen) == (1, ("a",), {}, [])
    assert first == second != _Point(2, ("a",))
    assert first.table is not second.table
    assert first.seen is not second.seen
    assert repr(_Empty()) == "_Empty()"


def test_a_copy_with_another_value() -> None:
    """`replace` and `__post_init__` work as in the standard library."""
    assert replace(_Point(1, table={"a": 2}), x=3) == _Point(3, table={"a": 2})
    assert replace(_Checked(2), x=4).twice == 8
    assert [one.name for one in dataclasses.fields(_Checked)] == ["x", "twice"]


@pytest.mark.parametrize("arguments", [{}, {"x": 1, "y": 2}, {"x": 1, "seen": []}])
def test_wrong_arguments_are_refused(arguments: dict[str, Any]) -> None:
    """A missing argument is an error, and so is one that the class does not take."""
    with pytest.raises(TypeError, match="__init__"):
        _Point(**arguments)


def test_equal_small_files_are_read_once() -> None:
    """A reader gets equal bytes under one path once, other bytes, other paths and large files each time."""
    given: list[tuple[bytes, str]] = []

    @reuse
    def read(data: bytes, path: str) -> list[str]:
        given.append((data, path))
        return [path]

    small, large = b"<package/>", bytes(20_000)
    assert read(small, "a") is read(small, "a") == ["a"]
    assert [read(small, "b"), read(b"", "a"), read(large, "a"), read(large, "a")] == [["b"], ["a"], ["a"], ["a"]]
    assert given == [(small, "a"), (small, "b"), (b"", "a"), (large, "a"), (large, "a")]
