"""The reader gives ROS 2's verdict on each edge case, and ROS 2 really gives that verdict."""

import re

import pytest

from grader.ros.urdf.reader import read_urdf
from tests.oracles.check_urdf import check_urdf
from tests.robot.edge_cases import EDGE_CASES, EdgeCase

_ENDINGS = {"agrees": "finished", "hangs": "hung", "aborts": "aborted"}


def test_reader_gives_recorded_verdict() -> None:
    """The reader's verdict is the recorded one."""
    verdicts = {case.name: (read_urdf(case.text, "case.urdf").verdict, case) for case in EDGE_CASES}
    assert {
        name: (verdict, case.rule)
        for name, (verdict, case) in verdicts.items()
        if verdict != case.verdict
    } == {}


@pytest.mark.exhaustive
@pytest.mark.parametrize("case", EDGE_CASES, ids=lambda case: case.name)
def test_ros_gives_recorded_verdict(case: EdgeCase) -> None:
    """ROS 2's verdict is the recorded one, and its program ends as recorded."""
    oracle = check_urdf(case.text)
    assert (oracle.verdict, oracle.ending) == (case.verdict, _ENDINGS[case.oracle]), (
        f"{case.rule}\n{oracle.stderr}"
    )


def test_corpus_is_large() -> None:
    """There are enough cases to cover the rules, and each verdict is well represented."""
    verdicts = [case.verdict for case in EDGE_CASES]
    assert len(verdicts) >= 150
    assert min(verdicts.count(verdict) for verdict in ("clean", "degraded", "rejected")) >= 40


def test_names_are_unique() -> None:
    """No two cases share a name, and each name is kebab-case."""
    names = [case.name for case in EDGE_CASES]
    assert len(set(names)) == len(names)
    assert [name for name in names if not re.fullmatch("[a-z0-9]+(-[a-z0-9]+)*", name)] == []


def test_texts_are_unique() -> None:
    """No two cases contain the same file."""
    assert len({case.text for case in EDGE_CASES}) == len(EDGE_CASES)
