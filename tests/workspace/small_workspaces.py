"""The small workspaces of `small_workspaces.toml`: the files of each, and of its variants."""

import tomllib
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from tests.command_line import ROOT

_TABLE = ROOT / "tests/workspace/small_workspaces.toml"
_MANIFEST = """\
<package format="3">
  <name>{name}</name><version>1.0.0</version><description>Small.</description>
  <maintainer email="a@example.com">A</maintainer><license>MIT</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
{depends}  <export><build_type>ament_cmake</build_type></export>
</package>
"""
_START = (
    "cmake_minimum_required(VERSION 3.16)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n"
)
_INSTALLED = ("config", "launch", "meshes", "rviz", "urdf", "worlds")


class SmallWorkspace(NamedTuple):
    """A workspace: its files, and what is said of it."""

    about: str
    files: dict[str, str]
    codes: tuple[str, ...]  # of which nothing may be said but `said`
    said: tuple[str, ...]  # `path:line part of the message`, each an error or a warning


def _with_build_files(files: Mapping[str, str], depends: str) -> dict[str, str]:
    """Return files with a package.xml and a CMakeLists.txt for each package that lacks one."""
    made: dict[str, str] = {}
    for name in dict.fromkeys(path.partition("/")[0] for path in files if "/" in path):
        inside = [path.removeprefix(f"{name}/") for path in files if path.startswith(f"{name}/")]
        tags = "".join(f"  <depend>{each}</depend>\n" for each in depends.split())
        made[f"{name}/package.xml"] = _MANIFEST.format(name=name, depends=tags)
        made[f"{name}/CMakeLists.txt"] = _cmake_of(name, inside)
    return {**made, **files}


def _cmake_of(name: str, inside: list[str]) -> str:
    text = _START.format(name=name)
    for path in inside:
        if path.startswith("src/") and path.endswith(".cpp"):
            program = path.removeprefix("src/").removesuffix(".cpp")
            text += f"add_executable({program} {path})\n"
            text += f"install(TARGETS {program} DESTINATION lib/${{PROJECT_NAME}})\n"
    for folder in _INSTALLED:
        if any(path.startswith(f"{folder}/") for path in inside):
            text += f"install(DIRECTORY {folder} DESTINATION share/${{PROJECT_NAME}})\n"
    return f"{text}ament_package()\n"


def _read() -> Iterator[SmallWorkspace]:
    for row in tomllib.loads(_TABLE.read_text(encoding="utf-8"))["workspace"]:
        codes, depends = tuple(row["codes"].split()), row.get("depends", "")
        files: dict[str, str] = row["files"]
        said = tuple(row.get("said", ()))
        yield SmallWorkspace(row["about"], _with_build_files(files, depends), codes, said)
        for variant in row.get("variant", ()):
            yield _variant(variant, files, codes, depends)


def _variant(
    variant: Mapping[str, Any], files: Mapping[str, str], codes: tuple[str, ...], depends: str
) -> SmallWorkspace:
    """Return a workspace in which texts are replaced in each file that has them."""
    assert any(variant["old"] in text for text in files.values()), variant["about"]
    changed = dict(files)
    for old, new in {variant["old"]: variant["new"], **variant.get("others", {})}.items():
        changed = {path: text.replace(old, new) for path, text in changed.items()}
    built = _with_build_files(changed, depends)
    return SmallWorkspace(variant["about"], built, codes, tuple(variant.get("said", ())))


SMALL_WORKSPACES = [*_read()]
