"""What a cold `grade` imports: half of its time passes before it reads the submission."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from grader.report.formats import InspectFormat
from tests.command_line import ROOT

pytestmark = pytest.mark.slow

URDF = "submissions/lab6/reference/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"
_PROGRAM = """
import sys
before = {*sys.modules}  # what else is installed may import modules when Python starts
from grader.__main__ import main
try:
    main()
except SystemExit as end:
    assert end.code in (0, 1)
loaded = (name for name, module in sys.modules.items() if "__file__" in vars(module))
print(*(name for name in loaded if name not in before), file=sys.stderr)
"""
# Each of these takes some 1 to 50 % of a grading to import, and a URDF without mistakes needs none of them.
UNUSED = {
    "grader.lab.authoring",
    "grader.classroom",
    "grader.lab.documents",
    "grader.lab.hints",
    "grader.base.markup",
    "grader.report.drawing",
    "grader.ros.mesh",
    "grader.ros.package.mesh_loading",
    "grader.ros.xacro",
    "hashlib",
    "jinja2",
    "multiprocessing",
    "numpy",
    "pebble",
    "rich.progress",
    "rich.table",
    "grader.ros.recording",
    "sqlite3",
    "tempfile",
    "yaml",
    "zipfile",
}


@pytest.mark.parametrize(
    ("options", "more"),
    [([], set()), (["--format", "json"], {"rich"})],
    ids=["text", "json"],
)
def test_a_cold_grading_imports_few_modules(options: list[str], more: set[str]) -> None:
    """A single URDF without mistakes is graded without what only others need."""
    modules = _imported("grade", URDF, *options)
    assert not [name for name in UNUSED | more if name in modules]


@pytest.mark.parametrize(
    "path", [URDF, "submissions/lab6/several-mistakes", "submissions/diffdrive/joint-misspelt"]
)
def test_an_inspection_imports_nothing_of_labs(path: str, tmp_path: Path) -> None:
    """A URDF, a submission and a package whose controller drives wheels are inspected without checks and reports, in each format."""
    saves = []
    for kind in InspectFormat:
        saves += ["--save", f"{kind}={tmp_path / 'inspection'}.{kind.ending}"]
    modules = _imported("inspect", path, *saves)
    assert "grader.ros.api" in modules
    labs = ("grader.lab", "grader.report.content", "grader.report.criteria")
    assert [name for name in modules if name.startswith(labs)] == []


def test_a_class_without_reports_imports_no_numpy(tmp_path: Path) -> None:
    """Only workers, and the small pictures of the class's page, need it."""
    folder = ROOT / "submissions/class/files"
    assert "numpy" not in _imported("batch", str(folder), "--gradebook", str(tmp_path / "book"))


def _imported(*arguments: str) -> list[str]:
    """Return the modules that a command of the grader imports."""
    variables = {
        name: text
        for name, text in os.environ.items()
        if not name.startswith(("COV_", "COVERAGE", "GITHUB_"))
    }
    done = subprocess.run(
        [sys.executable, "-P", "-c", _PROGRAM, *arguments],
        cwd=ROOT,
        check=True,
        capture_output=True,
        text=True,
        env={**variables, "PYTHONPATH": str(ROOT)},
    )
    return done.stderr.split()
