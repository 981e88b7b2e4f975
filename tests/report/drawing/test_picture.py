"""What a picture of a graded robot shows: wheels and their way, where the reference differs, which criteria failed where."""

from math import dist
from pathlib import Path

import pytest

from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission
from grader.report.drawing.graded_picture import draw_report
from grader.report.drawing.picture import Picture, make_scene
from grader.ros.package import mesh_loading
from grader.ros.package.robot_file import Read
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Box
from grader.ros.urdf.reader import read_urdf
from grader.workspace.opening.opening import open_workspace
from tests.command_line import run
from tests.mesh.mesh_files import CUBE, binary_stl, collada

ROOT = Path(__file__).parents[3]


def picture(name: str, rubric: str = "lab6") -> Picture:
    """Return the picture of a sample submission."""
    loaded = load_rubric(rubric)
    found = draw_report(
        grade(loaded, open_submission(str(ROOT / "submissions" / rubric / name), loaded.lab))
    )
    assert found is not None
    return found


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "picture"), [("svg", "<svg "), ("html", "Three views")])
def test_a_number_that_overflows_costs_neither_picture_nor_hints(
    kind: str, picture: str, tmp_path: Path
) -> None:
    """A mesh at the end of the range of numbers in a link that is turned: the number of the callout is at the cylinder that is drawn."""
    far = '<visual><origin xyz="1e308 1.7e308 1.7e308"/><geometry><mesh filename="a.stl"/></geometry></visual>'
    link = '<link name="left_wheel">'
    text = (
        (ROOT / "submissions/lab6/axis-negated/my_robot/urdf/my_robot.urdf")
        .read_text()
        .replace(link, link + far)
    )
    turned = '<origin xyz="-0.15 0.2 0" rpy="-0.78 0 0.78"/>'
    (tmp_path / "my_robot.urdf").write_text(
        text.replace('<origin xyz="-0.15 0.2 0" rpy="-1.57 0 0"/>', turned)
    )
    assert (tmp_path / "my_robot.urdf").read_text().count(turned) == text.count(far) == 1
    done = run(["grade", tmp_path, "--rubric", "lab6", "--format", kind])
    assert (done.returncode, done.stderr) == (1, b"")
    assert picture in done.stdout.decode()
    loaded = load_rubric("lab6")
    found = draw_report(grade(loaded, open_submission(str(tmp_path), loaded.lab)))
    assert found is not None
    point = next(callout.point for callout in found.callouts if callout.link == "left_wheel")
    assert point is not None
    assert dist(point, (-0.15, 0.2, 0.0)) == pytest.approx(0.025)


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
    found = draw_report(grade(loaded, open_submission(str(folder), loaded.lab)))
    assert found is not None
    return found


def test_criterion_on_several_links_marks_none_of_them(tmp_path: Path) -> None:
    """If wheels and caster miss the ground together, that is a mistake of the robot, not of its first wheel."""
    found = changed_picture(
        tmp_path,
        "caster-below-the-ground",
        '<origin xyz="0 0 0.1"/>\n',
        '<origin xyz="0 0 0.05"/>\n',
    )
    callouts = {callout.link: callout for callout in found.callouts}
    assert set(callouts) == {"base_footprint", "caster_wheel", ""}
    assert callouts[""].names == ("stands-on-ground",)


def test_wheel_below_a_joint_that_slides_has_an_arrow() -> None:
    """The joint that turns the wheel counts, as in the check of its direction, also if another one moves it as well."""
    text = """<robot name="r"><link name="base"/><link name="hub"/><link name="wheel"><visual><geometry>
    <cylinder radius="0.1" length="0.05"/></geometry></visual></link>
    <joint name="turn" type="continuous"><parent link="base"/><child link="hub"/><origin rpy="-1.5708 0 0"/><axis xyz="0 0 1"/></joint>
    <joint name="slide" type="prismatic"><parent link="hub"/><child link="wheel"/><limit effort="1" velocity="1"/></joint></robot>"""
    robot = read_urdf(text.encode(), "r.urdf").robot
    assert robot is not None
    (wheel,) = make_scene(Configuration(robot), "base", ["wheel"]).wheels
    assert wheel.travel == pytest.approx((1.0, 0.0, 0.0), abs=1e-4)


@pytest.mark.parametrize("ending", ["stl", "dae"])
def test_a_mesh_is_the_box_around_it(ending: str, tmp_path: Path) -> None:
    """Scaled, mirrored where the scale is negative, in the frame of the visual; in red without a
    material, as RViz shows it, or in grey if the file has colours of its own.
    """
    (tmp_path / "rover").mkdir()
    data = binary_stl(CUBE) if ending == "stl" else collada(CUBE)
    (tmp_path / "rover" / f"cube.{ending}").write_bytes(data)
    mesh = f'<mesh filename="package://rover/cube.{ending}" scale="0.1 -0.2 0"/>'
    (tmp_path / "rover" / "rover.urdf").write_text(
        f'<robot name="r"><link name="a"><visual><origin xyz="1 0 0" rpy="0 0 1.5707963267948966"/>'
        f"<geometry>{mesh}</geometry></visual></link></robot>"
    )
    opened = open_workspace(str(tmp_path / "rover" / "rover.urdf"), 10_000, {})
    assert isinstance(opened.urdf, Read)
    robot = opened.urdf.loaded.robot
    assert robot is not None
    scene = make_scene(Configuration(robot), "a", meshes=opened.load_meshes(opened.urdf))
    (body,) = scene.bodies
    assert isinstance(body.shape, Box)
    assert body.shape.size == pytest.approx((0.1, 0.4, 0.0))
    assert body.T_frame_shape.translation == pytest.approx((1.2, 0.05, 0.0))
    assert body.rgba == ((1.0, 0.0, 0.0, 1.0) if ending == "stl" else (0.7, 0.7, 0.7, 1.0))
    assert body.mesh == robot.links[0].visuals[0].geometry
    assert scene.remarks == ("Shown as the boxes around them: the meshes of 'a'",)
    assert make_scene(Configuration(robot), "a").bodies == ()


def test_meshes_of_a_robot_have_limits_together(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The first ones are shown, and each of the others says why it is not; a file counts once."""
    (tmp_path / "rover").mkdir()
    links = []
    for number in range(6):
        (tmp_path / "rover" / f"{number}.stl").write_bytes(binary_stl(CUBE))
        mesh = (
            f'<visual><geometry><mesh filename="package://rover/{number}.stl"/></geometry></visual>'
        )
        links.append(f'<link name="{number}">{mesh}{mesh}</link>')
    for number in range(1, 6):
        joint = f'<joint name="{number}" type="fixed"><parent link="0"/><child link="{number}"/></joint>'
        links.append(joint)
    (tmp_path / "rover" / "r.urdf").write_text(f'<robot name="r">{"".join(links)}</robot>')
    monkeypatch.setattr(mesh_loading, "_MAX_SIZE", 5 * 684)
    monkeypatch.setattr(mesh_loading, "_MAX_TRIANGLES", 40)
    opened = open_workspace(str(tmp_path / "rover"), 10_000, {})
    (urdf,) = opened.robots
    assert isinstance(urdf, Read)
    robot = urdf.loaded.robot
    assert robot is not None
    scene = make_scene(Configuration(robot), "0", meshes=opened.load_meshes(urdf))
    assert [body.link for body in scene.bodies] == ["0", "1", "2"]
    assert [text.rpartition(": ")[2] for text in scene.missing[:3]] == [
        "40 triangles are read of all meshes of a robot",
        "40 triangles are read of all meshes of a robot",
        "3420 bytes are read of all meshes of a robot",
    ]
