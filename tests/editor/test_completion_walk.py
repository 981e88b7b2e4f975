"""A walk of completion: positions in each kind of file, where what one would type is among the first names.

`python -m tests.editor.test_completion_walk` prints each position that falls short.
"""

import asyncio
import shutil
import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from lsprotocol import types as lsp

from tests.command_line import ROOT
from tests.editor.client import Editor, editor

pytestmark = pytest.mark.slow

_HERE = Path(__file__).parent
_WORKSPACE = ROOT / "tests/editor/ferry"
_FIRST = 5  # names that one sees at once


class _Row(NamedTuple):
    """A position: where `text` of a file is replaced with `typed`, the cursor is at `|`."""

    path: str
    text: str
    typed: str
    expected: str


def _rows() -> Iterator[tuple[str, _Row]]:
    tables = tomllib.loads((_HERE / "completion_walk.toml").read_text(encoding="utf-8"))
    for name, table in tables.items():
        for row in table["rows"]:
            yield name, _Row(**{"path": table["path"], **row})


def shown_names(items: list[lsp.CompletionItem], line: str, column: int) -> list[str]:
    """Return the names as an editor lists them: those that go on with what is typed, sorted."""
    shown = []
    for item in sorted(items, key=lambda each: each.sort_text or each.label):
        edit = item.text_edit
        assert isinstance(edit, lsp.TextEdit)
        typed = line[edit.range.start.character : column]
        if (item.filter_text or item.label).lower().startswith(typed.lower()):
            shown.append(item.label)
    return shown


async def complete(one: Editor, row: _Row) -> list[str]:
    """Return what is offered where a text is typed in place of another one, and undo that."""
    before = one.text(row.path)
    start, _, rest = before.partition(row.text)
    typed, _, behind = row.typed.partition("|")
    one.type_on(row.path, f"{start}{typed}{behind}{rest}")
    lines = f"{start}{typed}".split("\n")
    at = lsp.Position(len(lines) - 1, len(lines[-1]))
    asked = lsp.CompletionParams(one.document(row.path), at)
    answer = await one.client.text_document_completion_async(asked)
    one.type_on(row.path, before)
    nothing = lsp.HoverParams(one.document(row.path), lsp.Position(0, 0))
    await one.client.text_document_hover_async(nothing)  # so that it is looked at
    assert isinstance(answer, lsp.CompletionList)
    return shown_names([*answer.items], lines[-1], len(lines[-1]))


async def _walk(root: Path) -> list[tuple[str, _Row, list[str]]]:
    offered = []
    async with editor(root) as one:
        for path in dict.fromkeys(row.path for _, row in _rows()):
            await one.open(path)
        for kind, row in _rows():
            offered.append((kind, row, await complete(one, row)))
    return offered


def test_offers_what_one_would_type(tmp_path: Path) -> None:
    """In each kind of file, what is meant is among the first five names, at every position."""
    root = Path(shutil.copytree(_WORKSPACE, tmp_path / "ws"))
    short = []
    for kind, row, names in asyncio.run(_walk(root)):
        if row.expected not in names[:_FIRST]:
            short.append((kind, row.typed, row.expected, names[:_FIRST]))
    assert short == []


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as top:
        copied = Path(shutil.copytree(_WORKSPACE, Path(top) / "ws"))
        walked = asyncio.run(_walk(copied))
        reached = [row for _, row, names in walked if row.expected in names[:_FIRST]]
        for its_kind, its_row, its_names in walked:
            if its_row not in reached:
                print(f"{its_kind}: {its_row.typed!r}: {its_row.expected}, not {its_names[:8]}")
        print(f"{len(reached)} of {len(walked)}")
