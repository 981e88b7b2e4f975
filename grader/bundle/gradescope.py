"""An autograder for Gradescope: the grader, a rubric, and the scripts that install and run them there."""

import json
from pathlib import Path

from grader.bundle.archive import Member, zip_of
from grader.bundle.installed import package_files, requirements
from grader.errors import InputError
from grader.grading.rubric import Rubric

SECONDS = 300  # of the ten minutes that Gradescope gives
_SCRIPTS = Path(__file__).resolve().parent / "on_gradescope"
_PROGRAMS = ("setup.sh", "run_autograder")
_ANSWERS = "documents"  # the extra that reads answers in Word and PDF files
_OWN_RUBRIC = "rubric.toml"


def autograder_zip(rubric: Rubric) -> bytes:
    """The zip that Gradescope takes under "Configure Autograder"; raises InputError where it could not grade there."""
    for criterion in rubric.criteria:
        owner = criterion.check.function.__module__.split(".")[0]
        if owner != "grader":
            raise InputError(
                f"{rubric.id}: the criterion {criterion.id} is decided by a check of another package ({owner}), which is not "
                "part of the bundle"
            )
    return zip_of(_members(rubric))


def _members(rubric: Rubric) -> dict[str, Member]:
    members = {path: Member(data) for path, data in package_files().items()}
    for name in _PROGRAMS:
        members[name] = Member(_unix_lines(name), is_program=True)
    members["autograder.py"] = Member(_unix_lines("autograder.py"))
    members["autograder.json"] = Member(_settings(rubric))
    members["requirements.txt"] = Member("".join(f"{each}\n" for each in requirements(_ANSWERS)).encode())
    if not rubric.is_shipped:
        members[_OWN_RUBRIC] = Member(rubric.data)
    return members


def _settings(rubric: Rubric) -> bytes:
    named = rubric.id if rubric.is_shipped else f"source/{_OWN_RUBRIC}"
    return (json.dumps({"rubric": named, "sha256": rubric.sha256, "seconds": SECONDS}, indent=1) + "\n").encode()


def _unix_lines(name: str) -> bytes:
    """A script as it is here, but for line endings that a checkout on Windows has brought in: bash stumbles over them."""
    return (_SCRIPTS / name).read_bytes().replace(b"\r\n", b"\n")
