"""The words that a shell offers for arguments and options.

They are found in the text of files: to load a rubric or a robot takes longer than a person waits
for a completion.
"""

import re
from collections.abc import Iterable, Iterator
from pathlib import Path

import typer

from grader.files.reading import shipped_folder

_RUBRIC_FILE = "rubric.toml"
_MAX_SIZE = 1024 * 1024  # bytes of a file
_CODE, _NAME = r"^\[([A-Z]+[0-9]{3})\]", r"^\[(\w+)\]"


def offer_rubrics(incomplete: str) -> list[str]:
    """Return the rubrics that come with the grader, and the .toml files of the current folder."""
    ids = [file.parent.name for file in shipped_folder("rubrics").glob(f"*/{_RUBRIC_FILE}")]
    return _starting(incomplete, [*sorted(ids), *sorted(map(str, Path().glob("*.toml")))])


def offer_parts(context: typer.Context, incomplete: str) -> list[str]:
    """Return the parts of the rubric."""
    return _starting(incomplete, _ids_in(_rubric_file(context), "part"))


def offer_explained(context: typer.Context, incomplete: str) -> list[str]:
    """Return the criteria of the rubric, the problem codes and the checks."""
    examples = shipped_folder("docs", "examples")
    checks = re.findall(_NAME, _text_of(examples / "checks.toml"), re.MULTILINE)
    checks.remove("frames")  # what the examples have in common
    criteria = _ids_in(_rubric_file(context), "criterion")
    return _starting(incomplete, [*criteria, *offer_codes(""), *checks, "releases"])


def offer_codes(incomplete: str) -> list[str]:
    """Return the problem codes and the names of rules."""
    from grader.workspace.api import RULES

    codes: list[str] = []
    for file in sorted(shipped_folder("docs", "examples").glob("*.toml")):
        codes += re.findall(_CODE, _text_of(file), re.MULTILINE)
    return _starting(incomplete, [*codes, *RULES])


def _starting(incomplete: str, words: Iterable[str]) -> list[str]:
    """Return each word once that begins as it is typed."""
    return [word for word in dict.fromkeys(words) if word.startswith(incomplete)]


def _text_of(file: Path) -> str:
    """Return the beginning of a file; empty without it."""
    if not file.is_file():
        return ""
    with file.open(encoding="utf-8", errors="replace") as opened:
        return opened.read(_MAX_SIZE)


def _rubric_file(context: typer.Context) -> Path:
    from grader.lab.rubric.rubric_files import DEFAULT_RUBRIC  # late: an inspection has no rubric

    name = context.params.get("rubric") or DEFAULT_RUBRIC
    shipped = shipped_folder("rubrics") / name / _RUBRIC_FILE
    return shipped if shipped.is_file() else Path(name)


def _ids_in(file: Path, table: str) -> Iterator[str]:
    """Yield the ids in the tables of a kind."""
    current = ""
    for line in _text_of(file).splitlines():
        match = re.match(r"""id\s*=\s*["']([^"']+)""", line)
        if line.startswith("["):
            current = line.strip("[] ")
        elif current == table and match:
            yield match[1]
