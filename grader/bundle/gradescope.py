"""The autograder zip for Gradescope: the grader, a rubric, and the scripts that install and run them there."""

import io
import json
import zipfile
from pathlib import Path

from grader.bundle.installed import package_files, requirements
from grader.errors import InputError
from grader.grading.rubric import Rubric

SECONDS = 300  # of the ten minutes that Gradescope gives
_SCRIPTS = Path(__file__).resolve().parent / "on_gradescope"
_EXECUTABLES = ("setup.sh", "run_autograder")
_EXTRA = "documents"  # reads answers in Word and PDF files
_RUBRIC = "rubric.toml"
_ZIP_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time that a zip can contain
_UNIX = 3


def autograder_zip(rubric: Rubric) -> bytes:
    """Return the zip to upload under "Configure Autograder". Raises InputError if the rubric could not be used there."""
    for criterion in rubric.criteria:
        package = criterion.check.function.__module__.split(".")[0]
        if package != "grader":
            raise InputError(
                f"{rubric.id}: the criterion {criterion.id} uses a check of the package {package}, which the bundle does not contain"
            )
    files = package_files()
    files |= {name: _unix_lines(name) for name in (*_EXECUTABLES, "autograder.py")}
    files["autograder.json"] = _settings(rubric)
    files["requirements.txt"] = "".join(f"{requirement}\n" for requirement in requirements(_EXTRA)).encode()
    if not rubric.is_shipped:
        files[_RUBRIC] = rubric.data
    return _zip_of(files)


def _settings(rubric: Rubric) -> bytes:
    name = rubric.id if rubric.is_shipped else f"source/{_RUBRIC}"
    return (json.dumps({"rubric": name, "sha256": rubric.sha256, "seconds": SECONDS}, indent=1) + "\n").encode()


def _unix_lines(name: str) -> bytes:
    """Return a script with Unix line endings: a checkout on Windows has others, which bash does not accept."""
    return (_SCRIPTS / name).read_bytes().replace(b"\r\n", b"\n")


def _zip_of(files: dict[str, bytes]) -> bytes:
    """Return a zip that depends on the files only.

    It has no timestamps and a fixed order. It is not compressed, because zlib's output differs between its versions.
    """
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        for path, data in sorted(files.items()):
            entry = zipfile.ZipInfo(path, _ZIP_EPOCH)
            entry.create_system = _UNIX  # else unzip ignores the permissions
            entry.external_attr = (0o100755 if path in _EXECUTABLES else 0o100644) << 16
            archive.writestr(entry, data)
    return buffer.getvalue()
