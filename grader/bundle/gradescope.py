"""The autograder zip for Gradescope: the grader, a rubric, and the scripts that install and run them there."""

import json
import re
import tomllib
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path, PurePosixPath

from grader.errors import InputError
from grader.files.zip_writing import zip_of
from grader.grading.grade import grade
from grader.grading.rubric import Rubric, shipped_rubrics

SECONDS = 300  # of the ten minutes that Gradescope gives
_SCRIPTS = Path(__file__).resolve().parent / "on_gradescope"
_EXECUTABLES = ("setup.sh", "run_autograder")
DISTRIBUTION = "urdf-grader"
_PACKAGE = Path(__file__).resolve().parent.parent
_EXTRA = re.compile(r"""(?:\band\s+)?\bextra\s*==\s*["']([\w.-]+)["']""")
_RUBRIC = "rubric.toml"


def autograder_zip(rubric: Rubric) -> bytes:
    """Return the zip to upload under "Configure Autograder". Raises InputError if the rubric could not be used there."""
    for criterion in rubric.criteria:
        package = criterion.check.function.__module__.split(".")[0]
        if package != "grader":
            raise InputError(
                f"{rubric.id}: the criterion {criterion.id} uses a check of the package {package}, which the bundle does not contain"
            )
    files = package_files()
    for name in (*_EXECUTABLES, "autograder.py"):  # a checkout on Windows has line ends that bash does not accept
        files[name] = (_SCRIPTS / name).read_bytes().replace(b"\r\n", b"\n")
    name = rubric.id if rubric.is_shipped else f"source/{_RUBRIC}"
    settings = {"rubric": name, "sha256": rubric.sha256, "seconds": SECONDS}
    files["autograder.json"] = (json.dumps(settings, indent=1) + "\n").encode()
    needed = requirements("documents")  # the extra reads answers in Word and PDF files
    files["requirements.txt"] = "".join(f"{requirement}\n" for requirement in needed).encode()
    if not rubric.is_shipped:
        files[_RUBRIC] = rubric.data
    files |= _reference(rubric, f"{_PACKAGE.name}/rubrics" if rubric.is_shipped else "")
    return zip_of(files, _EXECUTABLES)


def _reference(rubric: Rubric, folder: str) -> dict[str, bytes]:
    """Return the files of the reference solution, by which hints are found and with which checks compare.

    Without such a check there are none if it is not below the rubric's folder. Raises GraderError.
    """
    root = rubric.path.parent
    place = root / rubric.reference
    is_outside = ".." in PurePosixPath(rubric.reference).parts
    if rubric.solution is not None and rubric.compares_with_reference:
        grade(rubric, rubric.solution.submission)  # raises GraderError where it cannot be compared with
        if is_outside:
            raise InputError(
                f"{rubric.id}: a check compares with the reference {rubric.reference}, which must be below the rubric's folder"
            )
    elif not rubric.reference or rubric.hints == "none" or is_outside:
        return {}
    paths = [place] if place.is_file() else [path for path in place.rglob("*") if path.is_file()]
    own = (
        path
        for path in paths
        if not any(part.startswith(".") or part == "__pycache__" for part in path.relative_to(root).parts)
    )
    return {str(PurePosixPath(folder, *path.relative_to(root).parts)): path.read_bytes() for path in own}


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
    """Return the requirements in the pyproject.toml beside the package: the installed metadata may be older."""
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
