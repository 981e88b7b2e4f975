"""The small picture of a robot: what is in front hides what is behind, and the picture is small."""

import json
import re

import pytest

from grader.report.drawing.picture import plain_picture
from grader.report.drawing.still import HEIGHT, MAX_SIZE, WIDTH, Still, draw_still
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from tests.samples import SAMPLES
from tests.urdf.builders import joint, robot

pytestmark = pytest.mark.slow


def still(text: str) -> Still:
    """Return the picture of a URDF."""
    read = read_urdf(text.encode()).robot
    assert read is not None
    picture = plain_picture(Configuration(read), read.links[0].name)
    assert picture is not None
    return draw_still(picture.scene)


def link(name: str, geometry: str, rgba: str, xyz: str = "0 0 0") -> str:
    """Return a link that shows a shape."""
    material = f'<material name="{name}"><color rgba="{rgba}"/></material>'
    shape = f'<origin xyz="{xyz}"/><geometry>{geometry}</geometry>{material}'
    return f'<link name="{name}"><visual>{shape}</visual></link>'


@pytest.mark.parametrize("name", ["reference", "several-mistakes", "centimetres", "arm/axis-sign"])
def test_picture_of_a_robot_is_small(name: str) -> None:
    """It fills its sheet, and is at most 2 KB."""
    model = SAMPLES[name].open().robot
    assert model is not None
    picture = plain_picture(Configuration(model), model.links[0].name)
    assert picture is not None
    faces = draw_still(picture.scene)
    assert len(json.dumps(faces, separators=(",", ":"))) <= 2_000
    numbers = [list(map(int, re.findall(r"-?\d+", data))) for _, data in faces]
    across = [x for data in numbers for x in data[::2]]
    down = [y for data in numbers for y in data[1::2]]
    assert min(across) >= 0 <= min(down)
    assert max(across) <= WIDTH
    assert max(down) <= HEIGHT
    assert max(across) - min(across) > 0.85 * WIDTH or max(down) - min(down) > 0.85 * HEIGHT


@pytest.mark.parametrize(
    ("place", "is_before"),
    [("0 0 0.3", True), ("0 0 -0.3", False), ("0.4 0 0", True), ("0 0.4 0", False)],
)
def test_what_is_behind_is_drawn_first(place: str, is_before: bool) -> None:
    """The viewer is before, above and to the right of the robot."""
    base = link("base", '<box size="0.4 0.4 0.2"/>', "0 0 0 1")
    other = link("other", '<sphere radius="0.15"/>', "1 1 1 1", place)
    fills = [fill for fill, _ in still(robot(base + other + joint("base", "other")))]
    assert len(fills) == 4
    assert fills.index("#000000") == (0 if is_before else 1)


def test_shapes_that_do_not_fit_are_left_out_from_the_smallest_on() -> None:
    """The larger ones remain."""
    parts = [link("base", '<box size="9 9 9"/>', "0 0.6 0 0.5")]
    for number in range(200):
        name = f"l{number}"
        parts.append(
            link(name, '<cylinder radius="0.1" length="0.1"/>', "1 0 0 1", f"{number} 0 5")
        )
        parts.append(joint("base", name, f"j{number}"))
    faces = still(robot("".join(parts)))
    assert sum(len(fill) + len(data) + 8 for fill, data in faces) <= MAX_SIZE
    assert sum(fill.endswith("80") for fill, _ in faces) == 3


def test_robot_without_shapes_has_no_picture() -> None:
    """There is nothing to see."""
    assert still(robot('<link name="a"/>')) == ()
