"""The files that the usual entry of a CMakeLists.txt installs."""

import subprocess
from pathlib import Path
from shutil import which

import pytest

from grader.package.cmake import installs
from tests.checks.submissions import Submitted
from tests.command_line import HANG_TIMEOUT
from tests.work import limited_work

FILES = ("CMakeLists.txt", "meshes/hull.stl", "meshes/fine/hull.stl", "urdf/arm.urdf", "launch/arm.launch.py")
START = """\
cmake_minimum_required(VERSION 3.8)  # install(FILES meshes/hull.stl DESTINATION share)
project(arm)
find_package(ament_cmake REQUIRED)
if(BUILD_TESTING)
  find_package(ament_lint_auto REQUIRED)
  ament_lint_auto_find_test_dependencies()
endif()
"""


def is_installed(text: str) -> bool:
    """Return whether a package with this CMakeLists.txt certainly installs meshes/fine/hull.stl where it is."""
    files = Submitted({**dict.fromkeys(FILES, ""), "CMakeLists.txt": text})
    return installs(files.submission.whole_tree, "arm", "meshes/fine/hull.stl")


@pytest.mark.parametrize(
    "text",
    [
        "install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})",
        "INSTALL(\n  DIRECTORY\n  meshes\n  DESTINATION share/${PROJECT_NAME}/\n)",
        'install(DIRECTORY "meshes" DESTINATION "share/${PROJECT_NAME}")',
        "install(DIRECTORY meshes/ DESTINATION share/${PROJECT_NAME}/meshes)",
        "install(\n  DIRECTORY urdf meshes launch\n  DESTINATION share/${PROJECT_NAME}\n)",
    ],
)
def test_the_usual_entry(text: str) -> None:
    """The entry of a description package installs its folders."""
    assert is_installed(f"{START}{text}\nament_package()\n")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "install(DIRECTORY urdf DESTINATION share/${PROJECT_NAME})",
        "install(DIRECTORY meshes DESTINATION share)",
        "install(DIRECTORY meshes/ DESTINATION share/${PROJECT_NAME})",
        "#[[\ninstall(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})\n]]",
        "# install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})",
        "if(WITH_MESHES)\n  install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})\nendif()",
        "function(put)\n  install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})\nendfunction()",
        'install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME} PATTERN "*.stl" EXCLUDE)',
        "return()\ninstall(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})",
        "install(CODE [[ install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME}) ]])",
        "install(DIRECTORY\n meshes DESTINATION share/${PROJECT_NAME}",
    ],
)
def test_other_commands(text: str) -> None:
    """Nothing is certain of what depends on a condition, a loop or another file."""
    assert not is_installed(f"{START}{text}\n")
    assert not is_installed("install(DIRECTORY meshes DESTINATION share/${PROJECT_NAME})")


def test_a_long_text_takes_little_time() -> None:
    """Comments and commands that do not end are read once; a file that is too large is not read."""
    with limited_work(20_000):
        for text in ("#[[\n" * 30_000, "#[[" * 30_000 + '"(' * 9_000, "install(DIRECTORY " * 7_000, "\n" * 120_000):
            assert not is_installed(text)
    assert not is_installed("#" * 200_000)


@pytest.mark.skipif(which("cmake") is None, reason="CMake is not installed")
def test_cmake_installs_the_same(tmp_path: Path) -> None:
    """CMake itself is the oracle for the entry."""
    text = (
        "cmake_minimum_required(VERSION 3.8)\nproject(arm NONE)\n"
        "install(DIRECTORY urdf meshes DESTINATION share/${PROJECT_NAME})\n"
    )
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
    assert "share/arm/meshes/fine/hull.stl" in found
    assert is_installed(text)
