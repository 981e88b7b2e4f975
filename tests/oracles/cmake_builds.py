"""What CMake installs of a package, with `ament.cmake` in the place of ROS 2, and what the grader says of it."""

import os
import re
import subprocess
from pathlib import Path
from typing import NamedTuple

import cmake

from grader.ros.installation.installation import Installation
from tests.differential.colcons import package_in

STUB = Path(__file__).with_name("ament.cmake")
PROGRAM = Path(cmake.CMAKE_BIN_DIR) / "cmake"
PROJECT = re.compile(r"^\s*project\s*\(\s*([^\s)]+)[^)]*\)", re.IGNORECASE | re.MULTILINE)


class Built(NamedTuple):
    """Whether a build succeeds, and the files below the prefix."""

    error: str
    files: frozenset[str]


def build(package: Path, scratch: Path) -> Built:
    """Return what CMake does with a package. Its CMakeLists.txt is changed so that no compiler is needed."""
    file = package / "CMakeLists.txt"
    file.write_text(PROJECT.sub(r"project(\1 NONE)", file.read_text(errors="replace")))
    prefix = scratch / "install"
    options = [
        f"-DCMAKE_INSTALL_PREFIX={prefix}",
        f"-DCMAKE_PROJECT_INCLUDE={STUB}",
        "-DBUILD_TESTING=OFF",
        "-DCMAKE_MAKE_PROGRAM=/bin/true",
        "-DCMAKE_COMPILER_IS_GNUCXX=1",
        "-DCMAKE_CXX_COMPILER_ID=GNU",
        "-DCMAKE_CXX_COMPILER_VERSION=13.2.0",
    ]
    commands = (
        [
            str(PROGRAM),
            "-S",
            str(package),
            "-B",
            str(scratch / "build"),
            "-G",
            "Unix Makefiles",
            *options,
        ],
        [str(PROGRAM), "--install", str(scratch / "build")],
    )
    around = {**os.environ, "ROS_DISTRO": "jazzy", "ROS_VERSION": "2"}
    for command in commands:
        done = subprocess.run(command, env=around, capture_output=True, text=True, check=False)
        if done.returncode:
            return Built(done.stderr or "an error", frozenset())
    return Built(
        "", frozenset(str(it.relative_to(prefix)) for it in prefix.rglob("*") if it.is_file())
    )


def read(package: Path) -> Installation:
    """Return what the grader says of a package."""
    found = package_in(package).installation
    assert found is not None
    return found


def difference(found: Installation, built: Built) -> str:
    """Return how an installation differs from a build; empty if it agrees, or leaves the difference open."""
    if found.fault is not None or found.stops:
        reason = found.fault_text or found.stops[0].message
        return "" if built.error else f"it builds, but: {reason}"
    if built.error:
        return "" if found.doubt is not None else f"it does not build: {built.error}"
    files = {*found.installed(), *found.programs}
    if not (files <= built.files if found.unknown else files == built.files):
        return f"more: {sorted(files - built.files)}, less: {sorted(built.files - files)}"
    return ""
