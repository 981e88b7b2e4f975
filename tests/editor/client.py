"""An editor that talks to `grader lsp` in a process of its own."""

import asyncio
import logging
import sys
import tomllib
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator, Sequence
from contextlib import AsyncExitStack, asynccontextmanager, contextmanager
from pathlib import Path

from lsprotocol import types as lsp
from pytest_lsp import LanguageClient, client_capabilities
from pytest_lsp.client import make_test_lsp_client

from tests.command_line import HANG_TIMEOUT, ROOT

_SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["pytest"]
_FILTERS = [f"-W{line}" for line in _SETTINGS["ini_options"]["filterwarnings"]]
STRICT_PYTHON = (sys.executable, *_FILTERS)  # warnings are errors, as in pytest
COMMAND = (*STRICT_PYTHON, "-m", "grader", "lsp")


class Editor:
    """An editor with one folder."""

    def __init__(self, client: LanguageClient, root: Path) -> None:
        self.client, self.root = client, root
        self._versions: dict[str, int] = {}

    def uri(self, path: str) -> str:
        return (self.root / path).as_uri()

    def document(self, path: str) -> lsp.TextDocumentIdentifier:
        return lsp.TextDocumentIdentifier(self.uri(path))

    def text(self, path: str) -> str:
        return (self.root / path).read_text(encoding="utf-8")

    async def looked(self, count: int = 1) -> None:
        """Wait until the server has looked at the files so many times more."""
        for _ in range(count):
            message = self.client.wait_for_notification("window/logMessage")
            await asyncio.wait_for(message, HANG_TIMEOUT)

    async def open(self, path: str) -> None:
        item = lsp.TextDocumentItem(self.uri(path), "text", 1, self.text(path))
        self._versions[path] = 1
        self.client.text_document_did_open(lsp.DidOpenTextDocumentParams(item))
        await self.looked()

    async def close(self, path: str) -> None:
        """Close a file without saving it."""
        del self._versions[path]
        self.client.text_document_did_close(lsp.DidCloseTextDocumentParams(self.document(path)))
        await self.looked()

    async def close_all(self) -> None:
        """Close what is open, so that the files on the disk count again."""
        for path in [*self._versions]:
            await self.close(path)

    async def type(self, path: str, text: str) -> None:
        """Replace the text of an open file, and wait for what is said of it."""
        self.type_on(path, text)
        await self.looked()

    def type_on(self, path: str, text: str) -> None:
        """Replace the text of an open file."""
        self._versions[path] += 1
        document = lsp.VersionedTextDocumentIdentifier(
            uri=self.uri(path), version=self._versions[path]
        )
        change = lsp.TextDocumentContentChangeWholeDocument(text)
        params = lsp.DidChangeTextDocumentParams(document, [change])
        self.client.text_document_did_change(params)

    def found(self) -> list[str]:
        """Return what is wrong, as path:line:column-column: code."""
        rows = []
        for uri, diagnostics in self.client.diagnostics.items():
            path = uri.removeprefix(self.root.as_uri() + "/")
            for each in diagnostics:
                start, end = each.range.start, each.range.end
                rows.append(f"{path}:{start.line}:{start.character}-{end.character}: {each.code}")
        return sorted(rows)

    def position(self, path: str, text: str, *, inside: int = 1) -> lsp.Position:
        """Return the position inside of the first place of a text in a file."""
        for number, line in enumerate(self.text(path).split("\n")):
            if text in line:
                return lsp.Position(number, line.index(text) + inside)
        raise ValueError(text)


@asynccontextmanager
async def editor(
    root: Path, *options: str, looks: bool = True, command: Sequence[str] = COMMAND
) -> AsyncIterator[Editor]:
    """Start a server for a folder, and end it as editors do; it has to end with code 0."""
    logging.getLogger("pygls").setLevel(logging.CRITICAL)
    client = make_test_lsp_client()
    await client.start_io(*command, *options)
    folder = lsp.WorkspaceFolder(root.as_uri(), root.name)
    params = lsp.InitializeParams(
        capabilities=client_capabilities("neovim"),
        root_uri=root.as_uri(),
        workspace_folders=[folder],
    )
    await client.initialize_session(params)
    one = Editor(client, root)
    if looks:
        await one.looked()
    yield one
    await client.shutdown_session()
    assert client._server is not None
    await client._server.wait()
    assert client._server.returncode == 0


Act = Callable[[Editor], Coroutine[None, None, None]]


@contextmanager
def shared_editor(root: Path, *options: str) -> Iterator[Callable[[Act], None]]:
    """Start a server for several tests; yield a function that does what one of them does, and closes all files."""

    async def run_and_close(act: Act) -> None:
        try:
            await act(one)
        finally:
            await one.close_all()

    with asyncio.Runner() as runner:
        stack = AsyncExitStack()
        one = runner.run(stack.enter_async_context(editor(root, *options)))
        yield lambda act: runner.run(run_and_close(act))
        runner.run(stack.aclose())
