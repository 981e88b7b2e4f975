"""The autograder zip for Gradescope.

It has the grader, a rubric, and the scripts that install and run them there.
"""

import json
from importlib.metadata import PackageNotFoundError, requires
from pathlib import Path, PurePosixPath

from grader.base.errors import InputError
from grader.base.patterns import on_use
from grader.files.zip_writing import make_zip
from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import RUBRIC_FILE, Rubric, shipped_rubrics

_SECONDS = 300  # of the ten minutes that Gradescope gives
_SCRIPTS = Path(__file__).resolve().parent / "on_gradescope"
_EXECUTABLES = ("setup.sh", "run_autograder")
_DISTRIBUTION = "urdf-grader"
_PACKAGE = Path(__file__).resolve().parent.parent.parent
_EXTRA = on_use(r"""(?:\band\s+)?\bextra\s*==\s*["']([\w.-]+)["']""")  # and extra == 'documents'


def autograder_zip(rubric: Rubric) -> bytes:
    """Return the zip to upload under "Configure Autograder".

    Raises InputError if the rubric cannot be used there.
    """
    for criterion in rubric.criteria:
        package = criterion.check.function.__module__.split(".")[0]
        if package != "grader":
            raise InputError(
                f"{rubric.id}: the criterion {criterion.id} uses a check of the package {package}, "
                "which the bundle does not contain"
            )
    files = package_files()
    for name in (
        *_EXECUTABLES,
        "autograder.py",
    ):  # a checkout on Windows has line ends that bash does not accept
        files[name] = (_SCRIPTS / name).read_bytes().replace(b"\r\n", b"\n")
    name = rubric.id if rubric.is_shipped else f"source/{RUBRIC_FILE}"
    settings = {"rubric": name, "sha256": rubric.sha256, "seconds": _SECONDS}
    files["autograder.json"] = (json.dumps(settings, indent=1) + "\n").encode()
    needed = requirements("documents")  # the extra reads answers in Word and PDF files
    files["requirements.txt"] = "".join(f"{requirement}\n" for requirement in needed).encode()
    if not rubric.is_shipped:
        files[RUBRIC_FILE] = rubric.data
    folder = f"{_PACKAGE.name}/rubrics/{rubric.id}" if rubric.is_shipped else ""
    files |= {str(PurePosixPath(folder, path)): data for path, data in _reference(rubric).items()}
    return make_zip(files, _EXECUTABLES)


def _reference(rubric: Rubric) -> dict[PurePosixPath, bytes]:
    """Return the files of the reference solution.

    Hints are found by these files, and checks compare with them.

    Without such a check there are none if it is not below the rubric's folder. Raises GraderError.
    """
    is_outside = ".." in PurePosixPath(rubric.reference).parts
    if rubric.solution and rubric.compares_with_reference:
        grade(
            rubric, rubric.solution.submission
        )  # raises GraderError where it cannot be compared with
        if is_outside:
            raise InputError(
                f"{rubric.id}: a check compares with the reference {rubric.reference}, "
                "which must be below the rubric's folder"
            )
    elif not rubric.reference or rubric.hints == "none" or is_outside:
        return {}
    return _read_files(rubric.path.parent / rubric.reference, rubric.path.parent)


def package_files() -> dict[str, bytes]:
    """Return the files of the package by their paths in a wheel.

    The rubrics are among them, without references and examples.
    """
    data = ("rubrics", "examples")  # in a wheel; in a checkout they are outside of the package
    own_files = {
        path: content
        for path, content in _read_files(_PACKAGE, _PACKAGE).items()
        if path.parts[0] not in data
    }
    rubrics = {
        PurePosixPath("rubrics", name, RUBRIC_FILE): path.read_bytes()
        for name, path in shipped_rubrics().items()
    }
    return {str(_PACKAGE.name / path): data for path, data in (own_files | rubrics).items()}


def _read_files(place: Path, root: Path) -> dict[PurePosixPath, bytes]:
    """Return the files at or below a place by their paths from a folder.

    Files of editors and Python are not among them.
    """
    paths = [place] if place.is_file() else [path for path in place.rglob("*") if path.is_file()]
    own_files = {
        PurePosixPath(*path.relative_to(root).parts): path
        for path in paths
        if path.suffix != ".pyc"
    }
    return {
        name: path.read_bytes()
        for name, path in own_files.items()
        if not any(map(_is_left_out, name.parts))
    }


def _is_left_out(name: str) -> bool:
    return name == "__pycache__" or name.startswith(".")


def requirements(extra: str) -> list[str]:
    """Return the requirements of the installed grader with one of its extras, for pip.

    Raises InputError if none is installed. Those of an editable installation are as old as that:
    pip writes them.
    """
    try:
        declared = requires(_DISTRIBUTION) or []
    except PackageNotFoundError:
        raise InputError(
            f"cannot determine the requirements of the grader: {_DISTRIBUTION} is not "
            "installed; install it with pip"
        ) from None
    return sorted(
        plain for requirement in declared if (plain := _without_extra(requirement, extra))
    )


def _without_extra(requirement: str, extra: str) -> str:
    """Return a requirement without its condition on an extra.

    It is empty if it belongs to another extra.
    """
    name, _, marker = requirement.partition(";")
    condition = _EXTRA.search(marker)
    if condition and condition[1] != extra:
        return ""
    rest = _EXTRA.sub("", marker).strip()
    if rest:
        return f"{name.strip()} ; {rest}"
    return name.strip()
