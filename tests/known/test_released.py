"""The packages that are released, and the script that reads them."""

import json
import lzma
import subprocess
from pathlib import Path

import pytest

from grader.ros.known.released import (
    RELEASED_FILE,
    is_released,
    packages_brought_by,
    released_date,
    released_packages,
    rosdep_keys,
)
from grader.ros.known.rosdep_words import rosdep_words
from tests.known.make_released import make_released

_DISTRIBUTION = """
repositories:
  arms:
    release: {packages: [arms, arms_core, arms_tools, arms_msgs], version: 1.0.0-1}
    source: {type: git}
  one: {release: {version: 2.0.0-1}}
  unreleased: {source: {type: git}}
"""


def test_the_file_says_what_it_is_of() -> None:
    """It has a source with its date and commit, and the notice of the licence, which is beside it."""
    data = json.loads(lzma.decompress(RELEASED_FILE.read_bytes()))
    assert data["source"] == "ros/rosdistro"
    assert len(data["commit"]) == 40
    assert released_date() == data["date"]
    licence = RELEASED_FILE.with_name("rosdistro_license.txt").read_text(encoding="utf-8")
    assert "Copyright (c) Open Source Robotics Foundation, Inc." in licence
    assert "rosdistro_license.txt" in data["notice"]
    assert RELEASED_FILE.stat().st_size < 40_000


def test_packages_and_their_releases() -> None:
    """A package has the releases that have it; a misspelt one is none."""
    assert is_released("nav2_bringup")
    assert is_released("nav2_bringup", ["jazzy"])
    assert not is_released("gazebo_ros_pkgs", ["lyrical"])
    assert not is_released("nav2_bringupp")


def test_what_a_metapackage_brings() -> None:
    """It is what is called after it, or the whole repository; a package with code brings nothing."""
    assert {"canopen_core", "canopen_402_driver"} <= packages_brought_by("canopen")
    assert "nav2_amcl" in packages_brought_by("navigation2")
    assert packages_brought_by("joint_state_publisher") == frozenset()
    assert packages_brought_by("no_such_package") == frozenset()


def test_keys_of_rosdep() -> None:
    """What people write instead is no key, and what is written instead of it is one, or a package."""
    known = {*rosdep_keys(), *released_packages()}
    assert known.isdisjoint({*rosdep_words().instead, *rosdep_words().elsewhere})
    assert known.issuperset(rosdep_words().instead.values())


def test_keys_of_libraries() -> None:
    """Modules and libraries have keys, and what installs one is a package."""
    words = rosdep_words()
    of_libraries = {*words.modules.values(), *words.libraries.values()}
    assert rosdep_keys() >= of_libraries >= words.brought.keys()
    for packages in words.brought.values():
        assert packages <= {*released_packages()}


def _git(folder: Path, *arguments: str) -> None:
    identity = ("-c", "user.name=Kim", "-c", "user.email=kim@example.org")
    subprocess.run(["git", *identity, *arguments], cwd=folder, check=True, capture_output=True)


@pytest.mark.slow
def test_the_script_reads_what_has_a_version(tmp_path: Path) -> None:
    """A repository without a list of packages has one, and one without a version is not released."""
    for release in ("foxy", "galactic", "humble", "iron", "jazzy", "kilted", "lyrical", "rolling"):
        (tmp_path / release).mkdir()
        text = _DISTRIBUTION if release != "foxy" else "repositories: {}\n"
        (tmp_path / release / "distribution.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "rosdep").mkdir()
    for name, text in (("base", "eigen: {}"), ("python", "python3-numpy: {}"), ("ruby", "{}")):
        (tmp_path / f"rosdep/{name}.yaml").write_text(text, encoding="utf-8")
    _git(tmp_path, "init", "-q")
    _git(tmp_path, "add", ".")
    _git(tmp_path, "commit", "-q", "-m", "All")
    data = json.loads(lzma.decompress(make_released(str(tmp_path))))
    assert data["metapackages"] == "arms"
    assert data["rosdep"] == "eigen python3-numpy"
    since = "galactic humble iron jazzy kilted lyrical rolling"
    assert data["repositories"] == {
        "arms": {since: "arms arms_core arms_msgs arms_tools"},
        "one": {since: "one"},
    }
