"""What a picture of a graded robot shows: wheels and their way, where the reference differs, which criteria failed where."""

from dataclasses import replace
from pathlib import Path

import pytest

from grader.drawing.picture import Picture, picture_of
from grader.drawing.scene import scene_of
from grader.grading.grade import grade
from grader.grading.graded_submission import GradedSubmission
from grader.grading.report import Report
from grader.grading.rubric import load_rubric
from grader.robot.kinematics import Configuration
from grader.robot.reader import read_urdf
from grader.source import Source
from grader.submission.opening import open_submission
from grader.submission.urdf import Urdf
from tests.command_line import run

ROOT = Path(__file__).parents[2]


def picture(name: str, rubric: str = "lab6") -> Picture:
    """Return the picture of a sample submission."""
    loaded = load_rubric(rubric)
    found = picture_of(grade(loaded, open_submission(str(ROOT / "submissions" / rubric / name), loaded.lab)))
    assert found is not None
    return found


def test_reference_has_nothing_to_mark() -> None:
    """The reference is drawn in the frame in which the rubric measures, and nothing of it differs."""
    found = picture("reference")
    assert found.scene.frame == "base_link"
    assert (found.outlines, found.frames, found.callouts) == ((), (), ())
    assert [body.link for body in found.scene.bodies] == [
        "base_link",
        "lidar",
        "left_wheel",
        "right_wheel",
        "caster_wheel",
    ]
    assert found.scene.missing == ()


@pytest.mark.parametrize(
    ("name", "travel"),
    [("reference", (1.0, 0.0, 0.0)), ("axis-negated", (-1.0, 0.0, 0.0)), ("right-wheel-mirrored", None)],
)
def test_wheels_show_the_way_of_a_positive_turn(name: str, travel: tuple[float, float, float] | None) -> None:
    """A wheel has the direction in which a small positive turn of its joint drives the base."""
    wheels = {wheel.link: wheel.travel for wheel in picture(name).scene.wheels}
    assert set(wheels) == {"left_wheel", "right_wheel"}
    if travel is not None:
        assert wheels["left_wheel"] == pytest.approx(travel, abs=1e-6)
    else:
        left, right = wheels["left_wheel"], wheels["right_wheel"]
        assert left is not None
        assert right == pytest.approx([-value for value in left], abs=1e-6)


def test_buried_lidar_is_outlined_and_called_out() -> None:
    """A link that lost points has the reference's outline where it differs, and one callout with all its criteria."""
    found = picture("lidar-buried")
    assert [body.link for body in found.outlines] == ["lidar"]
    (callout,) = found.callouts
    assert callout.link == "lidar"
    assert callout.point is not None
    assert callout.number == 1
    assert {result.criterion.id for result in callout.results} >= {"lidar-frame", "lidar-on-top"}


def test_missing_link_is_marked_where_the_reference_has_it() -> None:
    """A link that is missing has the reference's place and outline."""
    found = picture("caster-misnamed")
    callout = next(callout for callout in found.callouts if callout.link == "caster_wheel")
    assert callout.point == pytest.approx((0.2, 0.0, -0.05), abs=1e-6)
    assert "caster_wheel" in {body.link for body in found.outlines}


def test_rubric_that_hides_hints_hides_the_reference() -> None:
    """Below the level `cause` a picture shows nothing of the reference."""
    rubric = replace(load_rubric("lab6"), hints="place")
    found = picture_of(
        grade(rubric, open_submission(str(ROOT / "submissions/lab6/lidar-buried/my_robot/urdf"), rubric.lab))
    )
    assert found is not None
    assert found.reference is None
    assert found.outlines == ()
    assert found.callouts


def test_what_cannot_be_drawn_is_named() -> None:
    """Meshes, detached links and shapes without a size are listed, not dropped silently."""
    text = """<robot name="r"><link name="a"><visual><geometry><mesh filename="a.stl"/></geometry></visual></link>
    <link name="b"><visual><geometry><sphere radius="0"/></geometry></visual></link>
    <link name="c"><visual><geometry><sphere radius="1"/></geometry></visual></link>
    <joint name="ab" type="fixed"><parent link="a"/><child link="b"/></joint></robot>"""
    reading = read_urdf(text.encode(), "r.urdf")
    assert reading.robot is not None
    scene = scene_of(Configuration(reading.robot), "a")
    assert scene.bodies == ()
    assert scene.missing == (
        "Not shown: 'c': no chain of joints leads from 'a' to 'c'",
        "Not shown: 'a': mesh files are not opened",
        "Not shown: 'b': the size or place of a shape is zero, too large or not known",
    )


@pytest.mark.parametrize(("kind", "picture"), [("svg", "<svg "), ("html", "Three views")])
def test_a_number_that_overflows_costs_neither_picture_nor_hints(kind: str, picture: str, tmp_path: Path) -> None:
    """A mesh at the end of the range of numbers in a link that is turned: the number of the callout is at the link's frame."""
    far = '<visual><origin xyz="1e308 1.7e308 1.7e308"/><geometry><mesh filename="a.stl"/></geometry></visual>'
    link = '<link name="left_wheel">'
    text = (ROOT / "submissions/lab6/axis-negated/my_robot/urdf/my_robot.urdf").read_text().replace(link, link + far)
    turned = '<origin xyz="-0.15 0.2 0" rpy="-0.78 0 0.78"/>'
    (tmp_path / "my_robot.urdf").write_text(text.replace('<origin xyz="-0.15 0.2 0" rpy="-1.57 0 0"/>', turned))
    assert (tmp_path / "my_robot.urdf").read_text().count(turned) == text.count(far) == 1
    done = run(["grade", tmp_path, "--rubric", "lab6", "--format", kind])
    assert (done.returncode, done.stderr) == (1, b"")
    assert picture in done.stdout.decode()
    loaded = load_rubric("lab6")
    found = picture_of(grade(loaded, open_submission(str(tmp_path), loaded.lab)))
    assert found is not None
    point = next(callout.point for callout in found.callouts if callout.link == "left_wheel")
    assert point == pytest.approx((-0.15, 0.2, 0.0))


def test_only_round_links_on_the_ground_are_wheels() -> None:
    """A part of an arm that turns without limit is no wheel; in a rubric without wheels, those of a rover still are."""
    assert picture("joint-continuous", "arm").scene.wheels == ()
    rover = read_urdf((ROOT / "submissions/lab6/axis-negated/my_robot/urdf/my_robot.urdf").read_bytes(), "r.urdf").robot
    assert rover is not None
    assert {wheel.link for wheel in scene_of(Configuration(rover), "base_link").wheels} == {"left_wheel", "right_wheel"}


class Unsafe:
    """Files that must not be opened again."""

    @property
    def urdf(self) -> Urdf:
        """Fail, as the process that graded them did."""
        raise MemoryError

    def source(self, path: str) -> Source | None:
        """Fail as well."""
        raise MemoryError(path)


def test_a_submission_that_could_not_be_graded_is_not_opened_again() -> None:
    """It may be one that crashed the process that graded it."""
    submission = GradedSubmission("ash", originals=Unsafe())
    assert picture_of(Report(submission, load_rubric("lab6"), (), ())) is None


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("equivalent-wheel-joints-at-centres", '"0.7 0.7 0.7 1', '"0.1 0.1 0.1 1'),
        ("equivalent-wheel-joints-at-centres", '<axis xyz="0 0 1"', '<axis xyz="0 0 -1"'),
    ],
)
def test_no_outline_of_what_is_right(name: str, old: str, new: str, tmp_path: Path) -> None:
    """A wrong colour or axis draws no dashed shape or frame at a link that is correct in another way than the reference."""
    found = changed_picture(tmp_path, name, old, new)
    assert found.callouts
    assert (found.outlines, found.frames) == ((), ())


def changed_picture(folder: Path, name: str, old: str, new: str) -> Picture:
    """Return the picture of a sample with another text in its URDF."""
    text = (ROOT / "submissions/lab6" / name / "my_robot/urdf/my_robot.urdf").read_text()
    assert old in text
    (folder / "my_robot.urdf").write_text(text.replace(old, new))
    loaded = load_rubric("lab6")
    found = picture_of(grade(loaded, open_submission(str(folder), loaded.lab)))
    assert found is not None
    return found


def test_criterion_on_several_links_marks_none_of_them(tmp_path: Path) -> None:
    """If wheels and caster miss the ground together, that is a mistake of the robot, not of its first wheel."""
    found = changed_picture(
        tmp_path, "caster-below-the-ground", '<origin xyz="0 0 0.1"/>\n', '<origin xyz="0 0 0.05"/>\n'
    )
    callouts = {callout.link: callout for callout in found.callouts}
    assert set(callouts) == {"base_footprint", "caster_wheel", ""}
    assert [result.criterion.id for result in callouts[""].results] == ["stands-on-ground"]


def test_wheel_below_a_joint_that_slides_has_an_arrow() -> None:
    """The joint that turns the wheel counts, as in the check of its direction, also if another one moves it as well."""
    text = """<robot name="r"><link name="base"/><link name="hub"/><link name="wheel"><visual><geometry>
    <cylinder radius="0.1" length="0.05"/></geometry></visual></link>
    <joint name="turn" type="continuous"><parent link="base"/><child link="hub"/><origin rpy="-1.5708 0 0"/><axis xyz="0 0 1"/></joint>
    <joint name="slide" type="prismatic"><parent link="hub"/><child link="wheel"/><limit effort="1" velocity="1"/></joint></robot>"""
    robot = read_urdf(text.encode(), "r.urdf").robot
    assert robot is not None
    (wheel,) = scene_of(Configuration(robot), "base", ["wheel"]).wheels
    assert wheel.joint == "turn"
    assert wheel.travel == pytest.approx((1.0, 0.0, 0.0), abs=1e-4)
