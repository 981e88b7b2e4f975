"""Write what Python has by version: `python -m tests.known.make_python_names PYTHON...`.

The arguments are interpreters of the versions that the releases of ROS 2 run with, oldest first, on Linux. Each lists its modules
and names itself. An argument may have words, such as `chroot FOLDER python3.14`. The names stand in
`grader/ros/known/python_names.toml`. Private names are omitted, except those of builtins: no documentation has them.
"""

import json
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import tomli

from grader.ros.known.python_names import PYTHON_NAMES_FILE, python_names

# Modules whose names launch files and setup.py import.
LISTED = [
    "__future__",
    "abc",
    "argparse",
    "builtins",
    "codecs",
    "collections",
    "configparser",
    "contextlib",
    "copy",
    "csv",
    "dataclasses",
    "datetime",
    "enum",
    "errno",
    "fnmatch",
    "functools",
    "getpass",
    "glob",
    "hashlib",
    "importlib",
    "inspect",
    "io",
    "itertools",
    "json",
    "logging",
    "math",
    "operator",
    "os",
    "os.path",
    "pathlib",
    "platform",
    "random",
    "re",
    "shlex",
    "shutil",
    "signal",
    "socket",
    "stat",
    "statistics",
    "string",
    "subprocess",
    "sys",
    "tempfile",
    "textwrap",
    "threading",
    "time",
    "traceback",
    "types",
    "typing",
    "uuid",
    "warnings",
    "xml.dom.minidom",
    "xml.etree.ElementTree",
]
# It runs in each interpreter, so it is written for Python 3.8. What a module defines by __getattr__ is not in dir(), so that it
# is asked for each name that another version has. A path is evaluated as a PurePosixPath, and is a PosixPath where it runs. Debian has tkinter in a package of its own.
_PROGRAM = f"""
import collections.abc, importlib, importlib.util, io, json, os, pathlib, pkgutil, sys, warnings
warnings.simplefilter("ignore")
skipped = {{"test", "tests", "idlelib", "lib2to3", "turtledemo", "ensurepip", "pydoc_data", "this", "antigravity", "macholib"}}
values = ["", 1, 1.0, True, [], (), {{}}, set(), range(1), None, pathlib.PosixPath(), io.StringIO(), {{}}.keys(), {{}}.values(), {{}}.items()]
asked = json.load(sys.stdin)
def below(paths, start):
    for _, name, is_package in pkgutil.iter_modules(paths):
        if not skipped & {{name}} and not name.startswith("_" if start else "__"):
            yield start + name
            if is_package and name not in ("site-packages", "encodings", "tkinter"):
                yield from below([os.path.join(path, name) for path in paths], start + name + ".")
def has_module(name):
    try:
        return importlib.util.find_spec(name) is not None
    except ImportError:
        return False
library = os.path.dirname(os.__file__)
modules = set(below([library, os.path.join(library, "lib-dynload")], ""))
modules |= set(getattr(sys, "stdlib_module_names", sys.builtin_module_names)) | set(filter(has_module, asked.get("", ["os.path", "collections.abc"])))
names = {{"": [name for name in modules if not skipped & {{name}} and "sysconfigdata" not in name]}}
owners = {{name: importlib.import_module(name) for name in {LISTED}}}
owners.update(("class " + type(value).__name__.replace("Posix", "PurePosix"), value) for value in values)
for key, owner in owners.items():
    others = asked.get(key, []) + collections.abc.__all__
    every = [*dir(owner), *(name for name in others if hasattr(owner, name))]
    names[key] = [name for name in every if key == "builtins" or not name.startswith("_")]
print(json.dumps(["%d.%d" % sys.version_info[:2], names]))
"""
_Names = Mapping[str, frozenset[str]]


def list_names(interpreter: Sequence[str], asked: _Names) -> tuple[str, _Names]:
    """Return the version of an interpreter, and its names by module or type; those of modules by the empty name."""
    command = [*interpreter, "-I", "-c", _PROGRAM]
    given = json.dumps({key: sorted(value) for key, value in asked.items()})
    output = subprocess.run(command, check=True, capture_output=True, text=True, input=given).stdout
    version, names = json.loads(output)
    return version, {key: frozenset(value) for key, value in names.items()}


def write_names(interpreters: Sequence[Sequence[str]]) -> str:
    """Return the text of the file: what every version has, and what each has besides."""
    asked: dict[str, frozenset[str]] = {}
    for interpreter in interpreters:
        for key, value in list_names(interpreter, {})[1].items():
            asked[key] = asked.get(key, frozenset()) | value
    by_version = dict(list_names(interpreter, asked) for interpreter in interpreters)
    head = PYTHON_NAMES_FILE.read_text("utf-8").partition("[always]")[0]
    assert {*by_version} == {*tomli.loads(head)["python"].values()}
    always = {
        key: asked[key].intersection(*(names[key] for names in by_version.values()))
        for key in asked
    }
    always["setuptools"] = python_names("setuptools")  # which is of no version
    lines = [head.rstrip(), "", *_table("always", always)]
    for version, names in by_version.items():
        more = {key: value - always[key] for key, value in names.items()}
        lines += ["", *_table(f'"{version}"', more)]
    return "\n".join(lines) + "\n"


def _table(header: str, names: _Names) -> list[str]:
    rows = []
    for key, value in sorted(names.items()):
        if value:
            rows.append(f"{json.dumps(key)} = '{' '.join(sorted(value))}'")
    return [f"[{header}]", *rows]


if __name__ == "__main__":
    Path(PYTHON_NAMES_FILE).write_text(
        write_names([each.split() for each in sys.argv[1:]]), "utf-8"
    )
