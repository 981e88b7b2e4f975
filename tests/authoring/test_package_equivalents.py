"""Equivalents of packages: what they change, and that they are what the solution is."""

from pathlib import Path

import pytest

from grader.files.tree import overlaid
from grader.lab.authoring.package_equivalents import package_equivalents
from grader.lab.submission.opening import open_with_packages
from grader.lab.submission.submission import Submission
from grader.workspace.rules.reading import read_agreement
from tests.command_line import ROOT

pytestmark = pytest.mark.slow

LAB6 = ROOT / "rubrics/lab6/my_robot"
DIFFDRIVE = ROOT / "rubrics/diffdrive/diffdrive_robot"


def families(submission: Submission, named: tuple[str, ...] = ()) -> dict[str, Submission]:
    """Return the submission as each family of equivalents rewrites it."""
    assert submission.reopen is not None
    robot_files = [
        path for path in submission.whole_tree.files if path.endswith((".xacro", ".urdf"))
    ]
    rewritten = {}
    for family, texts in package_equivalents(submission, named, robot_files):
        files = {path: None if text is None else text.encode() for path, text in texts.items()}
        rewritten[family] = submission.reopen(overlaid(submission.whole_tree, files))
    return rewritten


def started(submission: Submission) -> set[tuple[object, ...]]:
    """Return what launch files start: programs, and the parameters that nodes get."""
    found: set[tuple[object, ...]] = set()
    for package in submission.lab_packages.values():
        for path in package.launch_files:
            for node in package.launch(path).nodes:
                found.add((node.name, submission.workspace.code.find_name(node), node.when))
    for name, given in submission.workspace.parameters.owners.items():
        for one in given:
            for key, parameter in one.values.items():
                value = parameter.value
                is_plain = isinstance(value, bool | int | float | str | list)
                found.add((name, key, repr(value) if is_plain else type(value)))
    return found


def wrong(submission: Submission) -> list[str]:
    """Return what certainly does not agree in a submission."""
    return [it.message for it in read_agreement(submission.workspace).mismatches if it.is_certain]


@pytest.mark.parametrize(
    ("reference", "expected"),
    [
        (LAB6, {"package built by CMake"}),
        (DIFFDRIVE, {"spawners after an event", "files renamed", "<ros2_control> renamed"}),
    ],
    ids=["lab6", "diffdrive"],
)
def test_packages_of_robots_are_rewritten(reference: Path, expected: set[str]) -> None:
    """Nothing disagrees afterwards, and the same nodes start with the same parameters."""
    submission = open_with_packages(str(reference))
    found = families(submission)
    assert {*found} == expected
    for family, same in found.items():
        assert wrong(same) == [], family
        assert started(same) == started(submission), family


MANIFEST = """<package format="3"><name>talk</name><version>0.1.0</version><description>d</description>
<maintainer email="a@example.org">a</maintainer><license>MIT</license>
<exec_depend>demo_nodes_cpp</exec_depend><exec_depend>ament_index_python</exec_depend>
<exec_depend>launch</exec_depend><exec_depend>launch_ros</exec_depend>
<export><build_type>ament_python</build_type></export></package>"""
SETUP = """from glob import glob
from setuptools import setup

setup(
    name='talk',
    version='0.1.0',
    packages=[],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/talk']),
        ('share/talk', ['package.xml']),
        ('share/talk/launch', glob('launch/*.launch.py')),
        ('share/talk/config', glob('config/*.yaml')),
    ],
)
"""
LAUNCH = """import os

from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    config = os.path.join(get_package_share_directory('talk'), 'config', 'talk.yaml')
    return LaunchDescription([
        Node(
            package='demo_nodes_cpp', executable='talker', name='talker', namespace='left',
            parameters=[config, {'rate': 2.0, 'is_loud': True}], remappings=[('chatter', '/words')],
        ),
        Node(package='demo_nodes_cpp', executable='listener', arguments=['--ros-args']),
    ])
"""
TALK = {
    "talk/package.xml": MANIFEST,
    "talk/setup.py": SETUP,
    "talk/resource/talk": "",
    "talk/config/talk.yaml": "/**:\n  ros__parameters:\n    words: 3\n",
    "talk/launch/talk.launch.py": LAUNCH,
}


def write_talk(folder: Path, **changes: str) -> Submission:
    """Write the package with other texts of its launch file, and open it."""
    for path, text in TALK.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        for old, new in changes.items() if path.endswith(".launch.py") else ():
            assert old in text
            text = text.replace(old, new)
        (folder / path).write_text(text)
    return open_with_packages(str(folder))


def test_a_launch_file_is_rewritten_in_another_language(tmp_path: Path) -> None:
    """With all its nodes, parameters, remappings and arguments; setup.py installs it."""
    submission = write_talk(tmp_path)
    found = families(submission)
    languages = {"launch file in XML", "launch file in YAML"}
    assert languages <= {*found}
    rewritten = {language: found[language] for language in languages}
    for language in languages:  # and back
        again = families(found[language])["launch file in Python"]
        rewritten[f"{language}, in Python"] = again
    for same in rewritten.values():
        assert wrong(same) == []
        assert started(same) == started(submission)
        [before], [after] = (
            [
                package.launch(path)
                for package in it.lab_packages.values()
                for path in package.launch_files
            ]
            for it in (submission, same)
        )
        for one, other in zip(before.nodes, after.nodes, strict=True):
            assert (one.remaps, one.namespace, one.arguments) == (
                other.remaps,
                other.namespace,
                other.arguments,
            )


@pytest.mark.parametrize(
    "change",
    [
        {"name='talker'": "name=input()"},
        {"'rate': 2.0": "'rate': 'fast'"},
        {"'--ros-args'": "'a word'"},
        {"LaunchDescription([": "LaunchDescription([DeclareLaunchArgument('a'),"},
        {"executable='listener'": "executable='listener', condition=input()"},
    ],
    ids=["name", "text", "argument", "declared", "condition"],
)
def test_what_is_not_all_known_stays_in_python(change: dict[str, str], tmp_path: Path) -> None:
    """A name or condition of run time, a text that launch reads as YAML, launch arguments."""
    assert not [it for it in families(write_talk(tmp_path, **change)) if "launch file" in it]


def test_what_a_rubric_names_keeps_its_name() -> None:
    """The files and the <ros2_control> that criteria ask for."""
    submission = open_with_packages(str(DIFFDRIVE))
    text = (DIFFDRIVE / "urdf/diffdrive.ros2_control.xacro").read_text()
    name = text.partition('<ros2_control name="')[2].partition('"')[0]
    files = [path.rpartition("/")[2] for path in submission.whole_tree.files if "config/" in path]
    assert {*families(submission, (name, *files))} == {"spawners after an event"}
