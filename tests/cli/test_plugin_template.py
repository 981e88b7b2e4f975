"""The template of a package with checks: built, installed, tested and used as its page says."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT, Done, clean_environment, run_process

pytestmark = pytest.mark.exhaustive

PAGE = (ROOT / "docs/python.md").read_text(encoding="utf-8").partition("## Plug-in checks\n")[2]
TEMPLATE = ROOT / "docs/plug-in-template"
ENTRY = "[grader.checks]\n{} = math:hypot\n"


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a copy of the template, whose package is installed in the folder `installed` beside it."""
    folder = tmp_path_factory.mktemp("plug-in")
    ignored = shutil.ignore_patterns("__pycache__", ".*_cache")
    copy = Path(shutil.copytree(TEMPLATE, folder / "plug-in-template", ignore=ignored))
    options = (
        "--quiet",
        "--no-index",
        "--no-deps",
        "--no-build-isolation",
        "--disable-pip-version-check",
    )
    done = python(
        copy, "-m", "pip", "install", *options, "--target", str(folder / "installed"), str(copy)
    )
    assert done.returncode == 0, done.stderr.decode()
    return copy


def python(folder: Path, *arguments: str, **variables: str) -> Done:
    """Run Python in a folder."""
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=folder,
        env={**clean_environment(), **variables},
        capture_output=True,
        check=False,
        timeout=HANG_TIMEOUT,
    )


def grader(project: Path, *arguments: str) -> Done:
    """Run the command line with the package installed."""
    return run_process(
        arguments, variables={"PYTHONPATH": str(project.parent / "installed")}, folder=project
    )


def test_its_tests_pass(project: Path) -> None:
    """The template's own tests pass with the installed package, not with the file beside them."""
    (project.parent / "tests").mkdir()
    shutil.copy(project / "test_arm_checks.py", project.parent / "tests")
    options = (
        "-q",
        "-p",
        "no:cacheprovider",
        "-c",
        str(project / "pyproject.toml"),
        "test_arm_checks.py",
    )
    done = python(
        project.parent / "tests",
        "-m",
        "pytest",
        *options,
        PYTHONPATH=str(project.parent / "installed"),
    )
    assert done.returncode == 0, done.stdout.decode() + done.stderr.decode()
    assert b"7 passed" in done.stdout


def test_the_list_of_checks_names_its_package(project: Path) -> None:
    """`rubric checks` shows where each check comes from, and `explain` its arguments."""
    listed = grader(project, "rubric", "checks").stdout.decode()
    assert "\nshows_box (grader)\n" in listed
    assert "\ndistance_between (arm-checks)\n" in listed
    explained = grader(project, "explain", "distance_between").stdout.decode()
    assert explained.startswith(
        "distance_between: a check for rubrics, from the package arm-checks\n\nThe origins of "
    )
    assert (
        "    tolerance: a number\n      How far the distance may be off, in metres.\n" in explained
    )


def test_a_rubric_uses_it(project: Path) -> None:
    """The reference gets full marks; a robot with another distance loses the points, and the message says why."""
    checked = grader(project, "rubric", "check", "arm_lab.toml")
    assert (
        checked.stdout
        == b"arm-lab: 1 criterion, 2 points, no mistakes found; its reference gets full marks\n"
    )
    robot = project.parent / "short.urdf"
    robot.write_text((project / "arm.urdf").read_text().replace("0.3 0 0.4", "0.3 0 0.3"))
    graded = grader(project, "grade", str(robot), "--rubric", "arm_lab.toml", "--format", "json")
    assert graded.returncode == 1
    [result] = json.loads(graded.stdout)["results"]
    expected = (
        "the distance of 'tip' from 'base' is 0.4243 m; it should be 0.5 m (75.7 mm too small)"
    )
    assert (result["status"], result["message"]) == ("failed", expected)
    place = {"path": "short.urdf", "line": 4, "column": 3, "end_line": 4, "end_column": 21}
    assert result["location"] == place


def test_the_page_shows_the_template() -> None:
    """The check on the page is that of the template, and every file of the template is in the page's table."""
    shown = re.findall(r"```python\n(def .*?)```", PAGE, re.DOTALL)
    assert [code in (TEMPLATE / "arm_checks.py").read_text(encoding="utf-8") for code in shown] == [
        True
    ]
    rubric = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
    assert [code in (TEMPLATE / "arm_lab.toml").read_text(encoding="utf-8") for code in rubric] == [
        True
    ]
    files = {path.name for path in TEMPLATE.iterdir() if path.is_file()}
    assert files == {
        name
        for name in re.findall(r"`([\w.]+)`", PAGE.partition("## What a check gets")[0])
        if "." in name
    }


def test_a_name_that_is_taken(tmp_path: Path) -> None:
    """The list says that a check is not used; a rubric that uses a check of two packages is refused."""
    for package, name in (("one", "shows_box"), ("two", "reach"), ("three", "reach")):
        about = tmp_path / f"{package}-1.0.dist-info"
        about.mkdir()
        (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {package}\nVersion: 1.0\n")
        (about / "entry_points.txt").write_text(ENTRY.format(name))
    rubric = (
        (TEMPLATE / "arm_lab.toml").read_text(encoding="utf-8").replace("distance_between", "reach")
    )
    (tmp_path / "lab.toml").write_text(rubric)
    variables = {"PYTHONPATH": str(tmp_path)}
    listed = run_process(("rubric", "checks"), variables=variables).stdout.decode()
    assert listed.count("shows_box (") == 2
    assert listed.endswith("\nshows_box (one)\n  Not used: the grader has a check of this name.\n")
    checked = run_process(("rubric", "check", "lab.toml"), variables=variables, folder=tmp_path)
    message = b"grader: lab.toml:14: the check reach is in several packages, three and two: uninstall all but one\n"
    assert (checked.returncode, checked.stdout, checked.stderr) == (2, b"", message)
