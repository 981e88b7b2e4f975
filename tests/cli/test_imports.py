"""What a cold `grade` imports: half of its time passes before it reads the submission."""

import os
import subprocess
import sys

import pytest

from tests.command_line import ROOT

URDF = "submissions/lab6/reference/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf"
_PROGRAM = """
import sys
before = {*sys.modules}  # what else is installed may import modules when Python starts
from grader.__main__ import main
try:
    main()
except SystemExit as end:
    assert end.code == 0
loaded = (name for name, module in sys.modules.items() if "__file__" in vars(module))
print(*(name for name in loaded if name not in before), file=sys.stderr)
"""
# Each of these takes some 1 to 50 % of a grading to import, and a URDF without mistakes needs none of them.
UNUSED = {
    "bz2", "grader.classroom", "grader.documents", "grader.report.svg", "grader.hints", "grader.markup",
    "grader.authoring", "grader.xacro", "hashlib", "ipaddress", "jinja2", "lzma", "multiprocessing", "numpy", "pebble",
    "rich.progress", "rich.table", "sqlite3", "subprocess", "tempfile", "textwrap", "tokenize", "yaml", "zipfile",
}  # fmt: skip


@pytest.mark.parametrize(
    ("options", "ceiling", "more"),
    [
        # The ceilings are what was needed when the imports were last examined. Raise one only for a module that every
        # grading needs; import others in the function that needs them.
        ([], 107, set()),
        (["--format", "json"], 102, {"rich"}),
    ],
    ids=["text", "json"],
)
def test_a_cold_grading_imports_few_modules(options: list[str], ceiling: int, more: set[str]) -> None:
    """A single URDF without mistakes is graded with few modules of the grader, and without what only others need."""
    variables = {
        name: text for name, text in os.environ.items() if not name.startswith(("COV_", "COVERAGE", "GITHUB_"))
    }
    done = subprocess.run(
        [sys.executable, "-P", "-c", _PROGRAM, "grade", URDF, *options],
        cwd=ROOT, check=True, capture_output=True, text=True, env={**variables, "PYTHONPATH": str(ROOT)},
    )  # fmt: skip
    modules = done.stderr.split()
    own = [name for name in modules if name.partition(".")[0] == "grader"]
    assert len(own) <= ceiling, own
    assert not [name for name in UNUSED | more if name in modules]


def test_a_late_module_is_loaded_when_it_is_used() -> None:
    """A module that is not loaded at its import serves like any other, whichever way it is imported."""
    program = """
import sys
from grader.__main__ import main
sys.argv = ["grader", "grade", "--help"]
try:
    main()
except SystemExit:
    pass
import subprocess, tokenize
early = subprocess
assert "run" not in vars(early)
from subprocess import PIPE
assert early.run is sys.modules["subprocess"].run and early.PIPE is PIPE and early is not sys.modules["subprocess"]
assert not hasattr(early, "walk")
assert sys.modules["subprocess"].run is early.run
assert tokenize.tok_name[tokenize.NAME] == "NAME"
"""
    subprocess.run([sys.executable, "-P", "-c", program], check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
