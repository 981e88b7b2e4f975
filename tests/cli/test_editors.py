"""The files for editors in docs/editors/ read what the format concise prints."""

import json
import re
import shutil
import subprocess
from pathlib import Path
from typing import NamedTuple

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT, run

pytestmark = pytest.mark.slow

EDITORS = ROOT / "docs/editors"
# What is inspected or graded, where something is wrong in URDFs, in packages, and in criteria.
INPUTS = (
    "submissions/lab6/raw-xacro",
    "submissions/lab6/several-mistakes",
    "tests/corpus/given/moveit",
)
COMMANDS = [(command, path) for path in INPUTS for command in ("inspect", "grade")]
ERRORFORMAT = {
    "%f": r"(?P<path>.+?)",
    "%l": r"(?P<line>\d+)",
    "%c": r"(?P<column>\d+)",
    "%m": r"(?P<rest>.+)",
}


class Line(NamedTuple):
    """A line of the output, as an editor reads it."""

    path: str
    line: int
    column: int
    rest: str  # the code and the message


def printed(command: str, path: str) -> list[str]:
    """Return the lines that a command prints."""
    done = run((command, ROOT / path, "--format", "concise"))
    return done.stdout.decode().splitlines()


def expected(command: str, path: str) -> list[tuple[int, str]]:
    """Return the line and the code of each finding, by another format."""
    done = run((command, ROOT / path, "--format", "sarif"))
    [log] = json.loads(done.stdout)["runs"]
    places = [result["locations"][0]["physicalLocation"]["region"] for result in log["results"]]
    codes = [result["ruleId"] for result in log["results"]]
    return [(place["startLine"], code) for place, code in zip(places, codes, strict=True)]


def matcher() -> re.Pattern[str]:
    """Return the pattern of the matcher for VS Code."""
    [task] = json.loads((EDITORS / "tasks.json").read_text(encoding="utf-8"))["tasks"]
    assert task["args"] == ["inspect", ".", "--format", "concise"]
    pattern = task["problemMatcher"]["pattern"]
    groups = {key: value for key, value in pattern.items() if key != "regexp"}
    assert groups == {"file": 1, "line": 2, "column": 3, "code": 4, "message": 5}
    return re.compile(pattern["regexp"])


def errorformat() -> re.Pattern[str]:
    """Return the pattern that the errorformat for Vim stands for."""
    text = (EDITORS / "grader.vim").read_text(encoding="utf-8")
    setting = re.findall("errorformat=(.*)", text)[0].replace("\\ ", " ")
    parts = re.split(r"(%[flcm])", setting.split(",")[0])
    return re.compile("".join(ERRORFORMAT.get(part, re.escape(part)) for part in parts))


@pytest.mark.parametrize(("command", "path"), COMMANDS)
def test_the_patterns_read_each_line(command: str, path: str) -> None:
    """Path, line, code and message are those of the findings."""
    lines = printed(command, path)
    found = [matcher().fullmatch(line) for line in lines]
    assert [(int(it[2]), it[4]) for it in found if it] == expected(command, path)
    assert all((ROOT / it[1]).is_file() and it[5] for it in found if it)
    for line, groups in zip(lines, found, strict=True):
        other = errorformat().fullmatch(line)
        assert groups is not None
        assert other is not None
        assert other.groups() == (*groups.groups()[:3], f"{groups[4]} {groups[5]}")


@pytest.mark.skipif(shutil.which("vim") is None, reason="needs Vim")
def test_vim_fills_the_quickfix_list(tmp_path: Path) -> None:
    """Vim reads the output with the compiler's settings."""
    lines = printed("inspect", INPUTS[0])
    (tmp_path / "compiler").mkdir()
    shutil.copy(EDITORS / "grader.vim", tmp_path / "compiler")
    (tmp_path / "output").write_text("\n".join(["a note", *lines]) + "\n", encoding="utf-8")
    script = (
        f"set runtimepath^={tmp_path}\ncompiler grader\ncgetfile {tmp_path}/output\n"
        "let rows = map(getqflist(), '[v:val.lnum, v:val.col, v:val.text]')\n"
        f"call writefile([json_encode(rows)], '{tmp_path}/rows')\nqall!\n"
    )
    (tmp_path / "script.vim").write_text(script)
    subprocess.run(
        ["vim", "-u", "NONE", "-N", "-es", "-S", tmp_path / "script.vim"],
        cwd=ROOT, timeout=HANG_TIMEOUT, check=False, stdin=subprocess.DEVNULL,
    )  # fmt: skip
    rows = json.loads((tmp_path / "rows").read_text(encoding="utf-8"))
    groups = [matcher().fullmatch(line) for line in lines]
    assert rows == [[int(it[2]), int(it[3]), f"{it[4]} {it[5]}"] for it in groups if it]
