"""The grader agrees with its oracles on random inputs; `python -m tests.differential` compares many more."""

import pytest

from tests.differential import urdfs
from tests.differential.__main__ import ORACLES, compared_part
from tests.differential.compared import Compared, summary
from tests.oracles import colcon_builds, urdfdom
from tests.oracles.check_urdf import LYRICAL
from tests.urdf.edge_cases import EDGE_CASES

pytestmark = pytest.mark.slow

needs_urdfdom = pytest.mark.skipif(
    not urdfdom.is_available(), reason="needs Linux on x86-64, and urdfdom: .[test]"
)

needs_colcon = pytest.mark.skipif(
    not colcon_builds.is_available(), reason="needs colcon: see CONTRIBUTING.md"
)
needs_urdfdom_6 = pytest.mark.skipif(
    not urdfdom.is_available(LYRICAL), reason="needs the oracle urdfdom 6: see CONTRIBUTING.md"
)
_NEEDS = {
    "check_urdf": needs_urdfdom,
    "check_urdf of Lyrical": needs_urdfdom_6,
    "colcon": needs_colcon,
}
_COUNTS = {
    "check_urdf": 2000,
    "check_urdf of Lyrical": 2000,
    "pinocchio": 1000,
    "colcon": 60,
    "xacro": 800,
}  # a build takes a second


def test_summary() -> None:
    """Differences are counted, and shown with their seeds in order."""
    assert summary(
        [Compared(2, "accepted"), Compared(1, "accepted", "b"), Compared(0, "refused", "a")]
    ) == [
        "3 inputs (2 accepted, 1 refused): 1 agree, 2 differ",
        "seed 0: a",
        "seed 1: b",
    ]


@needs_urdfdom
@pytest.mark.exhaustive
def test_the_library_gives_the_verdicts_of_the_program() -> None:
    """On every edge case: those that it rejects, that it accepts with errors, that crash it, and those with a loop.

    But for values that printf takes for a format that writes to memory: it crashes or not.
    """
    cases = [case for case in EDGE_CASES if b"%n" not in case.text]
    found = urdfdom.verdicts([case.text for case in cases])
    wrong = [
        case.name for case, verdict in zip(cases, found, strict=True) if case.verdict != verdict
    ]
    assert wrong == []


@needs_urdfdom
def test_mutated_urdfs() -> None:
    """The verdict on each mutant is that of ROS 2; the mutants are the same in every run, and some of them load."""
    results = list(urdfs.compare(range(400)))
    assert summary(results)[1:] == []
    assert {result.kind for result in results} == {"clean", "degraded", "rejected"}
    assert urdfs.mutant(7) == urdfs.mutant(7)


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    "oracle", [pytest.param(name, marks=_NEEDS.get(name, ())) for name in ORACLES]
)
def test_each_oracle(oracle: str) -> None:
    """Inputs of another range of seeds agree; `pinocchio` needs the group `oracle`."""
    assert summary(compared_part(oracle, range(5_000_000, 5_000_000 + _COUNTS[oracle])))[1:] == []
