"""A file that takes too long to read ends the process that reads it, and not the server."""

import asyncio
import shutil
import sys
from pathlib import Path

import pytest
from lsprotocol import types as lsp

from tests.command_line import HANG_TIMEOUT, ROOT
from tests.editor.client import STRICT_PYTHON, Editor, editor

_URDF = "my_robot/urdf/my_robot.urdf"
_HANGS = "<!-- hangs -->"
_TOO_LONG = "takes more than 5 s of processor time"
# A server whose reader never ends with a text that hangs.
_SLOW = """
from grader.app.editor import reading_limits, server, session
reading_limits.MAX_FILE_SECONDS = {seconds}
look_at = session.look_at

def look_or_hang(tree, *others):
    for file in tree.files.values():
        hangs = b"<!-- hangs -->" in (tree.read(file.path, 1_000_000) or b"")
        while hangs:
            pass
    return look_at(tree, *others)

session.look_at = look_or_hang
server.serve("")
"""
pytestmark = [
    pytest.mark.exhaustive,
    pytest.mark.skipif(sys.platform == "win32", reason="has no limits of processor time"),
]


@pytest.fixture
def lab6(tmp_path: Path) -> Path:
    return Path(shutil.copytree(ROOT / "rubrics/lab6", tmp_path / "lab"))


def _command(seconds: float) -> tuple[str, ...]:
    return (*STRICT_PYTHON, "-c", _SLOW.replace("{seconds}", str(seconds)))


async def _hover(one: Editor, path: str, text: str) -> lsp.Hover | None:
    params = lsp.HoverParams(one.document(path), one.position(path, text))
    answer = one.client.text_document_hover_async(params)
    return await asyncio.wait_for(answer, HANG_TIMEOUT)


def test_answers_while_a_reader_hangs(lab6: Path) -> None:
    """What is asked about a place is answered, and so is the end."""

    async def act() -> None:
        async with editor(lab6, command=_command(1000)) as one:
            await one.open(_URDF)
            assert await _hover(one, _URDF, "lidar") is not None
            one.type_on(_URDF, one.text(_URDF) + _HANGS)
            assert await _hover(one, _URDF, "lidar") is None
            where = one.position(_URDF, "lidar")
            params = lsp.CompletionParams(one.document(_URDF), where)
            answer = one.client.text_document_completion_async(params)
            offered = await asyncio.wait_for(answer, HANG_TIMEOUT)
            assert offered == lsp.CompletionList(is_incomplete=True, items=())

    asyncio.run(act())


def test_keeps_what_it_found_before(lab6: Path) -> None:
    """The file is named once, what was found in it before stays, and its next text counts."""

    async def act() -> None:
        async with editor(lab6, command=_command(1)) as one:
            await one.open(_URDF)
            wrong = one.text(_URDF).replace('"base_lidar_joint" type="fixed"', '"j" type="fixd"')
            await one.type(_URDF, wrong)
            rows = one.found()
            assert rows != []
            for number in range(2):
                one.type_on(_URDF, f"{wrong}<!-- {number} -->{_HANGS}")
                await one.looked()
                assert one.found() == rows
            assert await _hover(one, _URDF, "base_link") is not None
            await one.type(_URDF, one.text(_URDF))
            assert one.found() == []
            [named] = one.client.messages
            assert f"{_URDF} {_TOO_LONG}" in named.message

    asyncio.run(act())


def test_reads_the_other_files(lab6: Path) -> None:
    """A file that hangs from the start is not read until it has changed on the disk."""
    slow = lab6 / "my_robot/README.md"
    slow.write_text(_HANGS, encoding="utf-8")

    async def act() -> None:
        async with editor(lab6, command=_command(1)) as one:
            [named] = one.client.messages
            assert f"README.md {_TOO_LONG}" in named.message
            await one.open(_URDF)
            await one.type(_URDF, one.text(_URDF).replace('"fixed"', '"fixd"', 1))
            assert one.found() != []
            slow.write_text("# A robot\n", encoding="utf-8")
            event = lsp.FileEvent(one.uri("my_robot/README.md"), lsp.FileChangeType.Changed)
            params = lsp.DidChangeWatchedFilesParams([event])
            one.client.workspace_did_change_watched_files(params)
            await one.looked()
            assert one.found() != []

    asyncio.run(act())


def test_survives_a_reader_that_always_ends(lab6: Path) -> None:
    """It is started again so many times, and again when the editor changes something."""
    ends = (
        "import os, signal\n"
        "from grader.app.editor import server, session\n"
        "session.look_at = lambda *_: os.kill(os.getpid(), signal.SIGKILL)\n"
        "server.serve('')\n"
    )

    async def act() -> None:
        command = (*STRICT_PYTHON, "-c", ends)
        async with editor(lab6, looks=False, command=command) as one:
            for _ in range(2):
                assert await _hover(one, _URDF, "lidar") is None
                item = lsp.TextDocumentItem(one.uri(_URDF), "xml", 1, one.text(_URDF))
                one.client.text_document_did_open(lsp.DidOpenTextDocumentParams(item))

    asyncio.run(act())


def test_takes_a_text_that_no_pipe_holds(lab6: Path) -> None:
    """A long text arrives whole, also where it is no message at all."""

    async def act() -> None:
        async with editor(lab6) as one:
            await one.open(_URDF)
            text = one.text(_URDF).replace('"fixed"', '"fixd"', 1)
            await one.type(_URDF, f"{text}<!-- {'x' * 300_000} -->")
            assert one.found() != []
            server = one.client._server
            assert server is not None
            assert server.stdin is not None
            server.stdin.write(b"Content-Length: 4\r\n\r\nnullContent-Length: 1\r\n\r\n{")
            await one.type(_URDF, one.text(_URDF))
            assert one.found() == []

    asyncio.run(act())
