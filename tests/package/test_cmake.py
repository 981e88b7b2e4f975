"""The files that plain commands of a CMakeLists.txt install, and whether there may be others."""

import subprocess
from pathlib import Path
from shutil import which

import pytest

from grader.package import cmake as reader
from grader.package.cmake import CMake
from tests.checks.submissions import Submitted
from tests.command_line import HANG_TIMEOUT
from tests.work import limited_work

FILES = ("CMakeLists.txt", "meshes/hull.stl", "meshes/fine/hull.stl", "urdf/arm.urdf", "launch/arm.launch.py")
MESHES = {"share/arm/meshes/hull.stl": "meshes/hull.stl", "share/arm/meshes/fine/hull.stl": "meshes/fine/hull.stl"}
HULL = {"share/arm/hull.stl": "meshes/hull.stl"}
START = """\
cmake_minimum_required(VERSION 3.8)  # install(FILES meshes/hull.stl DESTINATION share)
project(arm)
find_package(ament_cmake REQUIRED)
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  ament_lint_auto_find_test_dependencies()
endif()
"""


def read_cmake(text: str) -> CMake:
    """Return what a CMakeLists.txt with this text installs."""
    files = Submitted({**dict.fromkeys(FILES, ""), "CMakeLists.txt": text})
    return reader.read_cmake(files.submission.whole_tree)


@pytest.mark.parametrize(
    ("text", "installed"),
    [
        ("install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})", MESHES),
        ("INSTALL(\n  DIRECTORY\n  meshes\n  DESTINATION share/${PROJECT_NAME}/\n)", MESHES),
        ('install(DIRECTORY "meshes" DESTINATION "share/${PROJECT_NAME}")', MESHES),
        ("install(DIRECTORY ${CMAKE_CURRENT_SOURCE_DIR}/meshes DESTINATION share/arm)", MESHES),
        ("install(DIRECTORY meshes/ DESTINATION share/arm/meshes)", MESHES),
        ("set(WHERE share/${PROJECT_NAME})\ninstall(DIRECTORY meshes DESTINATION ${WHERE})", MESHES),
        ("ament_auto_package(INSTALL_TO_SHARE meshes)", MESHES),
        ("install(FILES meshes/hull.stl DESTINATION share/arm)", HULL),
        ("install(DIRECTORY mesh DESTINATION share/arm)", {}),
        ("#[[\ninstall(DIRECTORY meshes DESTINATION share/arm)\n]]", {}),
        ("install(TARGETS arm_node DESTINATION lib/arm)", {}),
        ("", {}),
    ],
)
def test_plain_commands(text: str, installed: dict[str, str]) -> None:
    """What they install is certain, and nothing else is installed."""
    cmake = read_cmake(f"{START}{text}\nament_package()\n")
    assert (cmake.installed, cmake.is_certain) == (installed, True)


def test_several_folders() -> None:
    """The usual entry of a description package."""
    text = "install(\n  DIRECTORY urdf meshes launch\n  DESTINATION share/${PROJECT_NAME}\n)\n"
    assert read_cmake(START + text).installed.keys() == {f"share/arm/{path}" for path in FILES[1:]}


@pytest.mark.parametrize(
    "text",
    [
        "if(WITH_MESHES)\n  install(DIRECTORY meshes DESTINATION share/arm)\nendif()",
        "foreach(folder meshes urdf)\n  install(DIRECTORY ${folder} DESTINATION share/arm)\nendforeach()",
        "function(put)\n  install(DIRECTORY meshes DESTINATION share/arm)\nendfunction()",
        "file(GLOB found meshes/*)\ninstall(FILES ${found} DESTINATION share/arm)",
        "set(folders meshes urdf)\ninstall(DIRECTORY ${folders} DESTINATION share/arm)",
        "set(W share/arm)\nif(X)\n  set(W lib)\nendif()\ninstall(DIRECTORY meshes DESTINATION ${W})",
        'install(DIRECTORY meshes DESTINATION share/arm PATTERN "*.stl" EXCLUDE)',
        "install(FILES meshes/hull.stl DESTINATION share/arm RENAME arm.stl)",
        "install(DIRECTORY ../meshes DESTINATION share/arm)",
        "return()\ninstall(DIRECTORY meshes DESTINATION share/arm)",
        "include(more.cmake)",
        "add_subdirectory(meshes)",
        "install(CODE [[ install(DIRECTORY meshes DESTINATION share/arm) ]])",
        "install(DIRECTORY meshes DESTINATION $<1:share/arm>)",
    ],
)
def test_other_commands(text: str) -> None:
    """What depends on a condition, a loop or another file is not followed, and may install anything."""
    cmake = read_cmake(f"{START}{text}\n")
    assert (cmake.installed, cmake.is_certain) == ({}, False)


@pytest.mark.parametrize(
    "text", ["install(", ")))(((", "install(DIRECTORY", '"', "install()", "set()", "\0" * 100, "[" * 99]
)
def test_odd_texts(text: str) -> None:
    """Nothing breaks the reader."""
    assert read_cmake(text).installed == {}


def test_a_long_text_takes_little_time() -> None:
    """Comments that do not end are read once; a file that is too large is not read."""
    with limited_work(5_000):
        assert read_cmake("#[[\n" * 30_000).installed == {}
        assert read_cmake("#[[" * 30_000 + '"(' * 9_000).installed == {}
    assert not read_cmake("#" * 200_000).is_certain


@pytest.mark.skipif(which("cmake") is None, reason="CMake is not installed")
def test_cmake_installs_the_same(tmp_path: Path) -> None:
    """CMake itself is the oracle for the commands that are followed."""
    text = """\
cmake_minimum_required(VERSION 3.8)
project(arm NONE)
set(A share/${PROJECT_NAME}/a)  # a comment
#[[ install(DIRECTORY launch DESTINATION share/none) ]]
install(DIRECTORY meshes urdf DESTINATION ${A})
install(DIRECTORY meshes/ DESTINATION share/arm/b/)
install(DIRECTORY "meshes/fine" DESTINATION "share/c")
INSTALL(DIRECTORY ./meshes/../urdf/ DESTINATION share/${CMAKE_PROJECT_NAME}/d)
install(FILES urdf/arm.urdf ${CMAKE_CURRENT_SOURCE_DIR}/meshes/hull.stl DESTINATION share/e)
install(PROGRAMS launch/arm.launch.py DESTINATION lib/${PROJECT_NAME})
"""
    source, prefix = tmp_path / "source", tmp_path / "prefix"
    for path in FILES:
        (source / path).parent.mkdir(parents=True, exist_ok=True)
        (source / path).write_text(text if path == "CMakeLists.txt" else "", encoding="utf-8")
    for command in (
        ("cmake", "-S", source, "-B", tmp_path / "build", f"-DCMAKE_INSTALL_PREFIX={prefix}"),
        ("cmake", "--install", tmp_path / "build"),
    ):
        subprocess.run(command, check=True, capture_output=True, timeout=HANG_TIMEOUT)
    found = {path.relative_to(prefix).as_posix() for path in prefix.rglob("*") if path.is_file()}
    cmake = read_cmake(text)
    assert cmake.installed.keys() == found
    assert cmake.is_certain
