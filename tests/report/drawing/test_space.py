"""The robot as data for the script of a page: it has nothing of the reference, and is JSON whatever the numbers are."""

import json
import re
from collections.abc import Iterator
from dataclasses import replace
from math import pi
from types import SimpleNamespace
from typing import Any

import pytest

from grader.report.drawing.picture import plain_picture
from grader.report.drawing.space import space_data, without_names
from grader.report.pages.student import render_html
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from tests.samples import ROOT, SAMPLES
from tests.urdf.builders import joint, links, robot

pytestmark = pytest.mark.slow

REFERENCE = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text()
NUMBER = re.compile(r'(?<=[" ])-?\d+(?:\.\d+)?(?=[" ])')


def data_of(text: str, positions: dict[str, float] | None = None) -> Any:
    """Return the data of a URDF, in the frame of its first link, as the page has them."""
    read = read_urdf(text.encode()).robot
    assert read is not None
    picture = plain_picture(Configuration(read, positions or {}), read.links[0].name)
    assert picture is not None
    return json.loads(json.dumps(space_data(picture, {}), allow_nan=False))


def changed_references() -> Iterator[str]:
    """Yield the reference with one number changed, a little or much: sizes, places, colours, masses, limits."""
    for number in NUMBER.finditer(REFERENCE):
        for change in (1e-5, 0.05):
            value = f"{float(number[0]) + change:.9g}"
            yield REFERENCE[: number.start()] + value + REFERENCE[number.end() :]


@pytest.mark.parametrize("name", ["several-mistakes", "centimetres", "lidar-missing"])
def test_page_has_no_more_of_the_reference_than_the_views(name: str) -> None:
    """Where a change of the reference changes no byte of the drawing, it changes no byte of the page."""
    report = SAMPLES[name].grade()
    drawings, pages = set(), set()
    for text in changed_references():
        model = read_urdf(text.encode()).robot
        assert model is not None
        solution: Any = SimpleNamespace(robot=Configuration(model))
        page = render_html(report._replace(rubric=replace(report.rubric, solution=solution)))
        drawing = re.search(r'<div class="views">.*?</svg>', page, re.DOTALL)
        assert drawing is not None
        drawings.add(drawing[0])
        pages.add(page.replace(drawing[0], ""))
    assert len(drawings) > 3
    assert len(pages) == 1


def test_joint_has_its_limits_and_position() -> None:
    """A slider offers the limits, half a turn without them, and where the joint is; none moves what is not shown."""
    body = '<axis xyz="0 0 2"/><limit lower="-0.5" upper="0.25" effort="1" velocity="1"/>'
    text = robot(
        links("a", "b", "c", "d", "e")
        + joint("a", "b", "turns", kind="revolute", body=body)
        + joint("b", "c", "spins", kind="continuous")
        + joint("d", "e", "apart", kind="revolute", body=body)
    )
    turns, spins, apart = data_of(text, {"turns": 1.0})["joints"]
    assert (turns["range"], turns["start"], turns["axis"]) == ([-0.5, 1.0], 1.0, [0, 0, 1])
    assert spins["range"] == pytest.approx([-pi, pi])
    assert "range" not in apart


def test_mimic_joint_has_a_slider_only_at_a_given_position() -> None:
    """It follows its leader, unless it has a position."""
    follows = '<mimic joint="leads" multiplier="-2" offset="0.1"/>'
    text = robot(
        links("a", "b", "c")
        + joint("a", "b", "leads", kind="continuous")
        + joint("b", "c", "follows", kind="continuous", body=follows)
    )
    follower = data_of(text)["joints"][1]
    assert follower["mimic"] == ["leads", -2, 0.1]
    assert "range" not in follower
    given = data_of(text, {"follows": 0.5})["joints"][1]
    assert given["start"] == 0.5
    assert "mimic" not in given


@pytest.mark.parametrize("value", ["inf", "nan", "1e308", "1e400", "-1e-320", "ten", ""])
@pytest.mark.parametrize("number", range(11))
def test_every_number_of_a_student_is_data(number: int, value: str) -> None:
    """Numbers that are too large, or none, leave data that JSON can have."""
    values = ["0.5"] * 11
    values[number] = value
    a, b, c, d, e, f, g, h, i, j, k = values
    shape = f'<visual><origin xyz="{a} 0 0" rpy="{b} 0 0"/><geometry><box size="1 {c} 1"/></geometry><material name="m"><color rgba="{d} 0 0 1"/></material></visual>'
    moves = f'<origin xyz="{e} 0 0" rpy="0 {f} 0"/><axis xyz="{g} 0 1"/><limit lower="{h}" upper="{i}" effort="1" velocity="1"/>'
    follows = f'<mimic joint="j" multiplier="{j}" offset="{k}"/>'
    text = robot(
        f'<link name="a">{shape}</link>'
        + links("b", "c")
        + joint("a", "b", kind="revolute", body=moves)
        + joint("b", "c", "k", kind="prismatic", body=follows)
    )
    assert data_of(text)["frame"] == "a"


def test_page_of_a_huge_robot_has_the_views_only() -> None:
    """A browser moves so many links only in seconds: there is no canvas, and no slider."""
    names = [f"l{k}" for k in range(600)]
    rows = (joint("l0", name, f"j{name}", kind="continuous") for name in names[1:])
    model = read_urdf(robot(links(*names) + "".join(rows)).encode()).robot
    assert model is not None
    picture = plain_picture(Configuration(model), "l0")
    assert picture is not None
    assert space_data(picture, {}) is None


def test_robot_without_names_is_the_same_robot() -> None:
    """Numbers stand for the names of links and joints, everywhere; a type that is no type is dropped."""
    follows = '<mimic joint="Ada leads" multiplier="2"/>'
    text = robot(
        links("Ada 1", "Ada 2", "Ada 3", "Ada 4")
        + joint("Ada 1", "Ada 2", "Ada leads", kind="continuous")
        + joint("Ada 2", "Ada 3", "Ada follows", kind="continuous", body=follows)
        + joint("Ada 3", "Ada 4", "Ada", kind="Ada")
    )
    known, data = data_of(text), without_names(data_of(text))
    assert "Ada" not in json.dumps(data)
    assert [link["name"] for link in data["links"]] == [f"link {k}" for k in (1, 2, 3, 4)]
    follower = data["joints"][1]
    assert (follower["parent"], follower["mimic"]) == ("link 2", ["joint 1", 2, 0])
    assert follower["origin"] == known["joints"][1]["origin"]
    assert data["frame"] == "link 1"
