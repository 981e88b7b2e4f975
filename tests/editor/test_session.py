"""What an editor sees of files that are typed is what `grader inspect` says of the same files on the disk."""

import gc
import random
import tracemalloc
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import NamedTuple

import pytest

from grader.app.commands.inspect_urdf import InspectRequest, inspect_path
from grader.app.editor.edited_files import EditedFiles
from grader.app.editor.session import EditorSession
from grader.base.source import Location
from grader.files.reading import URDF_LIMIT
from grader.report.findings import Finding, findings_in_inspection
from grader.report.formats import InspectFormat
from grader.ros.xml.xml_problems import RECOVERED
from tests.command_line import ROOT
from tests.workspace.random_edits import Files, edited_text, files_of
from tests.workspace.test_kept import twenty_packages

_WORKSPACES = [
    "rubrics/diffdrive",
    "rubrics/lab6",
    "tests/labs/beacon",
    "tests/labs/laundry",
    "tests/labs/twolink",
]


class _Row(NamedTuple):
    code: str
    location: Location
    message: str


def _inspected(folder: Path) -> list[_Row]:
    request = InspectRequest(
        path=str(folder),
        robot="",
        joint=None,
        relative_to=None,
        distro=None,
        output_format=InspectFormat.JSON,
        save=None,
        max_size=URDF_LIMIT,
        arg=None,
        watch=False,
        select=None,
        ignore=None,
    )
    return _rows(findings_in_inspection(inspect_path(request, lambda _: None)))


def _rows(findings: Sequence[Finding]) -> list[_Row]:
    """Return findings without what only an editor shows, assumptions, and what only an inspection does."""
    rows = []
    for finding in findings:
        if finding.rule.id != RECOVERED.code and finding.rule.name != "robot-stands":
            rows.append(_Row(finding.rule.id, finding.location, finding.message))
    return rows


def _check_edits(folder: Path, copy: Path, count: int) -> None:
    """Type random edits, each of which is also saved."""
    draw = random.Random(folder.name)
    original = files_of(folder)
    _write(copy, original)
    session, files = EditorSession(copy), dict(original)
    for number in range(count):
        path = draw.choice(sorted(files))
        data = edited_text(files[path] if number % 6 else original[path], draw)
        text = data.decode("utf-8", "ignore")
        files[path] = text.encode()
        session.change(partial(EditedFiles.type, path=path, text=text))
        _write(copy, files)
        assert _rows(session.look().findings) == _inspected(copy), (number, path)


def _write(folder: Path, files: Files) -> None:
    for path, data in files.items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)


@pytest.mark.slow
@pytest.mark.parametrize("folder", _WORKSPACES)
def test_equals_an_inspection_of_the_saved_text(folder: str, tmp_path: Path) -> None:
    _check_edits(ROOT / folder, tmp_path / "ws", 12)


@pytest.mark.exhaustive
@pytest.mark.parametrize("folder", _WORKSPACES)
def test_equals_an_inspection_often(folder: str, tmp_path: Path) -> None:
    _check_edits(ROOT / folder, tmp_path / "ws", 380)


@pytest.mark.exhaustive
def test_equals_an_inspection_of_twenty_packages(tmp_path: Path) -> None:
    _write(tmp_path / "twenty", twenty_packages())
    _check_edits(tmp_path / "twenty", tmp_path / "ws", 30)


@pytest.mark.exhaustive
def test_memory_does_not_grow(tmp_path: Path) -> None:
    """In 200 changes, what is kept grows by less than a tenth.

    Of two times 200, since a table of the interpreter that was made before may be made anew in one of them.
    """
    _write(tmp_path / "ws", files_of(ROOT / "rubrics/diffdrive"))
    session = EditorSession(tmp_path / "ws")
    path = "diffdrive_robot/urdf/diffdrive.urdf.xacro"
    text = session.files.text(path)
    tracemalloc.start()
    sizes = []
    for number in range(500):
        typed = f"{text}<!-- {number} -->\n"
        session.change(partial(EditedFiles.type, path=path, text=typed))
        session.look()
        if number in (99, 299, 499):
            gc.collect()
            sizes.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    first, second, third = sizes
    assert min(second - first, third - second) < 0.1 * first
