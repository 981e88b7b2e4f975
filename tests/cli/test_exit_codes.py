"""One table of exit codes: what each command returns for what it is given; what cannot be used is one line."""

from collections.abc import Sequence
from pathlib import Path

import pytest

from tests.command_line import run_with_input
from tests.samples import ROOT, SAMPLES

GOOD, ARM = (ROOT / SAMPLES[name].path for name in ("reference", "arm/axis-sign"))
WRONG, FAULTS = (ROOT / SAMPLES[name].alone.path for name in ("lidar-buried", "several-mistakes"))
NOT_XML = b"<robot name='r'><link name='a'"
BOOK = ("--gradebook", "no.db")
# Exit code, arguments, standard input. `new` is a folder that does not exist, `file` a file of another kind.
ROWS: tuple[tuple[int, Sequence[object], bytes], ...] = (
    (0, ("--version",), b""),
    (0, ("--help",), b""),
    (2, (), b""),
    (2, ("grad",), b""),
    (2, ("--verison",), b""),
    (0, ("grade", GOOD), b""),
    (0, ("grade", GOOD, "--format", "json"), b""),
    (0, ("grade", GOOD, "--fail-under", "80%"), b""),
    (1, ("grade", GOOD, "--fail-under", "100"), b""),
    (2, ("grade", GOOD, "--fail-under", "101%"), b""),
    (1, ("grade", WRONG), b""),
    (0, ("grade", WRONG, "--fail-under", "0"), b""),
    (2, ("grade", WRONG, "--part", "task2"), b""),
    (1, ("grade", FAULTS, "--hints", "none"), b""),
    (1, ("grade", ARM, "--rubric", "arm"), b""),
    (1, ("grade", "-"), b"<robot name='r'><link name='base_link'/></robot>"),
    (1, ("grade", "-"), NOT_XML),
    (1, ("grade", "-"), b"\xff\x00"),
    (1, ("grade", "-"), b""),
    (2, ("inspect",), b""),
    (2, ("grade", "new"), b""),
    (2, ("grade", GOOD, "--rubric", "lab7"), b""),
    (2, ("grade", GOOD, "--rubric", "new.toml"), b""),
    (2, ("grade", GOOD, "--rubric", "file.txt"), b""),
    (2, ("grade", GOOD, "--part", "task9"), b""),
    (2, ("grade", GOOD, "--format", "pdf"), b""),
    (2, ("grade", GOOD, "--save", "json"), b""),
    (2, ("grade", GOOD, "--save", "json=new/report.json"), b""),
    (2, ("grade", GOOD, "--fail-under", "many"), b""),
    (2, ("grade", GOOD, "--expect-rubric", "0" * 64), b""),
    (2, ("grade", GOOD, "--max-size", "-1"), b""),
    (2, ("grade", GOOD, "--hints", "all"), b""),
    (2, ("grade", GOOD, "--arg", "x"), b""),
    (2, ("grade", WRONG, "--fix", "file.txt/out"), b""),
    (2, ("grade", GOOD, WRONG), b""),
    (2, ("grade", GOOD, "--no-such-option"), b""),
    (0, ("inspect", GOOD), b""),
    (0, ("inspect", GOOD, "--joint", "base_left_wheel_joint=1"), b""),
    (1, ("inspect", "-"), NOT_XML),
    (2, ("inspect", GOOD, "--joint", "no_joint=1"), b""),
    (2, ("inspect", GOOD, "--relative-to", "no_link"), b""),
    (2, ("inspect", "new"), b""),
    (0, ("explain", "URDF001"), b""),
    (0, ("explain", "shows_box"), b""),
    (2, ("explain", "URDF999"), b""),
    (0, ("rubric", "list"), b""),
    (0, ("rubric", "show", "lab6"), b""),
    (0, ("rubric", "check", ROOT / "rubrics/lab6/rubric.toml"), b""),
    (2, ("rubric", "check", "file.txt"), b""),
    (2, ("rubric", "show", "lab7"), b""),
    (2, ("rubric", "new", "lab.toml", "--from", "new"), b""),
    (2, ("rubric", "copy", "lab7", "copy"), b""),
    (0, ("schema", "report"), b""),
    (2, ("schema", "reports"), b""),
    (2, ("batch", "new", "--gradebook", "book.db"), b""),
    (2, ("batch", "."), b""),
    (2, ("batch", ".", "--gradebook", "new/book.db"), b""),
    (2, ("mark", "ash", "essay", "1", *BOOK), b""),
    (2, ("mark", "ash", "essay", "many", *BOOK), b""),
    (2, ("extend", "ash", "tomorrow", *BOOK), b""),
    (2, ("review", *BOOK), b""),
    (2, ("stats", *BOOK), b""),
    (2, ("export", "csv", *BOOK), b""),
    (2, ("export", "pdf", *BOOK), b""),
    (2, ("diff", "no.db"), b""),
    (2, ("gradebook", "merge", "no.db", "file.txt"), b""),
    (2, ("bundle", "gradescope", "new/out.zip"), b""),
)  # fmt: skip


@pytest.mark.parametrize(("code", "arguments", "stdin"), ROWS, ids=[f"{k}-{row[1][:1]}" for k, row in enumerate(ROWS)])
def test_exit_code(code: int, arguments: Sequence[object], stdin: bytes, tmp_path: Path) -> None:
    """0 and 1 come with a report, 2 with an explanation on standard error only, and nothing with a traceback."""
    (tmp_path / "file.txt").write_text("some text\n")
    done = run_with_input(arguments, stdin, folder=tmp_path)
    assert done.returncode == code, done
    assert bool(done.stdout) == (code != 2), done
    assert b"Traceback" not in done.stderr
    if code == 2:
        assert done.stderr.startswith(b"grader: ") or not arguments
        assert sorted(path.name for path in tmp_path.iterdir()) == ["file.txt"]
