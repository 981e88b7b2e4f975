"""Rubrics with defaults, with joint positions for criteria, and with links named by their place in the tree."""

from pathlib import Path

import pytest

from tests.command_line import run

ARM = """\
<robot name="arm">
  <link name="base"/>
  <link name="upper"/>
  <link name="fore"/>
  <link name="hand"/>
  <link name="finger"/>
  <joint name="joint_1" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/>
    <limit lower="-1.57" upper="1.57" effort="1" velocity="1"/></joint>
  <joint name="slide" type="prismatic"><parent link="upper"/><child link="fore"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.2" effort="1" velocity="1"/></joint>
  <joint name="hand_joint" type="fixed"><parent link="fore"/><child link="hand"/><origin xyz="0 0 0.1"/></joint>
  <joint name="finger_joint" type="prismatic"><parent link="hand"/><child link="finger"/><axis xyz="1 0 0"/>
    <limit lower="0" upper="0.2" effort="1" velocity="1"/><mimic joint="slide" multiplier="0.5"/></joint>
</robot>
"""
RUBRIC = """\
id = "arm"
title = "An arm"
reference = "arm.urdf"

[defaults]
part = "model"
points = 2
about = "The arm"

[defaults.with.frame_at]
link = "hand"
relative_to = "base"
tolerance = 0.002

[[part]]
id = "model"
title = "The model"
points = 2

[[criterion]]
id = "posed"
title = "The hand is in place"
check = "frame_at"
"""


def graded(folder: Path, more: str, robot: str = ARM, *command: str, rubric: str = RUBRIC) -> tuple[int, str]:
    """Return the exit code and all output of a command with a rubric, `grade` by default."""
    (folder / "arm.urdf").write_text(robot, encoding="utf-8")
    (folder / "arm.toml").write_text(rubric + more, encoding="utf-8")
    done = run(command or ("grade", folder / "arm.urdf", "--rubric", folder / "arm.toml"))
    return done.returncode, " ".join((done.stdout + done.stderr).decode().split())


def test_a_robot_is_posed_in_degrees_and_metres(tmp_path: Path) -> None:
    """Joints that turn take degrees, joints that slide metres; the others stay at 0."""
    code, text = graded(tmp_path, "at = { joint_1 = 90, slide = 0.1 }\nwith = { xyz = [0.5, 0, 0] }\n")
    assert (code, "2/2 An arm" in text) == (0, True)
    assert graded(tmp_path, "with = { xyz = [0, 0, 0.4] }\n")[0] == 0


def test_a_failure_names_the_pose(tmp_path: Path) -> None:
    """A message on a posed robot says where its joints are."""
    code, text = graded(tmp_path, "at = { joint_1 = 90, slide = 0.1 }\nwith = { xyz = [0, 0, 0.4] }\n")
    assert code == 1
    assert "(x 500 mm too large, z 400 mm too small) (with 'joint_1' at 90 degrees and 'slide' at 0.1 m)." in text


def test_a_mimic_joint_follows(tmp_path: Path) -> None:
    """A mimic joint moves with its leader, unless its own position is given."""
    assert graded(tmp_path, 'at = { slide = 0.2 }\nwith = { link = "finger", xyz = [0.1, 0, 0.6] }\n')[0] == 0
    more = 'at = { slide = 0.2, finger_joint = 0 }\nwith = { link = "finger", xyz = [0, 0, 0.6] }\n'
    assert graded(tmp_path, more)[0] == 0


@pytest.mark.parametrize(
    "open_part", ['joint="$(env X)"', 'joint="slide" multiplier="$(env X)"', 'joint="slide" offset="$(env X)"']
)
@pytest.mark.parametrize("pose", ["", "at = { slide = 0.1 }\n"])
def test_a_mimic_joint_that_xacro_leaves_open_is_not_posed(tmp_path: Path, open_part: str, pose: str) -> None:
    """The pose of the link below it, or below a joint that follows it, needs manual grading; unless the joint's position is given."""
    last = '<link name="nail"/><joint name="nail_joint" type="prismatic"><parent link="hand"/><child link="nail"/>'
    last += (
        '<axis xyz="1 0 0"/><limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="finger_joint"/></joint>'
    )
    robot = ARM.replace('joint="slide" multiplier="0.5"', open_part).replace("</robot>", f"{last}</robot>")
    (tmp_path / "open.xacro").write_text(robot.replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'))
    command = ("grade", tmp_path / "open.xacro", "--rubric", tmp_path / "arm.toml")
    for link in ("finger", "nail"):
        more = f'with = {{ link = "{link}", relative_to = "hand", xyz = [0, 0, 0] }}\n'
        code, text = graded(tmp_path, pose + more, ARM, *map(str, command))
        assert (code, "–/2" in text, "X is known only at run time" in text) == (1, True, True)
    given = "at = { finger_joint = 0.1 }\n" + 'with = { link = "nail", relative_to = "hand", xyz = [0.1, 0, 0] }\n'
    assert "2/2" in graded(tmp_path, given, ARM, *map(str, command))[1]


def test_a_joint_whose_type_xacro_leaves_open_is_not_posed(tmp_path: Path) -> None:
    """It may turn or slide, so its position has no unit: the criterion needs manual grading."""
    robot = ARM.replace('type="prismatic"', 'type="$(env X)"', 1)
    (tmp_path / "open.xacro").write_text(robot.replace("<robot", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'))
    command = ("grade", str(tmp_path / "open.xacro"), "--rubric", str(tmp_path / "arm.toml"))
    code, text = graded(tmp_path, "at = { slide = 0.1 }\nwith = { xyz = [0, 0, 0.5] }\n", ARM, *command)
    assert (code, "–/2" in text, "X is known only at run time" in text) == (1, True, True)


@pytest.mark.parametrize(
    ("position", "message"),
    [
        ("hand_joint", "The joint 'hand_joint' is fixed; it should turn or slide."),
        ("joint_2", "There is no joint 'joint_2'"),
        ('"@moved:3"', "There is no @moved:3: the longest chain has 2 moving joints."),
        ('"@root"', "No joint moves @root."),
    ],
)
def test_a_joint_that_cannot_be_posed_fails(tmp_path: Path, position: str, message: str) -> None:
    """A joint that is missing or fixed fails the criterion, and only this one."""
    other = '[[criterion]]\nid = "home"\ntitle = "Home"\ncheck = "frame_at"\nwith = { xyz = [0, 0, 0.4] }\n'
    rubric = RUBRIC.replace("points = 2\n\n[[crit", "\n[[crit")
    code, text = graded(tmp_path, f"at = {{ {position} = 0 }}\nwith = {{ xyz = [0, 0, 0.4] }}\n{other}", rubric=rubric)
    assert (code, message in text, "2/4 An arm" in text) == (1, True, True)


def test_links_are_named_by_their_place_in_the_tree(tmp_path: Path) -> None:
    """A selector means the same link whatever it is called, in arguments and in positions."""
    renamed = ARM.replace('"hand"', '"gripper"').replace('"base"', '"world"').replace("joint_1", "shoulder")
    more = 'at = { "@moved:1" = 90, "@moved:2" = 0.1 }\nwith = { link = "@moved:2", relative_to = "@root", xyz = [0.4, 0, 0] }\n'
    for robot in (ARM, renamed):
        assert graded(tmp_path, more, robot)[0] == 0


def test_a_selector_that_means_several_links_needs_manual_grading(tmp_path: Path) -> None:
    """A robot with two tips is not guessed at."""
    robot = ARM.replace('<link name="finger"/>', '<link name="finger"/><link name="lamp"/>')
    lamp = '<joint name="lamp_joint" type="fixed"><parent link="fore"/><child link="lamp"/></joint>'
    code, text = graded(
        tmp_path, 'with = { link = "@tip", xyz = [0, 0, 0] }\n', robot.replace("</robot>", f"{lamp}</robot>")
    )
    assert code == 1
    assert "Several links can be @tip: 'finger' and 'lamp'; needs manual grading." in text


@pytest.mark.parametrize(
    ("more", "message"),
    [
        (
            'with = { link = "@moved:3", xyz = [0, 0, 0] }\n',
            "there is no @moved:3: the longest chain has 2 moving joints",
        ),
        ('at = { "@moved:7" = 0 }\nwith = { xyz = [0, 0, 0.4] }\n', "there is no @moved:7"),
    ],
)
def test_a_rubric_with_a_selector_of_nothing_is_refused(tmp_path: Path, more: str, message: str) -> None:
    """`rubric check` demands that each selector means one link of the reference, also where the criterion is not failed."""
    code, text = graded(tmp_path, more, ARM, "rubric", "check", str(tmp_path / "arm.toml"))
    assert (
        code,
        f"posed names a link by its place in the tree, and the reference has no such link: {message}" in text,
    ) == (2, True)


def test_an_ambiguous_selector_of_a_reference_is_refused(tmp_path: Path) -> None:
    """What needs manual grading in the reference would need it in every submission."""
    lamp = '<link name="lamp"/><joint name="lamp_joint" type="fixed"><parent link="fore"/><child link="lamp"/></joint>'
    robot = ARM.replace("</robot>", f"{lamp}</robot>")
    code, text = graded(
        tmp_path, 'with = { link = "@tip", xyz = [0, 0, 0] }\n', robot, "rubric", "check", str(tmp_path / "arm.toml")
    )
    assert (code, "several links can be @tip: 'finger' and 'lamp'" in text) == (2, True)


@pytest.mark.parametrize(
    ("old", "new", "line"),
    [
        ('part = "model"\npoints', 'part = "modle"\npoints', "6: there is no part 'modle'; did you mean 'model'?"),
        ("points = 2\nabout", "points = -2\nabout", "7: points must be a number from 0 to 1000000, not -2"),
        (
            'about = "The arm"',
            'title = "The arm"',
            "8: a defaults table has no key 'title'; it has: part, points, about, with",
        ),
        ("with.frame_at]", "with.frame_on]", "10: there is no check 'frame_on'; did you mean 'frame_at'?"),
        ("tolerance = 0.002", "tolerance = -1", "13: tolerance of frame_at must be at least 0, not -1"),
        ("tolerance = 0.002", "angles = 1", "13: the check frame_at takes no 'angles'; did you mean 'angle'?"),
        (
            "[defaults.with.frame_at]",
            "[defaults.with]\nframe_at = 3\n[x]",
            "11: the arguments of frame_at must be a table, not 3",
        ),
        ('check = "frame_at"', 'check = "frame_at"\nat = { }', "24: at must be a table of numbers, not {}"),
        (
            'check = "frame_at"',
            'check = "frame_at"\nat = { joint_1 = "up" }',
            "24: at must be a table of numbers, not { joint_1 = 'up' }",
        ),
        (
            'check = "frame_at"',
            'check = "urdf_loads"\nat = { joint_1 = 1 }',
            "24: at poses the robot, but the check urdf_loads does not examine it",
        ),
    ],
)
def test_mistakes_are_named_with_their_line(tmp_path: Path, old: str, new: str, line: str) -> None:
    """A mistake in defaults or positions is one line, and nothing is graded."""
    assert old in RUBRIC
    code, text = graded(tmp_path, "with = { xyz = [0, 0, 0.4] }\n", rubric=RUBRIC.replace(old, new))
    assert (code, f"arm.toml:{line}" in text) == (2, True), text


@pytest.mark.parametrize(
    "more",
    ['with = { link = "@moved:0", xyz = [0, 0, 0] }\n', 'at = { "@moved:0" = 1 }\nwith = { xyz = [0, 0, 0] }\n'],
)
def test_a_misspelt_selector_is_named_with_its_line(tmp_path: Path, more: str) -> None:
    """The message lists what there is."""
    code, text = graded(tmp_path, more)
    message = "arm.toml:20: no link is named by '@moved:0': write @root, @tip, or @moved:1, @moved:2 and so on"
    assert (code, message in text) == (2, True), text


def test_a_criterion_overrides_the_defaults(tmp_path: Path) -> None:
    """What a criterion gives itself counts, and the other defaults stay."""
    more = 'points = 7\nwith = { link = "fore", xyz = [0, 0, 0.3] }\n'
    code, text = graded(tmp_path, more, rubric=RUBRIC.replace("points = 2\n\n[[crit", "points = 7\n\n[[crit"))
    assert (code, "7/7 An arm" in text) == (0, True)


def test_without_a_default_a_criterion_needs_its_keys(tmp_path: Path) -> None:
    """Defaults that are not given do not hide what is missing."""
    rubric = RUBRIC.replace("points = 2\nabout", "about").replace("tolerance = 0.002\n", "")
    code, text = graded(tmp_path, "with = { xyz = [0, 0, 0.4] }\n", rubric=rubric)
    assert (code, "this criterion has no points" in text) == (2, True)
    assert "the check frame_at needs tolerance: a number" in text


def test_explain_shows_the_pose(tmp_path: Path) -> None:
    """The explanation of a criterion says where the joints are."""
    more = "at = { joint_1 = 90, slide = 0.1 }\nwith = { xyz = [0.5, 0, 0] }\n"
    code, text = graded(tmp_path, more, ARM, "explain", "posed", "--rubric", str(tmp_path / "arm.toml"))
    assert (
        code,
        "The robot is posed: joint_1 = 90, slide = 0.1 (degrees or metres); its other joints are at 0." in text,
    ) == (0, True)


SELECTED = 'at = { "@moved:1" = 90 }\nwith = { xyz = [0.4, 0.0, 0.0] }\n'


def test_a_fixed_joint_with_the_name_of_a_posed_joint_does_not_matter(tmp_path: Path) -> None:
    """A joint that is pasted and not renamed is no fault of the grader: the joint that moves the link is posed."""
    robot = ARM.replace('name="hand_joint"', 'name="joint_1"')
    status, text = graded(tmp_path, SELECTED, robot, rubric=RUBRIC.replace('reference = "arm.urdf"', ""))
    assert status == 0, text
    assert "2/2" in text


def test_joints_of_one_name_cannot_be_posed(tmp_path: Path) -> None:
    """If several joints that move have the name, the criterion fails and says so, at the second of them."""
    robot = ARM.replace('name="slide"', 'name="joint_1"').replace('joint="slide"', 'joint="joint_1"')
    status, text = graded(tmp_path, SELECTED, robot, rubric=RUBRIC.replace('reference = "arm.urdf"', ""))
    assert status == 1
    assert "2 joints are called 'joint_1'; each needs a name of its own" in text
    assert "arm.urdf:9:" in text


def test_hints_above_the_level_of_the_rubric_are_refused_aloud(tmp_path: Path) -> None:
    """Standard error says why they are no more detailed than usual."""
    (tmp_path / "arm.urdf").write_text(ARM, encoding="utf-8")
    (tmp_path / "arm.toml").write_text(RUBRIC + "with = { xyz = [0, 0, 0.4] }\n", encoding="utf-8")
    done = run(("grade", tmp_path / "arm.urdf", "--rubric", tmp_path / "arm.toml", "--hints", "edit"))
    assert done.stderr.decode() == "grader: --hints edit: the rubric arm allows hints up to the level cause\n"
