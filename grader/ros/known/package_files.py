"""The files of the folder `packages`, one file a package.

They are what is known of a ROS package that is not submitted.

A file begins with the facts of the package, its programs, controllers and launch files, which
package_rows.py reads. What follows is longer and read apart: the parameters of its nodes, its
messages, and what one reader needs.
"""

import os
import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, Literal

import tomli

from grader.base.patterns import on_use

FOLDER = Path(__file__).with_name("packages")
_INDEX = FOLDER.with_name("index.toml")
_ENDING = ".toml"
# The first header after the facts of a package.
_END_OF_FACTS = on_use(r"^\[(?!\[?(?:program|controller|launch)\.)", re.MULTILINE)
# The facts of which readers need those of all packages.
IndexedKey = Literal[
    "action",
    "arguments",
    "children",
    "controller",
    "ends_unless",
    "launch_actions",
    "members",
    "plugins",
    "reads",
    "transforms",
    "usual_names",
    "writes",
]


@cache
def packages_with_files() -> frozenset[str]:
    """Return the packages of which something is known."""
    names = os.listdir(FOLDER)  # noqa: PTH208  # Path.iterdir takes four times as long
    return frozenset(name.removesuffix(_ENDING) for name in names if name.endswith(_ENDING))


@cache
def _index() -> Mapping[str, list[str]]:
    return tomli.loads(_INDEX.read_text("utf-8"))


def packages_with(key: IndexedKey) -> list[str]:
    """Return the packages that have a fact, by index.toml: reading all files would take longer."""
    return _index()[key]


def facts_in_file(package: str) -> dict[str, Any]:
    """Return the facts at the start of the file of a package that has one."""
    return tomli.loads(split_facts(_read_text(package))[0])


def tables_in_file(package: str) -> Mapping[str, Any]:
    """Return the tables after the facts in the file of a package; none without a file."""
    return _read_tables(package) if package in packages_with_files() else {}


@cache
def _read_tables(package: str) -> Mapping[str, Any]:
    return tomli.loads(split_facts(_read_text(package))[1])


def _read_text(package: str) -> str:
    return (FOLDER / f"{package}{_ENDING}").read_text("utf-8")


def split_facts(text: str) -> tuple[str, str]:
    """Return the text of the facts of a package, and of the tables after them."""
    end = _END_OF_FACTS.search(text)
    at = end.start() if end else len(text)
    return text[:at], text[at:]
