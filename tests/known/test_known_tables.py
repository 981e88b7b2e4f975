"""When the tables were read, and the script that compares them with upstream."""

import subprocess
from pathlib import Path, PurePath

import pytest

from grader.ros.known.known_tables import known_tables, releases_explanation
from grader.ros.known.package_files import FOLDER
from grader.ros.known.releases import RELEASES
from tests.known.compare_upstream import differences

_ROS = FOLDER.parents[1]  # grader/ros
_NOT_FACTS = ("known/index.toml", "known/tables.toml")  # made of others


def test_each_file_of_facts_says_when_it_was_read() -> None:
    """Each is of a table, each table has files, and the command shows all."""
    files = [*_ROS.glob("known/**/*.toml"), *_ROS.glob("launch/*.json"), *_ROS.glob("known/*.xz")]
    paths = {path.relative_to(_ROS).as_posix() for path in files} - {*_NOT_FACTS}
    for table in known_tables():
        of_table = {path for path in paths if any(map(PurePath(path).match, table.files))}
        assert of_table, table.name
        paths -= of_table
        assert (
            f"{table.name}\n  Up to {table.until.title()}, read in {table.read}"
            in releases_explanation()
        )
    assert not paths
    assert all(release.title() in releases_explanation() for release in RELEASES)


def _git(folder: Path, *arguments: str) -> None:
    identity = ("-c", "user.name=Kim", "-c", "user.email=kim@example.org")
    subprocess.run(["git", *identity, *arguments], cwd=folder, check=True, capture_output=True)


@pytest.mark.exhaustive
def test_a_change_upstream_is_printed(tmp_path: Path) -> None:
    """A package that is released, a parameter that is new, one that is gone, and a branch that is not there."""
    nav2, distro = tmp_path / "navigation2", tmp_path / "rosdistro"
    source = nav2 / "nav2_smoother/src/simple_smoother.cpp"
    for folder in (source.parent, distro / "lyrical"):
        folder.mkdir(parents=True)
    _git(nav2, "init", "-q", "-b", "kilted")
    source.write_text('node->declare_parameter(name + ".tolerance", 1e-10);\n// "not_this"\n')
    _git(nav2, "add", ".")
    _git(nav2, "commit", "-q", "-m", "Kilted")
    _git(nav2, "checkout", "-q", "-b", "lyrical")
    source.write_text('node->declare_parameter(\n  name + ".max_bumps", 3);\n')
    _git(nav2, "commit", "-q", "-a", "-m", "Lyrical")
    _git(distro, "init", "-q", "-b", "master")
    (distro / "lyrical/distribution.yaml").write_text(
        "repositories:\n  a: {release: {version: 1.0.0-1, packages: [actionlib_msgs]}}\n"
    )
    _git(distro, "add", ".")
    _git(distro, "commit", "-q", "-m", "Lyrical")
    lines = [*differences([str(nav2), str(distro)], "lyrical")]
    assert ("lyrical", "navigation2: nav2_smoother declares max_bumps, of which no row is") in lines
    gone = "navigation2: nav2_smoother does not declare tolerance any more, of which a row is"
    assert ("lyrical", gone) in lines
    lacks = "rosdistro: releases.toml lacks the package actionlib_msgs, which is released"
    assert ("lyrical", lacks) in lines
    assert ("rolling", "ros-navigation/navigation2 has no branch of it: not compared") in lines
    assert not any("not_this" in text for _, text in lines)
