"""Equal small files are read once, and results that are kept cost the same as new ones."""

from collections.abc import Sequence
from functools import partial
from itertools import permutations

import pytest

from grader.base.reuse import Memory, reuse
from grader.ros.python.budget import Budget


def test_equal_small_files_are_read_once() -> None:
    """A reader gets equal bytes under one path once, other bytes, other paths and large files each time."""
    given: list[tuple[bytes, str]] = []

    @reuse
    def read(data: bytes, path: str) -> list[str]:
        given.append((data, path))
        return [path]

    small, large = b"<package/>", bytes(20_000)
    assert read(small, "a") is read(small, "a") == ["a"]
    assert [read(small, "b"), read(b"", "a"), read(large, "a"), read(large, "a")] == [
        ["b"],
        ["a"],
        ["a"],
        ["a"],
    ]
    assert given == [(small, "a"), (small, "b"), (b"", "a"), (large, "a"), (large, "a")]


class _Package:
    """Files that are kept in a memory, all but one of which need a table that the package makes once."""

    def __init__(self, memory: Memory) -> None:
        self._memory, self._has_table, self._work = memory, False, Budget(1_000)
        self._budget = Budget(whole=self._work)

    def charged(self, names: Sequence[str]) -> int:
        """Return what reading files and the table takes in all."""
        for name in names:
            if name == "table":
                self._read_table()
            else:
                self._memory.recall(name, None, self._budget, partial(self._read, name))
        return self._work.used

    def _read(self, name: str, _: object) -> None:
        if name != "plain":
            self._read_table()
        self._budget.charge(10)

    def _read_table(self) -> None:
        if not self._has_table:
            self._has_table = True
            Memory().recall("table", None, self._budget, lambda _: self._budget.charge(100))


@pytest.mark.parametrize("order", [*permutations(["plain", "one", "other", "table"])])
def test_what_is_kept_costs_the_same_whoever_asks_first(order: Sequence[str]) -> None:
    """What a package has done once is no part of the cost of a file that was read before it."""
    memory = Memory()
    assert [_Package(memory).charged(order) for _ in range(3)] == [130] * 3
