"""Follow the tutorials in docs/. `python -m tests.tutorial` writes the output of the commands into their pages.

An output on the page stays as it is if it matches, where "..." stands for any text; else each of its lines does.
"""

import re
import shlex
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from tests.command_line import HANG_TIMEOUT, ROOT, run_with_input

PAGE = ROOT / "docs" / "write-a-rubric.md"
CODE_PAGE = ROOT / "docs" / "code-lab.md"
_NAME = re.compile(r"`([\w./-]+)`:\s*$")


class Step(NamedTuple):
    """The commands of a block and what they print, as the page has it and in fact, with the last exit code."""

    commands: str
    shown: str | None
    printed: str
    code: int


def run_commands(commands: str, folder: Path) -> tuple[str, int]:
    """Return what commands print in a folder, and the exit code of the last one."""
    printed, code = "", 0
    for command in commands.splitlines():
        words = shlex.split(command, comments=True)
        if words[0] != "grader":
            subprocess.run(command, shell=True, check=True, cwd=folder, timeout=HANG_TIMEOUT)
            continue
        words, target = (words[:-2], words[-1]) if words[-2:-1] == [">"] else (words, "")
        words, source = (
            (words[:-2], (folder / words[-1]).read_bytes())
            if words[-2:-1] == ["<"]
            else (words, b"")
        )
        done = run_with_input(words[1:], source, folder=folder)
        code = done.returncode
        if target:
            (folder / target).write_bytes(done.stdout)
        printed += done.stderr.decode() + ("" if target else done.stdout.decode())
    return printed, code


def follow(
    page: str, folder: Path, run: Callable[[str, Path], tuple[str, int]] = run_commands
) -> tuple[str, list[Step]]:
    """Do what a page says in a folder; return the page with current outputs, and what was run."""
    steps: list[Step] = []
    pieces = re.split(r"(^```\w*\n.*?^```\n)", page, flags=re.DOTALL | re.MULTILINE)
    for index in range(1, len(pieces), 2):
        kind, _, text = pieces[index].removeprefix("```").removesuffix("```\n").partition("\n")
        name = _NAME.search(pieces[index - 1])
        if kind == "sh":
            printed, code = run(text, folder)
            is_shown = pieces[index + 1] == "\n" and pieces[index + 2].startswith("```\n")
            shown = pieces[index + 2][4:-4] if is_shown else None
            if shown is not None and not _matches(shown, printed):
                pieces[index + 2] = f"```\n{_shortened(printed.rstrip(), shown)}\n```\n"
            steps.append(Step(text, shown, printed, code))
        elif kind == "diff" and name:
            _change(folder / name[1], text)
        elif kind and name:
            (folder / name[1]).write_text(text, encoding="utf-8")
    return "".join(pieces), steps


def _change(file: Path, diff: str) -> None:
    """Apply the hunks of a diff, which are separated by `@@`; what a hunk changes is in the file."""
    text = file.read_text(encoding="utf-8")
    for hunk in _hunks(diff):
        old, new = ("".join(f"{line[1:]}\n" for line in hunk if line[:1] != sign) for sign in "+-")
        found = re.search(_pattern(old, "[^\n]*"), text, re.MULTILINE)
        assert found is not None, f"{file.name} does not contain:\n{old}"
        text = text[: found.start()] + new + text[found.end() :]
    file.write_text(text, encoding="utf-8")


def _hunks(diff: str) -> Iterator[list[str]]:
    for hunk in diff.split("@@\n"):
        yield hunk.splitlines()


def _matches(shown: str, printed: str) -> bool:
    return re.fullmatch(_pattern(shown.strip(), ".*?"), printed.strip(), re.DOTALL) is not None


def _shortened(printed: str, shown: str) -> str:
    """Return what is printed, with each line of a page that has "..." among words and still matches."""
    kept = [line for line in shown.splitlines() if "..." in line and line.strip() != "..."]
    return "\n".join(
        next((known for known in kept if _matches(known, line)), line)
        for line in printed.splitlines()
    )


def _pattern(text: str, anything: str) -> str:
    """Return an expression for a text in which "..." stands for anything."""
    return "^" + anything.join(map(re.escape, text.split("...")))


if __name__ == "__main__":
    for written in (PAGE, CODE_PAGE):
        with TemporaryDirectory() as folder:
            current, _ = follow(written.read_text(encoding="utf-8"), Path(folder))
            written.write_text(current, encoding="utf-8")
