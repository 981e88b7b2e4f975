"""Drawings as SVG: what they show and say, for every sample, and for robots that cannot be drawn."""

import re
from dataclasses import replace
from itertools import combinations
from math import hypot
from typing import Any

import pytest

from grader.base.text import format_points
from grader.report.drawing.graded_picture import draw_report
from grader.report.drawing.three_views import drawing_element
from grader.report.formats import Format, render
from grader.report.inspection import InspectedRobot, Inspection, main_root
from grader.report.writers.inspection_svg import inspection_svg
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import read_urdf
from tests.command_line import run, run_with_input
from tests.report.readers import read_svg
from tests.samples import REPORTED, SAMPLES
from tests.urdf.edge_cases import EDGE_CASES
from tests.work import limited_work

REFERENCE = "submissions/lab6/reference"
BOX = '<box size="0.6 0.4 0.2"/>'


def shown(*arguments: object, code: int = 0) -> Any:
    """Return the root of the drawing that a command prints."""
    done = run([*arguments, "--format", "svg"])
    assert (done.returncode, done.stdout.count(b"\n")) == (code, 1), done.stderr
    return read_svg(done.stdout.decode())


def inspected(text: str, code: int = 0) -> Any:
    """Return the root of the drawing of a URDF."""
    done = run_with_input(("inspect", "-", "--format", "svg"), text.encode())
    assert done.returncode == code
    return read_svg(done.stdout.decode())


def words(root: Any) -> str:
    """Return the text of a drawing, without line breaks."""
    return " ".join(
        " ".join(element.text or "" for element in root.iter("{*}text", "{*}tspan")).split()
    )


def numbers_at(root: Any) -> list[tuple[float, float]]:
    """Return the centres of the numbers in the views; the key has its own coordinates."""
    views = [view for view in root.findall("{*}g") if view.get("transform") is None]
    return [
        (float(disc.get("cx")), float(disc.get("cy")))
        for view in views
        for disc in view.iter("{*}circle")
    ]


def bodies(root: Any) -> dict[str, list[Any]]:
    """Return the shapes of a drawing by their links, in the order of the views."""
    found: dict[str, list[Any]] = {}
    for shape in root.iter("{*}polygon"):
        for title in shape.iter("{*}title"):
            found.setdefault(title.text, []).append(shape)
    return found


def link(name: str, geometry: str, rgba: str = "1 1 1 1") -> str:
    return (
        f'<link name="{name}"><visual><geometry>{geometry}</geometry>'
        f'<material name="of {name}"><color rgba="{rgba}"/></material></visual></link>'
    )


@pytest.mark.parametrize("name", REPORTED)
def test_drawing_of_a_sample_is_well_formed_and_says_what_it_calls_out(name: str) -> None:
    """Every callout is in the legend with its criteria and points, and in the words for screen readers."""
    report = SAMPLES[name].grade()
    root = read_svg(render(report, Format.SVG))
    assert root.get("role") == "img"
    assert root.findtext("{*}title").endswith(
        f"{format_points(report.score)} / {format_points(report.max_score)} points"
    )
    picture, said = draw_report(report), words(root)
    for callout in picture.callouts if picture is not None else ():
        for criterion in callout.names:
            assert criterion in root.findtext("{*}desc")
            assert criterion in said
        assert ("not in the picture" in said) or callout.point is not None


@pytest.mark.parametrize(
    "name", ["reference", "several-mistakes", "wheels-lying-flat", "arm/elbow-to-the-side"]
)
def test_numbers_do_not_overlap(name: str) -> None:
    """The discs of all callouts are beside each other, inside the sheet, and there is one in each view."""
    picture = draw_report(SAMPLES[name].grade())
    assert picture is not None
    root = read_svg(drawing_element(picture, legend=False))
    _, _, width, height = map(float, root.get("viewBox").split())
    centres = numbers_at(root)
    assert all(9.0 <= x <= width - 9.0 and 9.0 <= y <= height - 9.0 for x, y in centres)
    assert all(hypot(a - c, b - d) >= 18.0 for (a, b), (c, d) in combinations(centres, 2))
    assert len(centres) == 3 * sum(callout.point is not None for callout in picture.callouts)


def test_twenty_numbers_at_one_place_do_not_overlap() -> None:
    """Each has a place of its own in each view."""
    picture = draw_report(SAMPLES["lidar-buried"].grade())
    assert picture is not None
    crowd = tuple(picture.callouts[0]._replace(number=number) for number in range(1, 21))
    centres = numbers_at(read_svg(drawing_element(replace(picture, callouts=crowd), legend=False)))
    assert len(set(centres)) == 3 * 20
    assert all(hypot(a - c, b - d) >= 18.0 for (a, b), (c, d) in combinations(centres, 2))


def test_views_show_the_robot_at_one_scale() -> None:
    """A box of 0.6 x 0.4 x 0.2 is as wide in the view from above as from its side."""
    root = inspected(f'<robot name="r">{link("a", BOX)}</robot>')
    sizes = []
    for path in bodies(root)["a"]:
        numbers = [*map(float, path.get("points").split())]
        xs, ys = numbers[::2], numbers[1::2]
        sizes.append((max(xs) - min(xs), max(ys) - min(ys)))
    scale = sizes[0][0] / 0.6
    for measured, real in zip(sizes, [(0.6, 0.4), (0.6, 0.2), (0.4, 0.2)], strict=True):
        assert measured == pytest.approx([scale * length for length in real], abs=0.2)


def test_long_names_are_cut() -> None:
    """A name of 200,000 letters makes the drawing neither large nor slow."""
    text = (
        f'<robot name="{"x" * 200_000}">' + link("y" * 200_000, '<sphere radius="1"/>') + "</robot>"
    )
    with limited_work(200_000):
        root = inspected(text)
    assert len(root.findtext("{*}title")) == 200
    assert list(bodies(root)) == ["y" * 60]


def test_every_text_that_the_reader_knows_is_drawn() -> None:
    """Some of the URDFs on which the reader is compared with ROS 2: no exception, and no coordinate that is not a number."""
    for case in EDGE_CASES[::8]:
        data = case.text if isinstance(case.text, bytes) else case.text.encode()
        reading = read_urdf(data, "a.urdf")
        robot = Configuration(reading.robot) if reading.robot is not None else None
        shown = InspectedRobot("a.urdf", reading, robot, main_root(robot) if robot else None)
        root = inspection_svg(Inspection("a.urdf", (shown,)))
        drawn = "".join(path.get("d") for path in read_svg(root).iter("{*}path"))
        assert not re.search(r"[a-z]{2}|e", drawn), case.name


@pytest.mark.slow
def test_two_hundred_links_are_drawn_in_a_second() -> None:
    """A chain of boxes, cylinders and spheres, each of which overlaps its neighbours."""
    shapes = (
        '<box size="0.1 0.08 0.12"/>',
        '<cylinder radius="0.04" length="0.12"/>',
        '<sphere radius="0.05"/>',
    )
    text = "".join(link(f"l{n}", shapes[n % 3]) for n in range(200)) + "".join(
        f'<joint name="j{n}" type="fixed"><parent link="l{n - 1}"/><child link="l{n}"/>'
        f'<origin xyz="0.02 0 0.1" rpy="0 {n % 2 / 10} 0.2"/></joint>'
        for n in range(1, 200)
    )
    with limited_work(9_000_000):
        root = inspected(f'<robot name="r">{text}</robot>')
    assert len(bodies(root)) == 200
