"""The sample of every check: the first two rows of its table, and how far a robot may be off in each tolerance."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from itertools import islice
from typing import Any, Generic, TypeVar

from grader.lab.checks.check import Check
from grader.lab.checks.outcome import Outcome, Status
from tests.checks.robots import Scene
from tests.checks.rows import edited, rows_of, submitted, tables
from tests.checks.submissions import Submitted

Subject = TypeVar("Subject", Scene, Submitted)


@dataclass(frozen=True)
class Case(Generic[Subject]):
    """The arguments of a check, what passes and what fails; a check that always needs manual grading has no other.

    `edges` has, for each tolerance of a check of a robot, a function that returns a scene which is off by a given amount
    in the tolerance's unit, positive or negative unless the name is in `one_sided`. `mesh_status` is the status if every
    shape is a mesh. `needs_size` is False for a check that ignores the sizes of visuals.
    """

    check: Callable[..., Outcome]
    arguments: Mapping[str, Any]
    passing: Subject
    failing: Subject
    edges: Mapping[str, Callable[[float], Scene]]
    one_sided: tuple[str, ...]
    mesh_status: Status
    needs_size: bool

    @property
    def name(self) -> str:
        """Return the name of the check."""
        return self.check.__name__


def _case(check: Check, table: Mapping[str, Any], kind: type[Subject]) -> Case[Subject]:
    first, second = islice(rows_of(check, table), 2)
    passing, failing = first.subject, second.subject
    assert isinstance(passing, kind)
    assert isinstance(failing, kind)
    edges = {
        name: partial(_off_by, passing, edits) for name, edits in table.get("edges", {}).items()
    }
    one_sided, meshes = tuple(table.get("one_sided", ())), table.get("meshes", "passed")
    return Case(
        check.function,
        first.arguments,
        passing,
        failing,
        edges,
        one_sided,
        meshes,
        table.get("needs_size", True),
    )


def _off_by(robot: Any, edits: list[list[Any]], amount: float) -> Scene:
    """Return a robot with edits: a text, what replaces it, and for each {} in it a number, and how it grows with the amount."""
    numbers = [[float(number) for number in edit[2:]] for edit in edits]
    amounts = [
        [start + amount * by for start, by in zip(row[::2], row[1::2], strict=True)]
        for row in numbers
    ]
    pairs = [
        (old, new.format(*map(repr, row)))
        for (old, new, *_), row in zip(edits, amounts, strict=True)
    ]
    return Scene(edited(robot.text, pairs))


_ALL = list(tables())
CASES = tuple(_case(check, table, Scene) for check, table in _ALL if "scene" in table["row"][0])
_OTHERS = tuple(
    _case(check, table, Submitted) for check, table in _ALL if "package" in table["row"][0]
)
PENDING_CASES = tuple(
    case for case in _OTHERS if case.name in ("answered", "evidence_shown", "manual")
)
PACKAGE_CASES = tuple(case for case in _OTHERS if case not in PENDING_CASES)
CASE = {case.name: case for case in CASES}
PACKAGE_CASE = {case.name: case for case in PACKAGE_CASES}
PENDING_CASE = {case.name: case for case in PENDING_CASES}
IN_XACRO = submitted({"package": "xacro"})
