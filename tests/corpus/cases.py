"""Cases of the corpus: what a user gives to the command line, and what comes back. README.md describes their form."""

import atexit
import difflib
import json
import shlex
import shutil
import tomllib
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from itertools import takewhile
from pathlib import Path
from tempfile import mkdtemp
from typing import Any

from tests.command_line import ROOT, Done, run_with_input
from tests.corpus.outputs import contents, is_shown, kept, masked
from tests.corpus.results import results
from tests.corpus.steps import STEPS, copy, remove
from tests.edits_rubric import copy_with_edits

CORPUS = Path(__file__).parent

Expected = dict[str, str]  # exit, stdout, stderr and files/PATH; what is empty is left out


@cache
def _lab_with_edits() -> Path:
    """Return a copy of the rubric lab6 whose hints may show edits."""
    folder = Path(mkdtemp(prefix="grader-edits-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return copy_with_edits(folder / "lab6")


def _with_places(command: str, here: Path) -> str:
    """Return a command with the folders and the rubric that words in capitals stand for."""
    rubric = str(_lab_with_edits()) if "EDITS" in command else ""
    return command.replace("ROOT", str(ROOT)).replace("HERE", str(here)).replace("EDITS", rubric)


@dataclass(frozen=True, slots=True)
class Case:
    """Commands, run one after the other in a folder of their own, the files that are there before, and what is expected.

    `path` is the folder of the case, or the table in which it is the row `index`.
    """

    path: Path
    index: int
    expected: Expected
    about: str
    commands: tuple[str, ...]
    setup: tuple[
        str, ...
    ] = ()  # commands before them, which succeed and whose output is not compared
    copies: Mapping[str, str] = field(default_factory=dict)  # path here: path in the project
    removed: tuple[str, ...] = ()
    edits: tuple[
        tuple[str, str, str], ...
    ] = ()  # path, a text that stands there, the text that replaces it everywhere
    empty: tuple[str, ...] = ()  # files without content; a path that ends in a slash is a folder
    files: Mapping[str, str] = field(default_factory=dict)
    hex: Mapping[str, str] = field(default_factory=dict)  # files that are no text
    sizes: Mapping[str, int] = field(
        default_factory=dict
    )  # files that spaces follow up to this size
    links: Mapping[str, str] = field(default_factory=dict)  # path of a symlink: where it leads
    zips: Mapping[str, str] = field(
        default_factory=dict
    )  # path of an archive: the folder that moves into it
    variables: Mapping[str, str] = field(default_factory=dict)
    stdin: str = ""
    folder: str = ""  # where the commands run
    keep: tuple[str, ...] = ()  # patterns of the written files whose content is compared
    view: str = ""  # "results": of a JSON report, what is not passed, in one line each
    shown: tuple[str, ...] = ()  # criteria that this view shows even if they are passed

    @property
    def name(self) -> str:
        """Return the folder, or the table and what the row is about."""
        area = self.path.relative_to(CORPUS).with_suffix("").as_posix()
        return area if self.path.is_dir() else f"{area}: {self.about}"

    def outcome(self, here: Path) -> Expected:
        """Return what the commands print, their exit codes, and the files that they write, in an empty folder."""
        self._prepare(here)
        for command in self.setup:
            done = self._run(command, here)
            assert done.returncode == 0, done.stderr
        before = contents(here)
        found: Expected = {"exit": "", "stdout": "", "stderr": ""}
        for command in self.commands:
            step, *words = shlex.split(command) or [""]
            if step in STEPS:
                known = contents(here)
                STEPS[step](here, *words)
                before |= {
                    path: content
                    for path, content in contents(here).items()
                    if known.get(path) != content
                }
                continue
            done = self._run(command, here)
            heading = f"$ {' '.join(command.split()[:2])}\n" if len(self.commands) > 1 else ""
            found["exit"] += f"{' ' if found['exit'] else ''}{done.returncode}"
            found["stdout"] += heading + masked(self._shown(done), here)
            found["stderr"] += masked(done.stderr.decode(), here)
        written = [path for path, content in contents(here).items() if before.get(path) != content]
        books = {str(file.parent.relative_to(here)) for file in here.rglob("class.toml")}
        written = [path for path in written if is_shown(path, books, self.keep)]
        for path in written:
            found[f"files/{path}"] = masked(kept(path, here / path, self.keep), here)
        return {key: text for key, text in found.items() if text or key.startswith("files/")}

    def _run(self, command: str, here: Path) -> Done:
        words = shlex.split(_with_places(command, here))
        own = dict(word.split("=", 1) for word in takewhile(lambda word: "=" in word, words))
        variables = {
            name: text.replace("HERE", str(here))
            for name, text in {**self.variables, **own}.items()
        }
        return run_with_input(words[len(own) :], self.stdin.encode(), variables, here / self.folder)

    def _prepare(self, here: Path) -> None:
        if (self.path / "input").is_dir():
            shutil.copytree(self.path / "input", here, dirs_exist_ok=True)
        data = {path: b"" for path in self.empty if not path.endswith("/")}
        data |= {path: text.encode() for path, text in self.files.items()}
        data |= {path: bytes.fromhex(digits) for path, digits in self.hex.items()}
        for path in (
            *data,
            *self.links,
            *(f"{folder}x" for folder in self.empty if folder.endswith("/")),
        ):
            (here / path).parent.mkdir(parents=True, exist_ok=True)
        for path, source in self.copies.items():
            copy(here, str(ROOT / source), path)
        for path in self.removed:
            remove(here, path)
        for path, content in data.items():
            (here / path).write_bytes(content.ljust(self.sizes.get(path, 0)))
        for path, old, new in self.edits:
            text = (here / path).read_bytes().decode()
            assert old in text, f"{old!r} does not stand in {path}"
            (here / path).write_bytes(text.replace(old, new).encode())
        for path, target in self.links.items():
            (here / path).symlink_to(target)
        for path, folder in self.zips.items():
            with zipfile.ZipFile(here / path, "w") as archive:
                for file in sorted((here / folder).rglob("*")):
                    member = zipfile.ZipInfo.from_file(file, file.relative_to(here / folder))
                    member.date_time, member.external_attr = (
                        (2026, 1, 1, 0, 0, 0),
                        0,
                    )  # the same bytes everywhere
                    archive.writestr(member, b"" if file.is_dir() else file.read_bytes())
            shutil.rmtree(here / folder)

    def _shown(self, done: Done) -> str:
        report = (
            json.loads(done.stdout)
            if self.view == "results" and done.stdout.startswith(b"{")
            else {}
        )
        if "results" in report or "attention" in report:
            return "".join(f"{line}\n" for line in results(report, self.shown))
        return done.stdout.decode(errors="backslashreplace")


def changed_lines(before: Expected, now: Expected) -> Iterator[str]:
    """Yield the lines that differ."""
    for key in sorted({*before, *now}):
        texts = before.get(key, "").splitlines(), now.get(key, "").splitlines()
        yield from difflib.unified_diff(*texts, f"{key} before", f"{key} now", lineterm="", n=1)


@cache
def read_corpus() -> tuple[Case, ...]:
    """Return every case, by table and by folder; the tables are read once."""
    return tuple(_read_corpus())


def _read_corpus() -> Iterator[Case]:
    for path in sorted(CORPUS.rglob("*.toml")):
        for index, row in enumerate(
            tomllib.loads(path.read_text(encoding="utf-8")).get("case", [])
        ):
            found = {key: str(row.pop(key)) for key in ("exit", "stdout", "stderr") if key in row}
            found |= {f"files/{name}": text for name, text in row.pop("written", {}).items()}
            yield _case(path, index, found, row)
    for path in sorted(CORPUS.rglob("command")):
        folder, settings = path.parent / "expected", path.parent / "case.toml"
        files = [file for file in sorted(folder.rglob("*")) if file.is_file()]
        found = {file.relative_to(folder).as_posix(): file.read_bytes().decode() for file in files}
        row = (
            tomllib.loads(settings.read_text(encoding="utf-8"))
            if settings.exists()
            else {"about": path.parent.name}
        )
        yield _case(
            path.parent,
            0,
            found,
            {**row, "commands": path.read_text(encoding="utf-8").splitlines()},
        )


def _case(path: Path, index: int, expected: Expected, row: dict[str, Any]) -> Case:
    if "command" in row:
        row["commands"] = [row.pop("command")]
    given: dict[str, Any] = {
        key: tuple(value) if isinstance(value, list) else value for key, value in row.items()
    }
    return Case(path, index, expected, **given)
