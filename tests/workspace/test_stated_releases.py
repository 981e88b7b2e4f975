"""Which releases of ROS 2 the files of a workspace state."""

from pathlib import Path

import pytest

from grader.files.folder import read_folder
from grader.files.opening import open_tree
from grader.files.tree import make_tree, overlaid
from grader.lab.submission.opening import make_submission
from grader.lab.submission.submission import Lab
from grader.ros.known.releases import RELEASES, Release, StatedReleases, other_name
from grader.workspace.model.stated_releases import stated_releases
from grader.workspace.rules.reading import read_agreement
from tests.command_line import run

pytestmark = pytest.mark.slow

_STATED = [
    ("Dockerfile", "FROM ros:humble-ros-base", "humble"),
    ("docker/Dockerfile.dev", "ARG ROS_DISTRO=jazzy\nFROM ros:${ROS_DISTRO}", "jazzy"),
    ("Dockerfile", 'ENV ROS_DISTRO "iron"', "iron"),
    ("Dockerfile", "RUN apt-get install ros-foxy-xacro", "foxy"),
    ("Dockerfile", "# FROM ros:humble\nFROM osrf/ros:jazzy-desktop", "jazzy"),
    ("Dockerfile", "FROM ubuntu:22.04", "humble iron"),
    ("compose.yaml", "image: osrf/ros:kilted-desktop", "kilted"),
    (".github/workflows/ci.yml", "with:\n  required-ros-distributions: galactic", "galactic"),
    (".github/workflows/ci.yml", "with:\n  target-ros2-distro: rolling", "rolling"),
    (
        ".github/workflows/ci.yml",
        "ROS_DISTRO: [rolling, lyrical, kilted]",
        "kilted lyrical rolling",
    ),
    (
        ".github/workflows/ci.yml",
        "ros_distribution:\n  # - humble\n  - iron\n  - jazzy",
        "iron jazzy",
    ),
    (".github/workflows/ci.yml", "env: {ROS_DISTRO: humble, ROS_REPO: main}", "humble"),
    (".gitlab-ci.yml", "script: source /opt/ros/humble/setup.bash", "humble"),
    (".devcontainer/pc/devcontainer.json", '{"image": "lab/fhtw-ros:iron-base"}', "iron"),
    ("docker/.env", "ROS_DISTRO=humble\n", "humble"),
    ("README.md", "Tested with ROS 2 Humble & Iron.", "humble iron"),
    ("README.md", "# ros2_foxy", "foxy"),
    ("README.md", "| ROS2 | Foxy |", "foxy"),
    ("README.md", "- ROS 2 [Galactic](https://example.org)", "galactic"),
    ("README.md", "![](https://img.shields.io/badge/ROS_2-Kilted_%7C_Jazzy-blue)", "jazzy kilted"),
    ("README.md", "![](https://img.shields.io/ros/v/jazzy/rclcpp)", "jazzy"),
    ("README.md", "https://index.ros.org/p/joy/#foxy and https://docs.ros.org/en/foxy", "foxy"),
    ("README.md", "Jazzy Jalisco on Ubuntu 24.04", "jazzy"),
    ("README.md", "For Lyrical Luth on Ubuntu 26.04 (Resolute).", "lyrical"),
    ("README.md", "https://docs.ros.org/en/lyrical/Tutorials.html", "lyrical"),
    ("Dockerfile", "FROM osrf/ros:lyrical-desktop-full", "lyrical"),
    ("Dockerfile", "FROM ubuntu:26.04", "lyrical"),
    ("Dockerfile", "FROM ubuntu:resolute", "lyrical"),
    ("run.sh", "source /opt/ros/lyrical/setup.bash", "lyrical"),
    ("README.md", "For ROS 2 Lyrical. Ported from ROS 2 Jazzy.", "lyrical"),
    ("README.md", "This package was ported\nfrom ROS 2 Jazzy to Lyrical.", "lyrical"),
    ("README.md", "Migrated the launch files from Humble to ROS 2 Lyrical", "lyrical"),
    ("README.md", "Originally written for ROS 2 Humble; needs ROS 2 Kilted.", "kilted"),
    ("README.md", "Copied from a lab for ROS 2 Jazzy.", "jazzy"),
    ("README.md", "Ported from ROS 1.\n\nTested with ROS 2 Jazzy.", "jazzy"),
    ("README.md", "Made with ROS2 Jazzy. For ROS2 Humble, see the **humble** branch.", "jazzy"),
    ("README.md", "An iron robot with a rolling base on Ubuntu 22.04", ""),
    ("README.md", "See https://example.org/tree/humble/docs", ""),
    ("README.md", "For ROS 2 Lyrical.\n\n- 2021-06: first cart (ROS2 Foxy)", "lyrical"),
    ("README.md", "* 2026-06: ROS 2 Jazzy\n* 2021: ROS 2 Foxy", "jazzy"),
    ("src/nav/README.md", "For ROS 2 Humble.", "humble"),
    ("scripts/run.sh", "source /opt/ros/humble/setup.bash", "humble"),
    ("src/nav/nav/node.py", "# ROS 2 Humble", ""),
]


@pytest.mark.parametrize(("path", "text", "expected"), _STATED)
def test_a_file_states_releases(path: str, text: str, expected: str, tmp_path: Path) -> None:
    """Comments and names of branches state none."""
    for name, content in {path: text, "src/nav/package.xml": "<package/>"}.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(content, encoding="utf-8")
    found = stated_releases(read_folder(tmp_path))
    assert found.releases == tuple(expected.split())
    assert found.places == ((path,) if expected else ())


def test_what_builds_the_workspace_is_stronger_than_other_texts() -> None:
    """The first README counts beside containers; those below, pages and scripts do not."""
    texts = {
        "Dockerfile": "FROM ros:humble",
        "README.md": "ROS 2 Jazzy",
        "docs/old.md": "ROS 2 Foxy",
        "src/driver/README.md": "ROS 2 Galactic",
        "run.sh": "source /opt/ros/iron/setup.sh",
    }
    tree = overlaid(make_tree("ws", (), ()), {path: it.encode() for path, it in texts.items()})
    found = stated_releases(tree)
    assert found == StatedReleases(("humble", "jazzy"), ("Dockerfile", "README.md"))
    assert found.words == "release: humble or jazzy (Dockerfile and README.md)"


def test_a_workflow_of_another_branch_counts_where_nothing_else_states_a_release(
    tmp_path: Path,
) -> None:
    """A project on many releases has a workflow for each of its branches."""
    (tmp_path / ".github" / "workflows").mkdir(parents=True)
    old, new = (tmp_path / ".github" / "workflows" / name for name in ("old.yml", "new.yml"))
    old.write_text("on: {push: {branches: [humble]}}\nenv:\n  ROS_DISTRO: humble\n")
    assert stated_releases(read_folder(tmp_path)).releases == ("humble",)
    new.write_text("on: {push: {branches: [main]}}\nenv:\n  ROS_DISTRO: kilted\n")
    assert stated_releases(read_folder(tmp_path)).releases == ("kilted",)


def test_no_symlink_is_followed_to_a_release(tmp_path: Path) -> None:
    """Neither a folder nor a file of settings leads out of the workspace."""
    outside, workspace = tmp_path / "outside", tmp_path / "ws"
    (outside / "workflows").mkdir(parents=True)
    (outside / "workflows" / "ci.yml").write_text("ROS_DISTRO: humble\n")
    (workspace / ".devcontainer").mkdir(parents=True)
    (workspace / ".github").symlink_to(outside)
    (workspace / ".devcontainer" / "a.json").symlink_to(outside / "workflows" / "ci.yml")
    tree = open_tree(workspace)
    assert tree is not None
    assert not list(tree.settings())
    assert stated_releases(tree) == StatedReleases()


def test_a_name_is_said_to_be_another_one_from_a_release_on_or_until_one() -> None:
    """A name without a counterpart is not there; without a release, every name is right."""
    jazzy = other_name("plugin", "nav2_recoveries/Spin", ["jazzy"])
    assert jazzy is not None
    assert jazzy.message == "'nav2_recoveries/Spin' is 'nav2_behaviors::Spin' from Jazzy on"
    foxy = other_name("package", "nav2_smoother", ["foxy"])
    assert foxy is not None
    assert foxy.message == "there is no package 'nav2_smoother' before Humble"
    assert other_name("package", "gazebo_ros", ["jazzy", "iron"]) is None
    assert other_name("package", "gazebo_ros", []) is None
    assert all(other_name("package", "rviz2", [release]) is None for release in RELEASES)


@pytest.mark.parametrize(("distro", "wrong"), [("humble", 0), ("jazzy", 1), (None, 1)])
def test_names_are_compared_with_the_release_of_a_rubric(
    distro: Release | None, wrong: int
) -> None:
    """Of two forms in one file, that of a later release only is no mistake where it is not used."""
    texts = {
        "src/nav/package.xml": "<package format='3'><name>nav</name></package>",
        "src/nav/config/nav2.yaml": (
            "behavior_server:\n  ros__parameters:\n    spin:\n      plugin: nav2_behaviors::Spin\n"
            "    wait:\n      plugin: nav2_behaviors/Wait\n"
        ),
    }
    tree = overlaid(make_tree("ws", (), ()), {path: it.encode() for path, it in texts.items()})
    submission = make_submission(tree, "ws", Lab("robot.urdf", distro=distro))
    found = read_agreement(submission.workspace).mismatches
    assert sum(it.is_certain for it in found) == wrong


@pytest.mark.parametrize(("release", "is_known"), [("foxy", True), ("humble", False)])
def test_nodes_of_a_release_have_its_attributes(
    release: str, tmp_path: Path, *, is_known: bool
) -> None:
    """set_parameters_callback was removed in Galactic."""
    texts = {
        "cart/package.xml": "<package format='3'><name>cart</name></package>",
        "cart/CMakeLists.txt": "project(cart)\nfind_package(ament_cmake)\n"
        "install(PROGRAMS tuner.py DESTINATION lib/cart)\nament_package()\n",
        "cart/tuner.py": "#!/usr/bin/env python3\nimport rclpy\nfrom rclpy.node import Node\n\n\n"
        "class Tuner(Node):\n    def __init__(self):\n        super().__init__('tuner')\n"
        "        self.set_parameters_callback(print)\n\n\nrclpy.init()\nrclpy.spin(Tuner())\n",
        "README.md": f"For ROS 2 {release.title()}.",
    }
    for path, text in texts.items():
        (tmp_path / path).parent.mkdir(exist_ok=True)
        (tmp_path / path).write_text(text)
    said = run(("inspect", tmp_path, "--format", "concise")).stdout.decode()
    assert ("Tuner has no attribute set_parameters_callback" in said) is not is_known
