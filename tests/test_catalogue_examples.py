"""Each problem code and each check has a wrong and a right example, in which the grader finds what they show."""

import re
import runpy
import tomllib
from pathlib import Path, PurePath
from textwrap import indent
from typing import Any

import pytest

from grader.base.ignore_comments import read_ignore_comments
from grader.base.problems import Problem
from grader.lab.checks.manual import MANUAL_CHECKS
from grader.lab.checks.registry import own_checks
from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission
from grader.lab.submission.submission import Lab, Submission
from grader.report.examples import example_blocks
from grader.report.explanations import explanation
from grader.ros.known.releases import Release
from grader.ros.package.finding import read_packages
from grader.ros.package.found_problems import build_problems, package_problems
from grader.ros.package.mesh_files import mesh_problems
from grader.ros.package.robot_file import Absent, Read, read_as_ros
from grader.workspace.rules.file_problems import listed_problems
from grader.workspace.rules.problem_kinds import EVERY_KIND
from tests.checks.submissions import png
from tests.command_line import ROOT
from tests.oracles.check_urdf import check_urdf
from tests.recordings.writing import write_text

FILES = {
    path.stem: tomllib.loads(path.read_text(encoding="utf-8"))
    for path in (ROOT / "docs/examples").glob("*.toml")
}
# The kinds of misconfiguration, of which tests/test_misconfigurations.py tests the examples.
KINDS: dict[str, Any] = FILES.pop("kinds")
del FILES["frames"]  # of the examples of rules, which tests/workspace/test_rule_examples.py tests
FRAMES = {
    name: file["frames"]
    for file in FILES.values()
    if "frames" in file
    for name in file
    if name != "frames"
}
ENTRIES: dict[str, Any] = {
    name: entry for file in FILES.values() for name, entry in file.items() if name != "frames"
}
CODES = {kind.code: kind for kind in EVERY_KIND}
OWN_EXAMPLES = [code for code in CODES if "example" not in ENTRIES[code]]
CHECKS = {check.name: check for check in own_checks()}
SIDES = pytest.mark.parametrize("side", ["wrong", "right"])
# What comes with a problem: an assumption, a consequence, another rule that the same mistake breaks.
ALSO = {
    "URDF001": "URDF015",
    "URDF002": "URDF015",
    "URDF010": "URDF041",
    "URDF011": "URDF009",
    "URDF015": "URDF002",
    "URDF031": "URDF071",
    "URDF041": "URDF091",
    "URDF043": "URDF062",
    "URDF070": "URDF080",
    "URDF082": "URDF084",
    "URDF085": "URDF084",
    "URDF095": "URDF009",
    "URDF099": "URDF031",
}
_OF_WORKSPACE = ("PKG018", "PKG022", "PKG025")  # at the beginning of a file
FOLDERS = {
    ".launch": "launch",
    ".launch.py": "launch",
    ".urdf": "urdf",
    ".xacro": "urdf",
    ".rviz": "rviz",
    ".srv": "srv",
    ".yaml": "config",
    ".srdf": "config",
    ".sdf": "worlds",
    ".py": "rover",
    "setup.py": "",
}
WHEEL = """\
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:macro name="wheel" params="name"><link name="${name}"/></xacro:macro>
</robot>
"""
# The robot beside examples of recorded messages, and a recording of 2 s.
RECORDED_ROBOT = b"""\
<robot name="rover"><link name="base_link"/><link name="lidar"/>
<link name="wheel"><visual><geometry><cylinder radius="0.1" length="0.04"/></geometry></visual></link>
<joint name="wheel_joint" type="continuous"><parent link="base_link"/><child link="wheel"/>
<origin rpy="-1.5708 0 0"/><axis xyz="0 0 1"/></joint>
<joint name="lidar_joint" type="fixed"><parent link="base_link"/><child link="lidar"/><origin xyz="0 0 0.2"/></joint>
</robot>
"""
_DRIVE = "- [0, /odom, nav_msgs/msg/Odometry, {}]\n- [2, /odom, nav_msgs/msg/Odometry, {}]"
INSTALLED = """\
('share/rover/urdf', glob('urdf/*')),
('share/rover/launch', glob('launch/*')),
('share/rover/rviz', glob('rviz/*')),
('share/rover/config', glob('config/*')),
"""


def framed(name: str, text: str, frame: str = "") -> tuple[str, range]:
    """Return a file with a text in a frame of this example, and the lines of the text."""
    inside = "\n\n".join(map(repeated, text.strip("\n").split("\n\n")))
    before, space, after = re.split(
        r"(?m)^( *)EXAMPLE$", FRAMES[name][frame or frame_of(name)].rstrip("\n")
    )
    first = before.count("\n") + 1
    return before + indent(inside, space) + after, range(first, first + inside.count("\n") + 1)


def frame_of(name: str) -> str:
    """Return the name of the frame of an example."""
    return str(ENTRIES[name].get("frame", next(iter(FRAMES[name]))))


def repeated(paragraph: str) -> str:
    """Return the lines that a paragraph stands for: each copy has numbers that are one higher."""
    *block, times = re.split(r"\n *<!-- \.\.\. (\d+) times -->$", paragraph)[:2]
    if not block:
        return paragraph
    return "\n".join(
        re.sub(r"\d+", lambda it: str(int(it[0]) + copy), block[0]) for copy in range(int(times))
    )


PACKAGE = {
    "package.xml": framed("PKG001", ENTRIES["PKG001"]["right"])[0],
    "setup.py": framed("PKG010", INSTALLED)[0],
    "resource/rover": "",
    "rover/__init__.py": "",
    "urdf/rover.urdf": '<robot name="rover"><link name="base_link"/></robot>',
    "launch/rover.launch.py": framed("LCH001", "")[0],
    "config/speed.yaml": "/**:\n  ros__parameters:\n    speed: 1.0\n",
    "rviz/rover.rviz": ENTRIES["RVZ003"]["right"],
}


def path_of(frame: str) -> str:
    """Return the path in the package of the file of a frame."""
    file = frame.rpartition("/")[2]
    ending = max((it for it in FOLDERS if file.endswith(it)), key=len, default="")
    return str(PurePath(FOLDERS.get(ending, ""), file))


# Those of one whose node is started.
STARTED = PACKAGE | {
    "setup.py": PACKAGE["setup.py"].replace(
        "data_files=", "entry_points={'console_scripts': ['pilot = rover.pilot:main']}, data_files="
    ),
    "setup.cfg": "[install]\ninstall_scripts=$base/lib/rover\n",
    "launch/rover.launch.py": framed("LCH001", "Node(package='rover', executable='pilot'),")[0],
}


# The files of a package that CMake builds.
COMPILED = {
    "package.xml": PACKAGE["package.xml"].replace("ament_python", "ament_cmake"),
    "src/driver.cpp": "#include <rclcpp/rclcpp.hpp>\n#include <sensor_msgs/msg/imu.hpp>\nint main() {}\n",
    "src/teleop.cpp": "#include <rclcpp/rclcpp.hpp>\nint main() {}\n",
}


# And those of one that generates the code of a service.
GENERATED = {
    "package.xml": COMPILED["package.xml"].replace(
        "</package>",
        "<buildtool_depend>rosidl_default_generators</buildtool_depend>"
        "<member_of_group>rosidl_interface_packages</member_of_group></package>",
    ),
    "CMakeLists.txt": "cmake_minimum_required(VERSION 3.16)\nproject(rover)\n"
    "find_package(ament_cmake REQUIRED)\nfind_package(rosidl_default_generators REQUIRED)\n"
    'rosidl_generate_interfaces(${PROJECT_NAME} "srv/Scan.srv")\nament_package()\n',
}


def files_of(name: str, side: str) -> tuple[dict[str, bytes], range]:
    """Return the files of a submission with one side of an example, its own file first, and the lines of the example there."""
    text, lines = framed(name, ENTRIES[name][side])
    file = frame_of(name).rpartition("/")[2]
    if file == "files.txt":
        contents = {
            PurePath(path).suffix: content.encode() for path, content in PACKAGE.items()
        } | {".png": png(), ".mp4": b"", ".mcap": write_text(_DRIVE)}
        return {path: contents[PurePath(path).suffix] for path in text.split("\n") if path}, lines
    if file == "recorded.yaml":
        return {"drive/drive_0.mcap": write_text(text), "rover.urdf": RECORDED_ROBOT}, lines
    encoding = re.match(r'<\?xml .*encoding="([^"]*)"', text)
    own = text.encode(encoding[1] if encoding else "utf-8")
    if file.endswith((".urdf", ".md")):
        return {file: own}, lines
    path = path_of(file)
    package = COMPILED if path == "CMakeLists.txt" else PACKAGE
    package = GENERATED if path.endswith(".srv") else package
    package = STARTED if path == "rover/pilot.py" else package
    others = {**package}
    if path.startswith("urdf/"):
        others = {it: text for it, text in others.items() if not it.startswith("urdf/")}
        others["urdf/wheel.xacro"] = WHEEL
    others.pop(path, None)
    return {f"rover/{path}": own} | {
        f"rover/{other}": content.encode() for other, content in others.items()
    }, lines


def opened(folder: Path, files: dict[str, bytes], distro: Release = "jazzy") -> Submission:
    """Return the submission that consists of these files, for a release of ROS 2."""
    for path, data in files.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_bytes(data)
    return open_submission(str(folder), Lab("urdf/rover.urdf", "rover", distro=distro))


def test_every_code_and_check_has_an_example() -> None:
    """No example is missing, and none is of something else; each is short and shows a difference. Codes are explained."""
    assert sorted(ENTRIES) == sorted([*CODES, *CHECKS])
    assert all(ENTRIES[code].get("explanation") for code in CODES)
    for name in [*OWN_EXAMPLES, *CHECKS]:
        entry = ENTRIES[name]
        assert entry["wrong"] != entry["right"], name
        for text in (entry["wrong"], entry["right"]):
            assert text.count("\n") <= 16, name
            assert max(map(len, text.split("\n"))) <= 110, name


@pytest.mark.every(kind=str)
@pytest.mark.parametrize("code", OWN_EXAMPLES)
def test_a_wrong_file_has_the_problem_and_a_right_one_has_none(code: str, tmp_path: Path) -> None:
    """The problem is at a line of the example, and the right file has no problem at all."""
    for side in ("wrong", "right"):
        files, lines = files_of(code, side)
        submission = opened(tmp_path / side, files, ENTRIES[code].get("distro", "jazzy"))
        found: list[Problem] = []
        urdf = submission.urdf
        if isinstance(urdf, Absent) and urdf.blank:  # which is not graded
            urdf = read_as_ros(files[urdf.blank], urdf.blank)
        if isinstance(urdf, Read):
            found += urdf.problems
            found += mesh_problems(urdf, submission.packages, submission.tree)
        found += package_problems(submission.package) if submission.package else []
        if code == "PKG023":  # where no release is stated
            found = [
                it
                for package in read_packages(submission.tree, "")
                for it in build_problems(package)
            ]
        if code in _OF_WORKSPACE:
            found = listed_problems(submission.workspace)
        if code.startswith("IGN"):
            path, text = next(iter(files.items()))
            comments = [*read_ignore_comments(path, text.decode())]
            found = [it.useless_problem([*it.codes]) for it in comments]
        if side == "right":
            assert found == []
        else:
            lines = range(1, 2) if code in _OF_WORKSPACE else lines  # of the whole file
            assert any(it.code == code and it.location.line in lines for it in found), (
                found,
                lines,
            )
            assert {it.code for it in found} == {code, *ALSO.get(code, code).split()}


@pytest.mark.every(kind=str)
@pytest.mark.parametrize("name", CHECKS)
def test_a_check_fails_what_is_wrong_and_passes_what_is_right(name: str, tmp_path: Path) -> None:
    """The row of a rubric is the one that `explain` shows; a check that needs manual grading finds nothing or something."""
    row = next(example_blocks(name))[2]
    (tmp_path / "lab.toml").write_text(
        'id = "lab"\ntitle = "Lab"\nurdf = "rover.urdf"\nreference = "right"\n[[part]]\nid = "all"\ntitle = "All"\n'
        f'[[criterion]]\nid = "only"\npart = "all"\ntitle = "Only"\npoints = 1\n{row}\n'
    )
    right, wrong = (opened(tmp_path / side, files_of(name, side)[0]) for side in ("right", "wrong"))
    rubric = load_rubric(str(tmp_path / "lab.toml"))
    passed, failed = (grade(rubric, submission).results[0].outcome for submission in (right, wrong))
    if CHECKS[name].function in MANUAL_CHECKS:
        assert (passed.status, failed.status) == ("pending", "pending")
        assert passed.problem == ""
        assert failed.problem != ""
    else:
        assert (passed.status, failed.status) == ("passed", "failed"), (passed, failed)


@pytest.mark.exhaustive
@pytest.mark.parametrize("code", [code for code in CODES if code.startswith("URDF")])
def test_ros_2_agrees(code: str) -> None:
    """ROS 2 loads the right file, and of the wrong one no more than the effect of the problem says."""
    verdicts = ["clean", "degraded", "rejected"]
    effects = {"loads": "clean", "drops": "degraded"}
    wrong, right = (next(iter(files_of(code, side)[0].values())) for side in ("wrong", "right"))
    release: Release = ENTRIES[code].get("distro", "jazzy")
    assert check_urdf(right, release=release).verdict == "clean"
    least = verdicts.index(effects.get(CODES[code].effect, "rejected"))
    assert verdicts.index(check_urdf(wrong, release=release).verdict) >= least


def test_an_explanation_shows_the_example() -> None:
    """`explain` shows a code and a check with their examples, and a criterion with the check to explain."""
    rubric = load_rubric("lab6")
    for name in ("URDF063", "axis_along"):
        text = explanation(name, rubric)
        for title, _, block in example_blocks(name):
            assert f"\n{title}:\n\n{indent(block, '    ')}\n" in text
    assert "Wrong:" not in explanation("lidar-frame", rubric)
    assert "`grader explain frame_at`" in explanation("lidar-frame", rubric)


@pytest.mark.slow
def test_the_pages_show_every_example() -> None:
    """docs/make.py makes a section of each code and check, with its example in code blocks."""
    pages = runpy.run_path(str(ROOT / "docs/make.py"))["pages"]()
    for page, names, heading in (("problems.md", CODES, "## {}"), ("checks.md", CHECKS, "## `{}`")):
        for name in names:
            place = pages[page].index(f"\n{heading.format(name)}\n")
            for title, _, text in example_blocks(name):
                place = pages[page].find(f"\n{text}\n```\n", place)
                assert place > 0, (name, title)
