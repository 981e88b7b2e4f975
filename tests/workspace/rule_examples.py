"""The examples of rules, as the files of a package."""

import re
import tomllib
from collections.abc import Mapping
from pathlib import PurePosixPath
from textwrap import indent
from typing import Any, NamedTuple

from grader.workspace.rules.rule_table import RULES
from tests.command_line import ROOT

FRAMES: dict[str, str] = tomllib.loads(
    (ROOT / "docs/examples/frames.toml").read_text(encoding="utf-8")
)
EXAMPLES: dict[str, dict[str, Any]] = {rule.name: rule._asdict() for rule in RULES.values()}
_PLACEHOLDER = re.compile(r"(?m)^( *)EXAMPLE$")
_FOLDERS = {
    ".launch.py": "launch",
    ".py": "rover",
    ".urdf": "urdf",
    ".xacro": "urdf",
    ".rviz": "rviz",
    ".yaml": "config",
    ".srdf": "config",
    ".pgm": "config",
    ".sdf": "worlds",
    ".msg": "msg",
    ".obj": "meshes",
    ".cpp": "src",
}
_OF_ROOT = ("setup.py", "package.xml", "CMakeLists.txt")
_KEPT = ("scripts", "crate", "tools")  # folders that are part of the place of a file
_MANIFEST = """\
<package format="3">
  <name>rover</name>
  <version>1.0.0</version>
  <description>A rover.</description>
  <maintainer email="a@example.com">A</maintainer>
  <license>MIT</license>
  <export><build_type>ament_python</build_type></export>
</package>
"""
_FOLDERS_INSTALLED = ("launch", "urdf", "rviz", "config", "worlds", "meshes", "crate")


class ExampleFiles(NamedTuple):
    """The files of a package with one side of an example."""

    files: dict[str, str]  # by their paths in the package
    path: str  # of the file with the example
    lines: range  # of the example


def files_of_rule(name: str, side: str) -> ExampleFiles:
    """Return the package that the wrong or right side of the example of a rule is in."""
    return files_of_example(EXAMPLES[name], side)


def files_of_example(example: Mapping[str, Any], side: str) -> ExampleFiles:
    """Return the package that one side of an example is in."""
    frame = example.get("frame", next(iter(FRAMES)))
    text, lines = _framed(frame, example[side].strip("\n"))
    path = _path_of(frame)
    files = {path: text}
    for other, content in example.get("beside", {}).items():
        files[_path_of(other)] = _framed(other, content.strip("\n"))[0]
    if not any(each.startswith("urdf/") for each in files):
        files["urdf/rover.urdf"] = '<robot name="rover"><link name="base_link"/></robot>\n'
    modules = [PurePosixPath(each) for each in files]
    programs = [each.stem for each in modules if str(each.parent) in ("rover", "src")]
    if not any(each.startswith("launch/") for each in files):
        nodes = "\n".join(f"Node(package='rover', executable='{each}')," for each in programs)
        files["launch/rover.launch.py"] = _framed("rover.launch.py", nodes)[0]
    if "CMakeLists.txt" in files:
        return _in_workspace(ExampleFiles(files, path, lines))
    folders = {each.partition("/")[0] for each in files}
    around = {
        "package.xml": _MANIFEST,
        "setup.py": _setup(programs, folders),
        "setup.cfg": "[install]\ninstall_scripts=$base/lib/rover\n",
        "resource/rover": "",
        "rover/__init__.py": "",
        "rviz/rover.rviz": "Visualization Manager:\n  Displays: []\n",
    }
    return _in_workspace(ExampleFiles({**around, **files}, path, lines))


def _in_workspace(example: ExampleFiles) -> ExampleFiles:
    """Return an example as a workspace, if it has files of another package: ../arm/package.xml."""
    if not any(path.startswith("../") for path in example.files):
        return example
    files = {}
    for path, text in example.files.items():
        files[path.removeprefix("../") if path.startswith("../") else f"rover/{path}"] = text
    return example._replace(files=files, path=f"rover/{example.path}")


def _framed(frame: str, text: str) -> tuple[str, range]:
    """Return a file with a text in a frame, and the lines of the text."""
    parts = _PLACEHOLDER.split(FRAMES.get(frame, "EXAMPLE\n"))
    if len(parts) == 1:
        return parts[0], range(1, 1)
    before, space, after = parts
    first = before.count("\n") + 1
    return before + indent(text, space) + after, range(first, first + text.count("\n") + 1)


def _path_of(frame: str) -> str:
    """Return the path in the package of the file of a frame."""
    place = PurePosixPath(frame)
    if frame.startswith("../"):
        return frame
    if place.name in _OF_ROOT or frame.startswith("./"):
        return place.name
    if place.parent.name in _KEPT:
        return frame
    folder = next(folder for ending, folder in _FOLDERS.items() if frame.endswith(ending))
    return f"{folder}/{place.name}"


def _setup(programs: list[str], folders: set[str]) -> str:
    """Return a setup.py that installs the programs, and the files in folders."""
    installed = ["('share/ament_index/resource_index/packages', ['resource/rover'])"]
    installed.append("('share/rover', ['package.xml'])")
    for folder in sorted({"rviz", *folders.intersection(_FOLDERS_INSTALLED)}):
        installed.append(f"('share/rover/{folder}', glob('{folder}/*'))")
    entries = [f"'{name} = rover.{name}:main'" for name in programs]
    return (
        "from glob import glob\n\nfrom setuptools import setup\n\nsetup(\n    name='rover',\n"
        f"    version='1.0.0',\n    packages=['rover'],\n    data_files=[{', '.join(installed)}],\n"
        f"    entry_points={{'console_scripts': [{', '.join(entries)}]}},\n)\n"
    )


_VARIANTS = ROOT / "tests/workspace/rule_variants.toml"
VARIANTS: list[dict[str, Any]] = tomllib.loads(_VARIANTS.read_text(encoding="utf-8"))["variant"]


def files_of_variant(variant: Mapping[str, Any]) -> dict[str, str]:
    """Return the package that a variant of an example is in."""
    example = EXAMPLES[variant["of"]]
    given = {name: variant[name] for name in ("frame",) if name in variant}
    beside = {**example.get("beside", {}), **variant.get("beside", {})}
    text = variant.get("text", example["wrong"])
    return files_of_example({**example, **given, "beside": beside, "wrong": text}, "wrong").files
