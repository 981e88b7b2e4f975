"""If the grader crashes, hangs or prints no report, results.json still exists and says that nothing was graded."""

import json
import os
import venv
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.bundle.gradescope import FALLBACK, Autograder
from tests.classroom.class_runs import eventually

pytestmark = pytest.mark.exhaustive

Making = Callable[..., Autograder]
FINE = json.dumps({"score": 1.5, "output": "fine", "tests": []})
HANGS = """
import subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
open({path!r}, "w").write(str(child.pid))
time.sleep(600)
"""


@pytest.mark.parametrize("code", [0, 1, 3])
def test_a_report_is_accepted(with_grader: Making, code: int) -> None:
    """A report counts as graded even if a check has an error of the grader."""
    assert with_grader(f"print({FINE!r}); raise SystemExit({code})").run() == json.loads(FINE)


def test_lone_surrogates_are_removed(with_grader: Making) -> None:
    """Lone surrogates, which only Python accepts, do not reach Gradescope."""
    output = with_grader('print(r\'{"score": 0, "output": "a\\udc80b \\u00e4"}\')').run()["output"]
    assert output == "a?b \u00e4"


@pytest.mark.parametrize(
    "program",
    [
        "import os; os.abort()",
        "raise RuntimeError('broken')",
        "raise SystemExit(0)",
        f"print({FINE!r}); raise SystemExit(4)",
        f"print({FINE[:-5]!r})",
        "print('[1]')",
        "print('{}')",
        "print('{\"score\": NaN}')",
        'print(\'{"score": "1"}\')',
        "print('[' * 100_000)",
        'import sys; sys.stdout.buffer.write(b\'{"score": 1, "output": "\\xff"}\')',
        f"print({FINE!r} + ' ' * (33 << 20) + 'x')",
    ],
    ids=lambda program: program[:40],
)
def test_no_report(with_grader: Making, program: str) -> None:
    """After a crash or output that is no report, nothing is graded and the instructor sees the reason."""
    autograder = with_grader(program)
    results = autograder.run()
    assert (results["score"], results["tests"], results["output_format"]) == (0, [], "text")
    assert results["output"].startswith(FALLBACK)
    assert "the grader ended with exit code" in autograder.ended().stdout


def test_error_text_is_escaped(with_grader: Making) -> None:
    """The reason why nothing was graded reaches the student as plain text, whatever it contains."""
    words = (
        b"grader: <b>\x1b[31m\x00\xff\xe2\x80\xae `a` " + b"long " * 1000 + b"\ngrader: second\n"
    )
    results = with_grader(
        f"import sys; sys.stderr.buffer.write({words!r}); raise SystemExit(2)"
    ).run()
    assert (results["score"], results["output_format"]) == (0, "text")
    assert "\n<b>?[31m?\ufffd? `a` long long" in results["output"]
    assert len(results["output"]) < 3000


def test_a_grader_that_hangs(with_grader: Making, tmp_path: Path) -> None:
    """A grader that hangs is terminated with all its processes, and the student reads that it took too long."""
    autograder = with_grader(HANGS.format(path=str(tmp_path / "child")), seconds=3)
    assert "longer than 3 seconds" in autograder.run()["output"]
    child = int((tmp_path / "child").read_text())
    assert eventually(lambda: not _runs(child))


def _runs(process: int) -> bool:
    try:
        os.kill(process, 0)
        return Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


@pytest.mark.parametrize(
    "program",
    ["", "nonsense", "#!/bin/sh\nexit 1", "#!/bin/sh\nsleep 600"],
    ids=["missing", "nonsense", "fails", "hangs"],
)
def test_a_python_that_does_not_run(autograder: Autograder, tmp_path: Path, program: str) -> None:
    """A Python that does not start (setup.sh did not run or failed) is explained."""
    (autograder.root / "venv").unlink()
    (autograder.root / "venv").symlink_to(tmp_path)
    if program:
        (tmp_path / "bin").mkdir()
        (tmp_path / "bin" / "python").write_text(program)
        (tmp_path / "bin" / "python").chmod(0o755)
    script = autograder.root / "run_autograder"
    script.write_text(script.read_text().replace("--kill-after=10 420", "--kill-after=1 2"))
    _is_explained(autograder)


def test_an_environment_without_packages(autograder: Autograder, tmp_path: Path) -> None:
    """An environment that setup.sh did not finish is explained."""
    (autograder.root / "venv").unlink()
    venv.create(autograder.root / "venv", symlinks=True)
    _is_explained(autograder)


def _is_explained(autograder: Autograder) -> None:
    results = autograder.run()
    assert (results["score"], results["tests"]) == (0, [])
    assert results["output"].startswith(FALLBACK)
    assert "the grader did not finish" in autograder.ended().stdout
