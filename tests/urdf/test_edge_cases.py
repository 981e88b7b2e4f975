"""The reader gives ROS 2's verdict on each edge case, and ROS 2 really gives that verdict."""

import re

import pytest

from grader.ros.urdf.reader import read_urdf
from tests.oracles.check_urdf import LYRICAL, check_urdf
from tests.urdf.edge_cases import EDGE_CASES, EdgeCase

_ENDINGS = {"agrees": "finished", "hangs": "hung", "aborts": "aborted"}
_ENDINGS_OF_LYRICAL = {**_ENDINGS, "aborts": "finished"}  # no value is a format for printf
# TinyXML2 10 decodes these references, as the reader does; 11, of Lyrical, leaves them as they are.
_OF_TINYXML2_10 = {case.name for case in EDGE_CASES if case.name.startswith("reference-beyond-")}
_OF_LYRICAL = [case for case in EDGE_CASES if case.name not in _OF_TINYXML2_10]


def test_reader_gives_recorded_verdict() -> None:
    """The reader's verdict is the recorded one."""
    verdicts = {case.name: (read_urdf(case.text, "case.urdf").verdict, case) for case in EDGE_CASES}
    assert {
        name: (verdict, case.rule)
        for name, (verdict, case) in verdicts.items()
        if verdict != case.verdict
    } == {}


def test_reader_gives_recorded_verdict_of_lyrical() -> None:
    """The reader's verdict on Lyrical, whose reader knows newer versions, is the recorded one."""
    wrong = {}
    for case in _OF_LYRICAL:
        verdict = read_urdf(case.text, "case.urdf", (LYRICAL,)).verdict
        if verdict != (case.lyrical or case.verdict):
            wrong[case.name] = (verdict, case.rule)
    assert wrong == {}


@pytest.mark.exhaustive
@pytest.mark.parametrize("case", _OF_LYRICAL, ids=lambda case: case.name)
def test_lyrical_gives_recorded_verdict(case: EdgeCase) -> None:
    """The verdict of Lyrical is the recorded one, and its program ends as recorded."""
    oracle = check_urdf(case.text, release=LYRICAL)
    recorded = case.lyrical or case.verdict
    assert (oracle.verdict, oracle.ending) == (recorded, _ENDINGS_OF_LYRICAL[case.oracle]), (
        f"{case.rule}\n{oracle.stderr}"
    )


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
