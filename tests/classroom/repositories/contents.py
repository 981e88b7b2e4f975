"""What a repository contains beside a robot: a package, documents, pictures, and what is left over from other work."""

import io
import zipfile
from collections.abc import Callable, Mapping
from functools import cache

from tests.documents.files import PICTURE, docx, pdf
from tests.samples import ROOT

Contents = dict[str, bytes]  # by path

REFERENCE = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"
PICTURE_FILE = (ROOT / "submissions/lab6/reference/evidence/Task1_Step8.png").read_bytes()

_REPORT = (
    ("Lab 6 report", "Task 1: Step 8", PICTURE, "Task 1: Step 18", PICTURE),
    ("REQUIRED Question:", "The robot vanishes: the lidar has no joint, so there are two roots."),
    ("Task 1: Step 36", PICTURE, "Task 2: Step 6", PICTURE),
    ("REQUIRED Question:", "robot_state_publisher publishes the transforms of all links."),
    ("Task 3: Step 3", PICTURE),
)
_PICTURES = ("Task1_Step8", "Task1_Step18", "Task1_Step36", "Task2_Step6", "Task3_Step3")
_OTHER_ROBOT = '<robot name="{}"><link name="chassis"/></robot>'


def robot(sample: str) -> str:
    """Return the plain URDF of a sample submission."""
    path = (
        REFERENCE / "urdf/my_robot.urdf"
        if sample == "reference"
        else ROOT / "submissions/lab6" / sample / "my_robot/urdf/my_robot.urdf"
    )
    return path.read_text(encoding="utf-8")


def package(launched: str, name: str = "my_robot") -> Contents:
    """Return a package without a URDF, whose launch file opens my_robot.urdf or runs xacro on the file that is `launched`."""
    sample = ROOT / "submissions/lab6/equivalent-xacro-macros/my_robot" if launched else REFERENCE
    found = {
        path.relative_to(sample).as_posix(): path.read_bytes()
        for path in sorted(sample.rglob("*"))
        if path.is_file() and path.parent.name != "urdf" and "__pycache__" not in path.parts
    }
    launch = "launch/my_robot_rviz.launch.py"
    found[launch] = found[launch].replace(b"my_robot.urdf", (launched or "my_robot.urdf").encode())
    if name != "my_robot":
        found = {
            path.replace("my_robot/__init__", f"{name}/__init__"): data
            for path, data in found.items()
        }
        found |= {
            path: data.replace(b"my_robot", name.encode())
            for path, data in found.items()
            if "/" not in path
        }
        found[f"resource/{name}"] = found.pop("resource/my_robot")
    return found


def zipped(contents: Contents) -> bytes:
    """Return a zip of these files."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        for path, content in contents.items():
            archive.writestr(zipfile.ZipInfo(path, (2026, 1, 1, 0, 0, 0)), content)
    return data.getvalue()


def _pictures() -> Contents:
    return {f"{name}.png": PICTURE_FILE for name in _PICTURES}


def _loosely_named_pictures() -> Contents:
    names = ("task 1 step 8", "Task1-step18 (1)", "T1S36", "lab6_task2_step6", "Part3_step3")
    return {f"{name}.png": PICTURE_FILE for name in names}


@cache
def _pdf() -> bytes:
    return pdf(*_REPORT)


@cache
def _docx() -> bytes:
    return docx(*(line for page in _REPORT for line in page))


def _answers() -> Contents:
    return {"answers.md": (ROOT / "submissions/lab6/reference/answers.md").read_bytes()}


def _stale_build() -> Contents:
    """Return what a build has copied of an older robot."""
    old = robot("centimetres").encode()
    share = "install/my_robot/share/my_robot"
    return {
        f"{share}/my_robot.urdf": old,
        f"{share}/package.xml": (REFERENCE / "package.xml").read_bytes(),
        f"{share}/launch/my_robot_rviz.launch.py": b"print(",
        "build/my_robot/urdf/my_robot.urdf": old,
        "build/my_robot/setup.py": b"",
        "log/latest_build/events.log": b"[0.1] (my_robot) JobStarted\n",
    }


def _final_project() -> Contents:
    """Return a package of another robot, with its own launch file and worlds."""
    rover = _OTHER_ROBOT.format("rover")
    return {
        "rover_gazebo/package.xml": b"<package format='3'><name>rover_gazebo</name></package>",
        "rover_gazebo/setup.py": b"from setuptools import setup\nsetup(name='rover_gazebo')\n",
        "rover_gazebo/urdf/rover.urdf.xacro": rover.encode(),
        "rover_gazebo/urdf/my_robot.gazebo": rover.encode(),
        "rover_gazebo/launch/rover.launch.py": b"",
        "rover_gazebo/worlds/maze.sdf": b"<sdf version='1.9'><world name='maze'/></sdf>",
    }


def _another_version() -> Contents:
    return {"my_robot.urdf": robot("centimetres").encode()}


EXTRAS: Mapping[str, Callable[[], Contents]] = {
    "pictures": _pictures,
    "loosely named pictures": _loosely_named_pictures,
    "pdf": lambda: {"report.pdf": _pdf()},
    "docx": lambda: {"Lab 6 answers.docx": _docx()},
    "answers": _answers,
    "readme": lambda: {"README.md": b"# Introduction to Robot Programming\n"},
    "stale build": _stale_build,
    "final project": _final_project,
    "another version": _another_version,
    "another package": lambda: {**package(""), "urdf/my_robot.urdf": robot("centimetres").encode()},
    "box": lambda: {"box.urdf": b'<robot name="box"><link name="base_link"/></robot>'},
    "prelab": lambda: {"box.urdf": b'<robot name="box"><link name="box"/></robot>'},
    "webots": lambda: {
        "worlds/arena.wbt": b"#VRML_SIM R2025a utf8\nWorldInfo { }\n",
        "protos/EPuck.proto": b"#VRML_SIM R2025a utf8\n",
        "resource/e-puck.urdf": b'<robot name="EPuck"><webots><device/></webots></robot>',
    },
    "macOS": lambda: {
        "__MACOSX/._my_robot.urdf": b"\0\5\x16\7<robot/>",
        ".DS_Store": b"\0\0",
        "__MACOSX/my_robot.urdf": b"\0\5\x16\7",
    },
    "pictures of another lab": lambda: {
        "Task1_Step8.png": PICTURE_FILE,
        "Task4_Step2.png": PICTURE_FILE,
    },
    "git": lambda: {
        ".git/config": b"[core]\n",
        ".vscode/settings.json": b"{}",
        ".gitignore": b"__pycache__/\n",
    },
}
