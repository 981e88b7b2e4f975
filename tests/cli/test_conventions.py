"""A robot that is turned or moved as a whole: the report says once that this is one decision, and the points stay."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.cli.test_broken_tags import replaced
from tests.command_line import run

CENTRE = (
    ('<origin xyz="0 0 0.1" rpy="0 0 0"/>\n      <geo', "<geo"), ("0.15 0 0.225", "0.15 0 0.125"), ("-0.15 0.2 0", "-0.15 0.2 -0.1"),
    ("-0.15 -0.2 0", "-0.15 -0.2 -0.1"), ("0.2 0 -0.05", "0.2 0 -0.15"), ('xyz="0 0 0.1"', 'xyz="0 0 0.2"'),
)  # fmt: skip
Y_FORWARD = (
    ("0.6 0.4 0.2", "0.4 0.6 0.2"), ("0.15 0 0.225", "0 0.15 0.225"), ("0.2 0 -0.05", "0 0.2 -0.05"),
    ('-0.15 0.2 0" rpy="-1.57 0 0', '-0.2 -0.15 0" rpy="0 -1.57 0'), ('-0.15 -0.2 0" rpy="-1.57 0 0', '0.2 -0.15 0" rpy="0 -1.57 0'),
)  # fmt: skip
EXTRA = (
    "</robot>",
    '<link name="flag"/><joint name="f" type="fixed"><parent link="lidar"/><child link="flag"/></joint></robot>',
)
GREEN = ('rgba="0 0.6 0 1"', 'rgba="0 1 0 1"')


def graded(text: str, folder: Path) -> tuple[int, list[str]]:
    """Return the score, and the notes on a convention."""
    path = folder / "my_robot.urdf"
    path.write_text(text, encoding="utf-8")
    report: dict[str, Any] = json.loads(run(("grade", path, "--format", "json", "--hints", "none")).stdout)
    return report["score"], [note for note in report["notes"] if note.startswith("everything")]


@pytest.mark.parametrize(
    ("pairs", "score", "text"),
    [
        (CENTRE, 52, "everything is moved by 0 0 -0.1 m relative to the handout: one decision, 18 points"),
        (Y_FORWARD, 42, "everything is turned by 90 degrees about z relative to the handout: one decision, 28 points"),
        ((*CENTRE, EXTRA), 52, "everything is moved by 0 0 -0.1 m relative to the handout: one decision, 18 points"),
        ((*CENTRE, GREEN), 46, "everything is moved by 0 0 -0.1 m relative to the handout: one decision, 18 points"),
    ],
    ids=["centre", "y forward", "another link beside it", "another mistake beside it"],
)
def test_one_decision_is_named_once(pairs: tuple[tuple[str, str], ...], score: int, text: str, tmp_path: Path) -> None:
    """The note says how everything differs, and how many points this decision costs; the points are lost all the same."""
    assert graded(replaced(*pairs), tmp_path) == (score, [text])
    shown = run(("grade", tmp_path / "my_robot.urdf", "--hints", "none")).stdout.decode()
    assert " ".join(shown.split()).count(text) == 1


@pytest.mark.parametrize(
    "pairs",
    [
        CENTRE[:1], CENTRE[1:2], CENTRE[2:4], (*CENTRE[:2], CENTRE[5]), Y_FORWARD[:2], Y_FORWARD[3:], (GREEN, *CENTRE[1:3]),
    ],
)  # fmt: skip
def test_single_mistakes_are_no_convention(pairs: tuple[tuple[str, str], ...], tmp_path: Path) -> None:
    """Where only some links are elsewhere, each is its own mistake."""
    score, notes = graded(replaced(*pairs), tmp_path)
    assert score < 70
    assert notes == []
