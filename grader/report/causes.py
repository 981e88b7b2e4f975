"""The causes of problems, each of which a terminal shows once, with all places."""

from collections.abc import Iterable, Iterator
from itertools import groupby

from grader.base.problems import Problem, Severity
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import printable

SEVERITIES: tuple[Severity, ...] = ("error", "warning", "note")


class Cause(Named):
    """Problems of one severity that one mistake makes: an equal message, or one cause.

    The first one stands for all.
    """

    problems: tuple[Problem, ...]

    @property
    def problem(self) -> Problem:
        """The first of its problems."""
        return self.problems[0]

    @property
    def others(self) -> list[Location]:
        """The places of the others, each once."""
        first = self.problem.location
        places = [problem.location for problem in self.problems]
        return [at for at in dict.fromkeys(places) if at[:2] != first[:2]]

    @property
    def is_repeated(self) -> bool:
        """Whether all of its problems have one message."""
        return len({problem.message for problem in self.problems}) == 1


class CauseKind(Named):
    """The causes of one code, which is of warnings or of notes."""

    causes: tuple[Cause, ...]

    @property
    def problem(self) -> Problem:
        """The first of its problems."""
        return self.causes[0].problem

    @property
    def total(self) -> int:
        """How many problems it has."""
        return sum(len(cause.problems) for cause in self.causes)


def in_order_of_severity(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Return problems, errors first and notes last, those of one severity by file and line."""
    return tuple(sorted(problems, key=_make_order))


def _make_order(problem: Problem) -> tuple[int, str, int, int]:
    at = problem.location
    return SEVERITIES.index(problem.severity), at.path, at.line, at.column


def group_problems(problems: Iterable[Problem], *, with_other_messages: bool = True) -> list[Cause]:
    """Return the causes of problems, in the order of the first problem of each.

    Without `with_other_messages`, problems of one cause have one message as well.
    """
    groups: dict[tuple[str, str, str], list[Problem]] = {}
    for problem in problems:
        cause = problem.cause if with_other_messages else ""
        groups.setdefault((problem.code, problem.rule, cause or problem.message), []).append(
            problem
        )
    return [Cause(tuple(group)) for group in groups.values()]


def group_causes(causes: Iterable[Cause]) -> list[CauseKind]:
    """Return the causes of each code, in the order of the first cause of each."""
    kinds: dict[str, list[Cause]] = {}
    for cause in causes:
        kinds.setdefault(cause.problem.code, []).append(cause)
    return [CauseKind(tuple(kind)) for kind in kinds.values()]


def places_text(places: Iterable[Location], without: str = "") -> Iterator[str]:
    """Yield the lines of each file, `path:3, 7`; of one file without its path."""
    for path, of_path in groupby(places, key=lambda at: at.path):
        lines = ", ".join(str(at.line) for at in of_path)
        yield f"line {lines}" if path == without else f"{printable(path)}:{lines}"
