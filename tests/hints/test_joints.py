"""Hints for the joint that moves a link: limits, mimic, dynamics, axis; through the command line."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run

pytestmark = pytest.mark.slow

ARM = Path(__file__).parent / "arm"
REFERENCE = (ARM / "arm.urdf").read_text(encoding="utf-8")
SHOULDER = 'lower="-1.5708" upper="0.7854" effort="10" velocity="2"'
ELBOW = 'lower="-2" upper="2"'
MIMIC = '<mimic joint="left_finger" multiplier="-1"/>'
DYNAMICS = '<dynamics damping="0.7" friction="0.1"/>'

# What stands in the reference, the mistake, what is wrong, and the new texts of the edits.
MISTAKES = {
    "swapped": (
        SHOULDER,
        'lower="0.7854" upper="-1.5708" effort="10" velocity="2"',
        "the lower and the upper of the joint limit of 'upper' are exchanged",
        ['lower="-1.5708"', 'upper="0.7854"'],
    ),
    "degrees": (
        SHOULDER,
        'lower="-90" upper="45" effort="10" velocity="2"',
        "the unit of the lower and the upper of the joint limit of 'upper' is degrees; it should be radians",
        ['lower="-1.5708"', 'upper="0.7854"'],
    ),
    "sign": (
        SHOULDER,
        SHOULDER.replace("-1.5708", "1.5708"),
        "the sign of the lower of the joint limit of 'upper'",
        ['lower="-1.5708"'],
    ),
    "one-number": (
        SHOULDER,
        SHOULDER.replace("0.7854", "1"),
        "the upper of the joint limit of 'upper'",
        ['upper="0.7854"'],
    ),
    "no-lower": (
        SHOULDER,
        SHOULDER.replace('lower="-1.5708" ', ""),
        "the lower of the joint limit of 'upper' is missing",
        ['<limit lower="-1.5708"'],
    ),
    "effort": (
        SHOULDER,
        SHOULDER.replace("10", "100"),
        "the effort of the joint limit of 'upper'",
        ['effort="10"'],
    ),
    "unchecked-numbers-stay": (
        ELBOW + ' effort="5"',
        'lower="-2" upper="1" effort="7"',
        "the upper of the joint limit of 'lower'",
        ['upper="2"'],
    ),
    "above-a-fixed-joint": (
        ELBOW,
        'lower="2" upper="2"',
        "the sign of the lower of the joint limit of 'lower'",
        ['lower="-2"'],
    ),
    "axis": (
        '<axis xyz="0 1 0"/>\n    <limit lower="-2"',
        '<axis xyz="0 -1 0"/>\n    <limit lower="-2"',
        "the sign of y of the joint axis of 'lower'",
        ['xyz="0 1 0"'],
    ),
    "through": (
        'xyz="0.3 0 0"',
        'xyz="0.2 0 0"',
        "x of the joint origin of 'lower'",
        ['xyz="0.3 0 0"'],
    ),
    "friction": (
        DYNAMICS,
        DYNAMICS.replace("0.1", "1"),
        "the friction of the joint dynamics of 'upper'",
        ['friction="0.1"'],
    ),
    "swapped-dynamics": (
        DYNAMICS,
        '<dynamics damping="0.1" friction="0.7"/>',
        "the damping and the friction of the joint dynamics of 'upper' are exchanged",
        ['damping="0.7"', 'friction="0.1"'],
    ),
    "no-dynamics": (
        DYNAMICS,
        "",
        "the <dynamics> of the joint of 'upper' is missing",
        ["\n    " + DYNAMICS],
    ),
    "multiplier": (
        MIMIC,
        MIMIC.replace("-1", "1"),
        "the sign of the multiplier of the joint mimic of 'right'",
        ['multiplier="-1"'],
    ),
    "no-multiplier": (
        MIMIC,
        '<mimic joint="left_finger"/>',
        "the multiplier of the joint mimic of 'right' is missing",
        ['<mimic multiplier="-1"'],
    ),
    "offset": (
        MIMIC,
        '<mimic joint="left_finger" multiplier="-1" offset="0.1"/>',
        "the offset of the joint mimic of 'right'",
        ['offset="0"'],
    ),
    "leader": (
        MIMIC,
        MIMIC.replace("left_finger", "elbow"),
        "the joint of the joint mimic of 'right'",
        ['joint="left_finger"'],
    ),
    "leader-and-multiplier": (
        MIMIC,
        '<mimic joint="elbow"/>',
        "the joint and multiplier of the joint mimic of 'right'",
        ['<mimic multiplier="-1"', 'joint="left_finger"'],
    ),
    "no-mimic": (MIMIC, "", "the <mimic> of the joint of 'right' is missing", ["\n    " + MIMIC]),
}


def graded(path: Path, *options: str) -> dict[str, Any]:
    """Return the report on an arm as JSON."""
    done = run(("grade", path, "--rubric", ARM / "arm.toml", "--format", "json", *options))
    data: dict[str, Any] = json.loads(done.stdout)
    return data


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_is_undone(name: str, tmp_path: Path) -> None:
    """The smallest edit is found, and the file with it gets full marks; the cause is named without the edit."""
    correct, wrong, cause, edits = MISTAKES[name]
    assert REFERENCE.count(correct) == 1
    path, fixed = tmp_path / "arm.urdf", tmp_path / "fixed.urdf"
    path.write_text(REFERENCE.replace(correct, wrong))
    report = graded(path, "--fix", str(fixed))
    [hint] = [hint for result in report["results"] for hint in result["hints"]]
    assert report["score"] == 8
    assert ([edit["new"] for edit in hint["edits"]], sum(hint["gains"].values())) == (edits, 2)
    assert graded(fixed)["score"] == 10
    [told] = [
        hint for result in graded(path, "--hints", "cause")["results"] for hint in result["hints"]
    ]
    assert told["message"].endswith(f": {cause}.")


def test_joints_with_other_names(tmp_path: Path) -> None:
    """The joint to be mimicked is named as the file names it."""
    path = tmp_path / "arm.urdf"
    text = REFERENCE.replace(MIMIC, "").replace("left_finger", "l&amp;1")
    path.write_text(text)
    [hint] = [hint for result in graded(path)["results"] for hint in result["hints"]]
    assert [edit["new"].strip() for edit in hint["edits"]] == [
        '<mimic joint="l&amp;1" multiplier="-1"/>'
    ]
