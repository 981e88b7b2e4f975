"""The files of the installed grader, and its requirements."""

import re
import tomllib
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path, PurePosixPath

from grader.errors import InputError
from grader.grading.rubric import shipped_rubrics

DISTRIBUTION = "urdf-grader"
_PACKAGE = Path(__file__).resolve().parent.parent
_EXTRA = re.compile(r"""(?:\band\s+)?\bextra\s*==\s*["']([\w.-]+)["']""")


def package_files() -> dict[str, bytes]:
    """Return the files of the package by their paths in a wheel: with the rubrics, without their reference solutions."""
    found = {
        str(PurePosixPath(_PACKAGE.name, *path.relative_to(_PACKAGE).parts)): path.read_bytes()
        for path in _PACKAGE.rglob("*")
        if path.is_file() and _is_in_wheel(path.relative_to(_PACKAGE))
    }
    for path in shipped_rubrics().values():
        found[f"{_PACKAGE.name}/rubrics/{path.name}"] = path.read_bytes()
    return found


def _is_in_wheel(path: Path) -> bool:
    if path.parts[0] == "rubrics" or path.suffix == ".pyc":
        return False
    return not any(part == "__pycache__" or part.startswith(".") for part in path.parts)


def requirements(extra: str) -> list[str]:
    """Return the requirements of the grader with one of its extras, for pip. Raises InputError if they are unknown."""
    return sorted(map(_normalized, _of_checkout(extra) or _of_installation(extra)))


def _normalized(requirement: str) -> str:
    """Return a requirement with its version bounds sorted, as build tools write them in the metadata."""
    specifier, semicolon, marker = requirement.partition(";")
    name = re.split(r"[^\w.\[\]-]", specifier, maxsplit=1)[0]
    bounds = sorted(bound.strip() for bound in specifier.removeprefix(name).split(","))
    return f"{name}{','.join(bounds)}" + (f" {semicolon} {marker.strip()}" if semicolon else "")


def _of_checkout(extra: str) -> list[str]:
    """Return the requirements in the pyproject.toml next to the package: the installed metadata may be older."""
    try:
        project = tomllib.loads(_PACKAGE.with_name("pyproject.toml").read_text(encoding="utf-8"))["project"]
    except (OSError, ValueError, KeyError):
        return []
    if project.get("name") != DISTRIBUTION:
        return []
    return [*project["dependencies"], *project["optional-dependencies"][extra]]


def _of_installation(extra: str) -> list[str]:
    try:
        declared = requires(DISTRIBUTION) or []
    except PackageNotFoundError:
        raise InputError(
            f"cannot determine the requirements of the grader: {DISTRIBUTION} is not installed; install it with pip"
        ) from None
    return [line for requirement in declared if (line := _without_extra(requirement, extra))]


def _without_extra(requirement: str, extra: str) -> str:
    """Return a requirement without its condition on an extra; empty if it belongs to another extra."""
    name, _, marker = requirement.partition(";")
    condition = _EXTRA.search(marker)
    if condition is None:
        return requirement
    if condition[1] != extra:
        return ""
    rest = _EXTRA.sub("", marker).strip()
    return f"{name.strip()};{rest}" if rest else name.strip()
