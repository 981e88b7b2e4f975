"""Results that are used again.

A class has equal small files in every submission, those of a handout, and an editor shows the same
files after each change of one of them.
"""

from collections.abc import Callable, Hashable
from functools import lru_cache
from typing import Any, Generic, Protocol, TypeVar, TypeVarTuple

from grader.base.records import Named

_Names = TypeVarTuple("_Names")
_T = TypeVar("_T")
_Asked = TypeVar("_Asked")
_Cost = tuple[int, int]  # parts of a budget, and of that of the whole submission
_SMALL = 16 * 1024  # bytes


def reuse(read: Callable[[bytes, *_Names], _T]) -> Callable[[bytes, *_Names], _T]:
    """Return a reader that reads equal small files once. What it returns must not be changed."""
    read_once = lru_cache(maxsize=4)(
        read
    )  # few: with 16, a class without equal files takes 2 % longer

    def reader(data: bytes, *names: *_Names) -> _T:
        return (read_once if len(data) <= _SMALL else read)(data, *names)

    return reader


class _Work(Protocol):
    """A budget to which work is charged."""

    @property
    def is_spent(self) -> bool:
        """Whether nothing more can be charged."""

    def mark(self) -> _Cost:
        """Return what is left."""

    def repeat(self, cost: _Cost) -> bool:
        """Charge again what was charged for the same work; return whether it was left."""

    def set_apart(self, cost: _Cost) -> None:
        """Leave work that was charged out of the marks."""


class Answers(Generic[_Asked]):
    """What something was asked, and its answers.

    Where another one answers alike, work that asks nothing else has the same result.
    """

    def __init__(self, asked: _Asked) -> None:
        self._asked: _Asked | None = asked
        self._answers: list[tuple[Callable[[_Asked], object], object]] = []

    def ask(self, question: Callable[[_Asked], _T]) -> _T:
        """Return the answer to a question, which is recorded."""
        assert self._asked is not None
        answer = question(self._asked)
        self._answers.append((question, answer))
        return answer

    def close(self) -> None:
        """End the recording: what was asked is not kept any longer."""
        self._asked = None

    def answers_alike(self, other: _Asked) -> bool:
        """Return whether another one answers alike."""
        return all(question(other) == answer for question, answer in self._answers)


class _Kept(Named):
    answers: Answers[Any]
    result: Any
    cost: _Cost


class Memory:
    """Results of earlier work, each with what was asked for it.

    A rubric owns a small one for launch files, which all packages share that are read for it:
    students hand in the launch file of a handout again, and the search for hints reads the same
    file for each edit. An editor owns a large one, for all files of a workspace.
    """

    def __init__(self, most: int = 4, check: Callable[[], object] = lambda: None) -> None:
        """`most` results are kept. `check` is called before each work, and raises what ends it."""
        self._most = most
        self._check = check
        self._kept: dict[Hashable, _Kept] = {}
        self._used: set[Hashable] = set()

    def recall(
        self,
        key: Hashable,
        asked: _Asked,
        work: _Work,
        make: Callable[[Answers[_Asked]], _T],
    ) -> _T:
        """Return a result that is kept under a key, if what is asked answers alike; else make it.

        Args:
            key: What else the result depends on.
            asked: What is asked during the work.
            work: The budget to which the work is charged, also where it is not done again.
            make: Does the work; it asks by way of the answers.
        """
        self._check()
        kept = self._kept.get(key)
        if kept and kept.answers.answers_alike(asked) and work.repeat(kept.cost):
            self._used.add(key)
            result: _T = kept.result
            return result
        answers = Answers(asked)
        before = work.mark()
        result = make(answers)
        answers.close()
        after = work.mark()
        cost = (before[0] - after[0], before[1] - after[1])
        work.set_apart(cost)
        # What other files of a submission leave too little work for is another result elsewhere.
        if not work.is_spent:
            self._keep(key, _Kept(answers, result, cost))
        return result

    def _keep(self, key: Hashable, kept: _Kept) -> None:
        """Keep a result, in place of the oldest one."""
        self._kept.pop(key, None)
        if len(self._kept) >= self._most:
            oldest = next(iter(self._kept))
            del self._kept[oldest]
            self._used.discard(oldest)
        self._kept[key] = kept
        self._used.add(key)

    def forget_unused(self) -> None:
        """Forget the results that nobody asked for since the last call."""
        self._kept = {key: kept for key, kept in self._kept.items() if key in self._used}
        self._used.clear()
