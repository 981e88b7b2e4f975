"""Equivalents of a reference are the same robot, and a criterion is never asked about a rewriting under which its check breaks."""

from collections.abc import Iterator
from pathlib import Path

import pytest
from lxml import etree

from grader.lab.authoring.equivalents import Equivalent, RewritingRules, equivalents
from grader.lab.authoring.rubric_test import Trial
from grader.lab.authoring.trees import copied
from grader.lab.checks.check import EQUIVALENTS, MIMIC_TURNED
from grader.lab.checks.registry import find_check
from grader.lab.submission.opening import read_submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Robot
from tests.authoring.robots import ARM, BOX, FRAME, TOP, rubric_in

POSITIONS = (
    (0.0, 0.0),
    (0.4, 0.03),
    (-1.1, 0.09),
)  # of the shoulder and the slide, which are told by their limits


def made(
    kept: set[str] | None = None, text: str = ARM, *, placed: bool = False
) -> list[Equivalent]:
    """Return the equivalents of the arm, or of another robot."""
    urdf = read_submission(text.encode(), identity="a", path="birch.urdf").urdf
    assert isinstance(urdf, Read)
    assert urdf.reading.root is not None
    return list(equivalents(urdf.reading.root, RewritingRules(kept or set(), placed)))


def read(equivalent: Equivalent) -> Robot:
    """Return the robot of an equivalent, which ROS 2 loads without any problem."""
    path = "birch.urdf.xacro" if equivalent.is_xacro else "birch.urdf"
    urdf = read_submission(equivalent.text.encode(), identity="a", path=path).urdf
    assert isinstance(urdf, Read)
    assert urdf.loaded.verdict == "clean", urdf.problems
    assert urdf.is_expanded == equivalent.is_xacro
    assert urdf.reading.robot is not None
    return urdf.reading.robot


def seen(robot: Robot) -> list[tuple[str, tuple[float, ...]]]:
    """Return where every shape and mass is at some positions, in the frame of the root, whatever things are called."""
    return sorted(_seen(robot))


def _seen(robot: Robot) -> Iterator[tuple[str, tuple[float, ...]]]:
    shoulder, slide = (
        next(joint.name for joint in robot.joints if joint.limit and joint.limit.upper == it)
        for it in (1.4, 0.1)
    )
    for positions in POSITIONS:
        posed = Configuration(robot, dict(zip((shoulder, slide), positions, strict=True)))
        for link in robot.links:
            pose = posed.pose(link.name)
            shapes = [(shape.geometry, shape.origin) for shape in link.visuals]
            for geometry, origin in shapes + [
                (shape.geometry, shape.origin) for shape in link.collisions
            ]:
                yield f"{positions} {geometry}", _numbers(origin.placed_in(pose).matrix)
            if link.inertial is not None:
                mass = link.inertial
                yield (
                    f"{positions} {mass.mass} {mass.inertia}",
                    _numbers(mass.origin.placed_in(pose).matrix),
                )


def _numbers(matrix: tuple[tuple[float, ...], ...]) -> tuple[float, ...]:
    return tuple(number for row in matrix for number in row)


def test_every_equivalent_is_the_same_robot() -> None:
    """In all rewritings, shapes and masses are where they were, also when the joints move."""
    expected = dict(seen(read_arm()))
    found = made()
    assert [equivalent.rewriting for equivalent in found] == [*EQUIVALENTS]
    for equivalent in found:
        robot = read(equivalent)
        assert dict(seen(robot)).keys() == expected.keys(), equivalent.rewriting
        for name, numbers in seen(robot):
            assert numbers == pytest.approx(expected[name], abs=1e-9), (
                f"{equivalent.rewriting}: {name}"
            )
        assert sorted(map(str, limits(robot))) == sorted(map(str, limits(read_arm())))


def read_arm() -> Robot:
    """Return the arm."""
    urdf = read_submission(ARM.encode(), identity="a", path="birch.urdf").urdf
    assert isinstance(urdf, Read)
    assert urdf.reading.robot is not None
    return urdf.reading.robot


def limits(robot: Robot) -> list[object]:
    """Return the limits of the joints that move."""
    return [(joint.type, joint.limit) for joint in robot.joints if joint.type != "fixed"]


def test_each_rewriting_changes_what_it_says() -> None:
    """Each differs from the reference in the thing that gives it its name."""
    first = {equivalent.rewriting: equivalent for equivalent in made()}
    arm, robots = (
        read_arm(),
        {rewriting: read(equivalent) for rewriting, equivalent in first.items()},
    )
    assert [link.name for link in robots["order of elements"].links] != [
        link.name for link in arm.links
    ]
    assert len(robots["fixed joints split"].links) > len(arm.links)
    assert [joint.origin for joint in robots["frames moved"].joints] != [
        joint.origin for joint in arm.joints
    ]
    assert len(robots["frames moved"].links) == len(arm.links)
    assert {joint.name for joint in robots["joints renamed"].joints} != {
        joint.name for joint in arm.joints
    }
    assert {link.name for link in robots["links renamed"].links} != {
        link.name for link in arm.links
    }
    assert (
        robots["layout of the text"] == arm == robots["xacro properties"] == robots["xacro macro"]
    )
    assert "<!--" in first["layout of the text"].text
    assert "${number_0}" in first["xacro properties"].text
    assert "<xacro:part name=" in first["xacro macro"].text


def test_names_that_something_refers_to_stay(tmp_path: Path) -> None:
    """Those in the rubric's arguments, in files around the URDF and in the elements of simulators; their frames stay, too."""
    (tmp_path / "other.yaml").write_text("joint: slide\n")
    kept = Trial(rubric_in(tmp_path, TOP + BOX + FRAME)).kept
    assert {"plate", "tool", "finger"} <= kept
    found, arm = made(kept | {"slide"}), read_arm()
    for equivalent in found:
        robot = read(equivalent)
        assert all(map(robot.has_link, ("plate", "tool", "finger", "base")))
        assert robot.has_joint("slide")
        assert robot.has_joint("shoulder")  # <transmission> names it
        for link in ("plate", "tool", "finger"):
            moved, before = Configuration(robot).pose(link), Configuration(arm).pose(link)
            assert moved.translation == pytest.approx(before.translation, abs=1e-9)


def test_frames_of_links_that_are_named_by_their_place_stay() -> None:
    """@root, @tip and @moved:1 are the ends of the tree and the links that move."""
    moved = next(
        equivalent for equivalent in made(placed=True) if equivalent.rewriting == "frames moved"
    )
    robot, arm = Configuration(read(moved)), Configuration(read_arm())
    inner = {joint.parent for joint in arm.robot.joints}
    for joint in arm.robot.joints:
        if joint.type != "fixed" or joint.child not in inner:
            assert robot.pose(joint.child).translation == pytest.approx(
                arm.pose(joint.child).translation, abs=1e-9
            )


@pytest.mark.parametrize(
    ("check", "arguments", "rewritings"),
    [
        ("frame_at", {"link": "tool"}, ()),
        ("counts", {"moving": 3}, ()),
        ("counts", {"links": 3, "moving": None}, ("fixed joints split",)),
        ("counts", {"fixed": 3}, ("fixed joints split",)),
        ("kinematics_match_reference", {"match": "order"}, ()),
        ("kinematics_match_reference", {"links": ["tool"]}, ("joints renamed",)),
        ("entry_is", {"at": "gazebo[@reference='a']"}, ()),
        (
            "entry_is",
            {"at": "joint"},
            ("fixed joints split", "frames moved", "links renamed", "joints renamed", MIMIC_TURNED),
        ),
        ("mimics", {"multiplier": -1.0, "direction": (0, 1, 0)}, ()),
        ("mimics", {"multiplier": -1.0}, (MIMIC_TURNED,)),
        ("joint_axis", {"either_way": True}, ()),
        ("joint_axis", {}, (MIMIC_TURNED,)),
        ("without_problems", {"problems": ["URDF063"]}, EQUIVALENTS),
        ("xacro_uses", {"macros": 1}, EQUIVALENTS),
    ],
)
def test_a_check_breaks_under_rewritings(
    check: str, arguments: dict[str, object], rewritings: tuple[str, ...]
) -> None:
    """By its arguments: a count of links breaks where there are more links, and one of moving joints does not."""
    found = find_check(check)
    assert found is not None
    assert found.about.breaks_under(arguments) == rewritings


SHARED = """<robot name="r">
  <link name="a"><visual><geometry><sphere radius="1"/></geometry>
    <material name="red"><color rgba="1 0 0 1"/></material></visual></link>
  <link name="b"><visual><geometry><sphere radius="2"/></geometry><material name="red"/></visual>
    <note kind="a">Text &amp; more</note></link>
  <link name="c"><visual><geometry><sphere radius="3"/></geometry><material name="red"/></visual></link>
  <joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
  <joint name="k" type="fixed"><parent link="b"/><child link="c"/></joint>
</robot>"""


def test_a_material_that_a_visual_defines_keeps_its_place() -> None:
    """Visuals before it would have no colour; text in elements that ROS 2 ignores stays as well."""
    for equivalent in made(text=SHARED):
        colours = [visual.material for link in read(equivalent).links for visual in link.visuals]
        assert [colour.rgba for colour in colours if colour is not None] == [
            (1.0, 0.0, 0.0, 1.0)
        ] * 3
        assert ">Text &amp; more<" in equivalent.text


def test_a_mesh_that_xacro_has_found_stays_that_of_its_package() -> None:
    """The expansion has a made-up path for $(find package), which no equivalent may contain."""
    robot = b'<robot><mesh filename="file:///install/arm/share/arm/meshes/a.stl"/><mesh filename="package://b/c.stl"/></robot>'
    names = [mesh.get("filename") for mesh in copied(etree.fromstring(robot))]
    assert names == ["package://arm/meshes/a.stl", "package://b/c.stl"]
