"""The grader as it is installed here: its files, and what it needs to run elsewhere."""

import re
import tomllib
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path, PurePosixPath

from grader.errors import InputError
from grader.grading.rubric import shipped_rubrics

_PACKAGE = Path(__file__).resolve().parent.parent
_EXTRA = re.compile(r"""(?:\band\s+)?\bextra\s*==\s*["']([\w.-]+)["']""")


def package_files() -> dict[str, bytes]:
    """The files of the package by their paths, as in a wheel: with the rubrics, but without their reference solutions."""
    found = {
        str(PurePosixPath(_PACKAGE.name, *path.relative_to(_PACKAGE).parts)): path.read_bytes()
        for path in _PACKAGE.rglob("*")
        if path.is_file() and _is_ours(path.relative_to(_PACKAGE))
    }
    for path in shipped_rubrics().values():
        found[f"{_PACKAGE.name}/rubrics/{path.name}"] = path.read_bytes()
    return found


def _is_ours(path: Path) -> bool:
    if path.parts[0] == "rubrics" or path.suffix == ".pyc":
        return False
    return not any(part == "__pycache__" or part.startswith(".") for part in path.parts)


def requirements(extra: str) -> list[str]:
    """What pip has to install beside the grader for it to run with one of its extras; raises InputError."""
    return sorted(map(_spelt, _of_checkout(extra) or _of_installation(extra)))


def _spelt(requirement: str) -> str:
    """A requirement with its bounds in order, as tools that build wheels write them."""
    named, mark, condition = requirement.partition(";")
    name = re.split(r"[^\w.\[\]-]", named, maxsplit=1)[0]
    bounds = sorted(each.strip() for each in named.removeprefix(name).split(","))
    return f"{name}{','.join(bounds)}" + (f" {mark} {condition.strip()}" if mark else "")


def _of_checkout(extra: str) -> list[str]:
    """Those of the project that the package stands in, because what is installed may be older; none if it stands in no project."""
    try:
        project = tomllib.loads(_PACKAGE.with_name("pyproject.toml").read_text(encoding="utf-8"))["project"]
    except (OSError, ValueError, KeyError):
        return []
    if project.get("name") != _PACKAGE.name:
        return []
    return [*project["dependencies"], *project["optional-dependencies"][extra]]


def _of_installation(extra: str) -> list[str]:
    try:
        declared = requires(_PACKAGE.name) or []
    except PackageNotFoundError:
        raise InputError("cannot tell what the grader needs to run: it is not installed; install it with pip") from None
    return [each for line in declared if (each := _without_extra(line, extra))]


def _without_extra(requirement: str, extra: str) -> str:
    """A requirement without the condition that an extra is wanted; empty if it belongs to another one."""
    name, _, condition = requirement.partition(";")
    wanted = _EXTRA.search(condition)
    if wanted is None:
        return requirement
    if wanted[1] != extra:
        return ""
    rest = _EXTRA.sub("", condition).strip()
    return f"{name.strip()};{rest}" if rest else name.strip()
