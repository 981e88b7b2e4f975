"""Properties of all checks of a submission: the cases, a grade run, and submissions without a package."""

import sys

import pytest

from grader.base.errors import InputError
from grader.lab.checks.check import About, describe
from grader.lab.checks.outcome import Outcome, passed
from grader.ros.package.package import Package
from grader.ros.urdf.kinematics import Configuration
from tests.checks.cases import PACKAGE_CASES, Case
from tests.checks.outcomes import ask, graded
from tests.checks.submissions import (
    FOLDER,
    LAUNCH,
    MANIFEST,
    REFERENCE,
    RVIZ,
    SETUP,
    URDF,
    Submitted,
)

every_case = pytest.mark.parametrize(
    "case", PACKAGE_CASES, ids=[case.name for case in PACKAGE_CASES]
)

# Contents that no file of a package should have, and that must not break a check.
ODD = {
    "empty": b"",
    "binary": bytes(range(256)) * 20,
    "nul": b"\0" * 100,
    "utf-16": "import os\n".encode("utf-16"),
    "deep": b"[" * 3000,
    "long line": b"a = " + b"1 + " * 5000 + b"1\n",
    "markup": b"<a><b></a>",
    "exits": b"import sys\nsys.exit()\n",
    "raises": b"raise SystemExit(1)\n",
    "endless": b"while True:\n    pass\n",
}


@every_case
@pytest.mark.parametrize("path", [MANIFEST, SETUP, LAUNCH, RVIZ, URDF])
def test_a_missing_file_breaks_no_check(case: Case[Submitted], path: str) -> None:
    """Whichever file is missing, a check passes, fails or is pending with its own message."""
    outcome = graded(case.check, REFERENCE.without(path), **case.arguments)
    assert outcome.status in ("passed", "failed", "pending"), outcome


@every_case
@pytest.mark.parametrize("content", ODD.values(), ids=ODD)
def test_odd_files_break_no_check(case: Case[Submitted], content: bytes) -> None:
    """Whatever the files contain, a check passes, fails or is pending with its own message."""
    for path in (MANIFEST, SETUP, LAUNCH, RVIZ, URDF):
        outcome = graded(case.check, REFERENCE.with_files({path: content}), **case.arguments)
        assert outcome.status in ("passed", "failed", "pending"), (path, outcome)
        if outcome.location is not None:
            assert outcome.location.path in REFERENCE.files


@every_case
def test_the_folder_of_the_package_does_not_matter(case: Case[Submitted]) -> None:
    """A package is graded the same wherever it is in the submission."""
    deeper = f"ws/src/{FOLDER}"
    for submitted in (case.passing, case.failing):
        moved = Submitted(
            {
                deeper + path.removeprefix(FOLDER)
                if path.startswith(FOLDER + "/")
                else path: content
                for path, content in submitted.files.items()
            }
        )
        first, second = (ask(case.check, files, **case.arguments) for files in (submitted, moved))
        assert second.status == first.status
        assert second.message == first.message


@every_case
def test_a_check_of_a_package_declares_what_it_looks_at(case: Case[Submitted]) -> None:
    """Hints propose edits of these files."""
    check = describe(case.check)
    files = {name for name in check.about.looks_at if not name.startswith("xacro:")}
    assert check.subject != "package" or files
    assert files <= {"setup.py", "package.xml", "launch", "rviz", "file"}


def test_a_check_of_another_module_may_declare_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also one of a plug-in; without a declaration it looks at nothing."""

    def has_driver(package: Package, *, name: str) -> Outcome:
        """The package starts its driver."""
        return passed(f"{package.name} starts {name}")

    assert describe(has_driver).about == About()
    monkeypatch.setattr(
        sys.modules[__name__], "ABOUT", {"has_driver": About(("launch",))}, raising=False
    )
    assert describe(has_driver).about.looks_at == ("launch",)
    monkeypatch.setattr(sys.modules[__name__], "ABOUT", {"has_driver": ("launch",)})
    with pytest.raises(InputError, match=r"^ABOUT says of has_driver what is no About\(\.\.\.\)$"):
        describe(has_driver)


def test_annotations_may_be_texts() -> None:
    """As in a module that imports annotations from __future__."""

    def has_wheels(robot: "Configuration", *, wheels: "int", tolerance: float = 0.0) -> "Outcome":
        """The robot has wheels."""
        return passed(f"{robot.robot.name} has {wheels} wheels, within {tolerance}")

    parameters = describe(has_wheels).parameters
    assert {name: parameter.type.name for name, parameter in parameters.items()} == {
        "wheels": "a whole number",
        "tolerance": "a number",
    }
