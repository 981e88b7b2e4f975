"""A walk of an editor: a broken file, completion, a definition, a rename, in labs and a workspace of several packages.

`python -m tests.editor.test_walk` prints the requests and their answers as a table.
"""

import asyncio
import shutil
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import pytest
from lsprotocol import types as lsp

from tests.command_line import ROOT
from tests.editor.client import Editor, editor

pytestmark = pytest.mark.slow

_LAB6 = "my_robot/urdf/my_robot.urdf"
_XACRO = "diffdrive_robot/urdf/diffdrive.urdf.xacro"
_DRIVE = "diffdrive_robot/launch/diffdrive.launch.py"
_CIRCLE = "diffdrive_robot/scripts/drive_circle.py"
_LAUNCH = "src/cart_bringup/launch/cart.launch.py"
_ROBOT = "src/cart_description/urdf/cart.urdf.xacro"
_FILTER = "src/cart_nodes/cart_nodes/filter.py"
_WATCH = "src/cart_watch/src/watch.cpp"
_MANIFEST = "src/cart_bringup/package.xml"


class _Step(NamedTuple):
    """A request about a text in a file, and a part of its answer."""

    request: str
    path: str
    text: str
    inside: int
    expected: str
    typed: str = ""  # in place of the text before the request; `|` is where the cursor is


_WALKS: dict[str, Sequence[_Step]] = {
    "rubrics/lab6": (
        _Step("open", _LAB6, "", 0, "0 problems"),
        _Step("problems", _LAB6, '<child link="lidar"/>', 0, "URDF001", '<child link="'),
        _Step("complete", _LAB6, '<child link="lidar"/>', 0, "lidar", '<child link="|'),
        _Step("complete", _LAB6, "</robot>", 0, "visual", '<link name="arm">\n  <vis|'),
        _Step("hover", _LAB6, '<link name="lidar">', 13, "pose in `base_footprint`"),
        _Step("definition", _LAB6, '<child link="lidar"/>', 14, f"{_LAB6}:27"),
        _Step("rename", _LAB6, '<link name="lidar">', 13, f"{_LAB6}: 27, 38"),
        _Step("rename", _LAB6, '<parent link="base_link"/>', 15, f"{_LAB6}: "),
        _Step("fold", _LAB6, "", 0, "27-33"),
    ),
    "rubrics/diffdrive": (
        _Step("open", _XACRO, "", 0, "0 problems"),
        _Step("complete", _DRIVE, 'arguments=["joint_state_broadcaster"]', 0, "diff_drive_controller", 'arguments=["|'),
        _Step("definition", _DRIVE, '"/cmd_vel"', 3, f"{_CIRCLE}:14"),
        _Step("definition", _DRIVE, '"diffdrive.rviz"', 3, "diffdrive_robot/rviz/diffdrive.rviz:1"),
        _Step("definition", _DRIVE, '"drive_circle.py"', 3, f"{_CIRCLE}:1"),
        _Step("rename", _DRIVE, '"/cmd_vel"', 3, f"{_DRIVE}: 32; {_CIRCLE}: 14"),
        _Step("rename", _DRIVE, '["diff_drive_controller"', 3, f"diffdrive_robot/config/controllers.yaml: 8, 11; {_DRIVE}: 32, 38"),
        _Step("rename", _XACRO, "${side}_wheel_joint", 14, "builds the name"),
        _Step("links", _DRIVE, "", 0, "diffdrive_robot/config/controllers.yaml"),
        _Step("symbols", _DRIVE, "", 0, "spawner diff_drive_controller"),
    ),
    "tests/editor/cart": (
        _Step("complete", _LAUNCH, '"bridge.yaml"', 0, "bridge.yaml", '"|'),
        _Step("definition", _LAUNCH, 'executable="filter"', 13, f"{_FILTER}:26"),
        _Step("definition", _FILTER, "import Obstacle", 8, "src/cart_msgs/msg/Obstacle.msg:1"),
        _Step("definition", _MANIFEST, "<exec_depend>cart_nodes<", 15, "src/cart_nodes/package.xml:3"),
        _Step("references", _WATCH, '"obstacle", 10', 3, f"{_FILTER}:12"),
        _Step("hover", _LAUNCH, '"scan_raw"', 2, "subscription: /filter"),
        _Step("rename", _WATCH, '"obstacle", 10', 3, f"{_FILTER}: 12; {_WATCH}: 16"),
        _Step("rename", _ROBOT, 'link name="lidar_link"', 12, f"{_FILTER}: 21; {_WATCH}: 26"),
        _Step("rename", _LAUNCH, '["wheel_controller"', 3, f"{_LAUNCH}: 39, 40"),
        _Step("rename", _LAUNCH, '"/wheel_controller/cmd_vel"', 22, "controllers.yaml:6 may have this topic"),
        _Step("rename", _LAUNCH, '"cart_nodes"', 3, "a package is not renamed here"),
    ),
}  # fmt: skip


async def _answer(one: Editor, step: _Step) -> str:
    """Return the answer to a request in a few words; the file is as it was afterwards."""
    before = one.text(step.path)
    at = lsp.Position(0, 0)
    if step.text:
        start, _, rest = before.partition(step.text)
        typed, _, behind = (step.typed or step.text).partition("|")
        if step.typed:
            await one.type(step.path, f"{start}{typed}{behind}\n{rest}")
        rows = f"{start}{typed if step.typed else step.text[: step.inside]}".split("\n")
        at = lsp.Position(len(rows) - 1, len(rows[-1]))
    try:
        return await _ANSWERS[step.request](one, one.document(step.path), at)
    finally:
        if step.typed:
            await one.type(step.path, before)


async def _opened(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    return f"{len(one.found())} problems"


async def _problems(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    return ", ".join(row.rpartition(" ")[2] for row in one.found())


async def _complete(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    items = await one.client.text_document_completion_async(lsp.CompletionParams(document, at))
    assert isinstance(items, lsp.CompletionList)
    return ", ".join(item.label for item in items.items)


async def _hover(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    hover = await one.client.text_document_hover_async(lsp.HoverParams(document, at))
    assert hover is not None and isinstance(hover.contents, lsp.MarkupContent)
    return " ".join(hover.contents.value.replace("\\", "").split())


async def _definition(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    located = await one.client.text_document_definition_async(lsp.DefinitionParams(document, at))
    assert isinstance(located, list | tuple)
    return _places(one, [each for each in located if isinstance(each, lsp.Location)])


async def _references(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    every = lsp.ReferenceParams(lsp.ReferenceContext(True), document, at)
    return _places(one, await one.client.text_document_references_async(every) or ())


async def _rename(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    try:
        edit = await one.client.text_document_rename_async(lsp.RenameParams(document, at, "other"))
    except Exception as error:  # noqa: BLE001  why it is refused
        return f"refused: {error}"
    assert edit is not None and edit.changes is not None
    return "; ".join(
        f"{_path(one, uri)}: {', '.join(str(each.range.start.line + 1) for each in changes)}"
        for uri, changes in sorted(edit.changes.items())
    )


async def _links(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    links = await one.client.text_document_document_link_async(lsp.DocumentLinkParams(document))
    return ", ".join(_path(one, link.target or "") for link in links or ())


async def _symbols(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    asked = lsp.DocumentSymbolParams(document)
    return ", ".join(
        symbol.name for symbol in await one.client.text_document_document_symbol_async(asked) or ()
    )


async def _fold(one: Editor, document: lsp.TextDocumentIdentifier, at: lsp.Position) -> str:
    ranges = await one.client.text_document_folding_range_async(lsp.FoldingRangeParams(document))
    return ", ".join(f"{each.start_line + 1}-{each.end_line + 1}" for each in ranges or ())


_ANSWERS = {
    "open": _opened, "problems": _problems, "complete": _complete, "hover": _hover,
    "definition": _definition, "references": _references, "rename": _rename,
    "links": _links, "symbols": _symbols, "fold": _fold,
}  # fmt: skip


def _path(one: Editor, uri: str) -> str:
    return uri.removeprefix(one.root.as_uri() + "/")


def _places(one: Editor, places: Sequence[lsp.Location]) -> str:
    return ", ".join(f"{_path(one, each.uri)}:{each.range.start.line + 1}" for each in places)


async def _walk(root: Path, steps: Sequence[_Step]) -> list[str]:
    async with editor(root) as one:
        for path in dict.fromkeys(step.path for step in steps):
            await one.open(path)
        return [await _answer(one, step) for step in steps]


@pytest.mark.parametrize("folder", _WALKS)
def test_a_walk(folder: str, tmp_path: Path) -> None:
    """Each request has the part of its answer that is expected, and a broken file hinders none."""
    root = Path(shutil.copytree(ROOT / folder, tmp_path / "ws"))
    answers = asyncio.run(_walk(root, _WALKS[folder]))
    for step, answer in zip(_WALKS[folder], answers, strict=True):
        assert step.expected in answer, step


if __name__ == "__main__":
    for name, its_steps in _WALKS.items():
        with tempfile.TemporaryDirectory() as top:
            copied = Path(shutil.copytree(ROOT / name, Path(top) / "ws"))
            for asked, given in zip(its_steps, asyncio.run(_walk(copied, its_steps)), strict=True):
                what = (asked.typed or asked.text).replace("\n", " ")
                print(f"| {Path(name).name} | {asked.request} | `{what}` | {given[:100]} |")
