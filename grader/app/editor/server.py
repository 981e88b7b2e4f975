"""grader lsp: a language server on standard input and output."""

import asyncio
import gc
import logging
import math
import os
import sys
import time
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, BinaryIO, TypeVar

from lsprotocol import types as lsp
from pygls.lsp.server import LanguageServer
from pygls.uris import from_fs_path, to_fs_path

from grader import __version__
from grader.app.editor import (
    completions,
    describing,
    fixes,
    folding,
    logs,
    places,
    renaming,
    signatures,
    symbols,
)
from grader.app.editor.diagnostics import SOURCE, make_diagnostics
from grader.app.editor.edited_files import EditedFiles
from grader.app.editor.look import Look
from grader.app.editor.reading_limits import ReadingLimits, SharedPath
from grader.app.editor.session import EditorSession, SupersededError
from grader.app.editor.supervisor import LOOKED, Skipped, Supervisor
from grader.app.editor.text_ranges import TextRanges
from grader.base.errors import GraderError
from grader.base.processor_time import CAN_LIMIT
from grader.base.text import counted
from grader.files.limits import ROBOT_ENDINGS

_PAUSE = 0.1  # seconds after a key before the files are looked at
_LONGEST = 1.0  # seconds that one may type without being shown what is wrong
_MANIFEST = "package.xml"
_T = TypeVar("_T")
_Diagnostics = Mapping[str, list[lsp.Diagnostic]]


# What is asked about one place of a file, with what answers it.
_ANSWERS = {
    lsp.TEXT_DOCUMENT_HOVER: places.also_where_broken(describing.hover),
    lsp.TEXT_DOCUMENT_DEFINITION: places.also_where_broken(places.definitions),
    lsp.TEXT_DOCUMENT_REFERENCES: places.also_where_broken(places.references),
    lsp.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT: places.also_where_broken(places.highlights),
    lsp.TEXT_DOCUMENT_COMPLETION: completions.completions,
    lsp.TEXT_DOCUMENT_SIGNATURE_HELP: signatures.signature,
    lsp.TEXT_DOCUMENT_PREPARE_RENAME: renaming.prepared,
}
_OPTIONS = {
    lsp.TEXT_DOCUMENT_COMPLETION: lsp.CompletionOptions(trigger_characters=list("\"'/({[. <")),
    lsp.TEXT_DOCUMENT_SIGNATURE_HELP: lsp.SignatureHelpOptions(trigger_characters=[" ", '"']),
}


class _GraderServer(LanguageServer):
    """The server of one editor, with a session for each folder that is open in it."""

    def __init__(self, rubric: str, limits: ReadingLimits, skipped: Skipped) -> None:
        super().__init__("grader", __version__, lsp.TextDocumentSyncKind.Incremental)
        self.rubric = rubric
        self._limits = limits
        self._skipped = skipped
        self.sessions: dict[Path, EditorSession] = {}
        self._pool = ThreadPoolExecutor(max_workers=2)
        self._refreshing: dict[Path, asyncio.Task[None]] = {}
        self._changed: dict[Path, float] = {}  # when what is not shown yet began to change
        self._unseen: set[Path] = set()  # what has changed while a look ends anyway
        self._published: dict[Path, set[str]] = {}
        self._complaint = ""

    def open_folders(self) -> None:
        """Start a session for each folder of the editor."""
        for folder in self.workspace.folders.values():
            path = to_fs_path(folder.uri)
            if path is not None:
                self.session_in(Path(os.path.realpath(path)))

    def close_folder(self, uri: str) -> None:
        """End the session of a folder of the editor, and show nothing of it any more."""
        path = to_fs_path(uri)
        root = Path(os.path.realpath(path)) if path is not None else None
        if not root or not self.sessions.pop(root, None):
            return
        waiting = self._refreshing.pop(root, None)
        if waiting is not None:
            waiting.cancel()
        self._changed.pop(root, None)
        self._unseen.discard(root)
        self._publish(root, {})
        del self._published[root]

    def session_in(self, root: Path) -> EditorSession:
        """Return the session of a folder, which is started if there is none."""
        if root not in self.sessions:
            self.sessions[root] = EditorSession(root, self.rubric, self._limits, self._skipped)
            self.refresh(root)
        return self.sessions[root]

    def find_session(self, uri: str) -> tuple[EditorSession, str] | None:
        """Return the session that a file belongs to, with its path there.

        It is None for a file outside of the folders. In an editor without a folder it is that of
        its package, or of a robot's folder.
        """
        name = to_fs_path(uri)
        if name is None:
            return None
        file = Path(os.path.realpath(name))
        roots = [root for root in self.sessions if file.is_relative_to(root)]
        around = max(roots, key=lambda root: len(root.parts), default=None)
        if not around and not self.workspace.folders:
            around = _choose_folder(file)
        if not around:
            return None
        session = self.session_in(around)
        path = session.files.find_path(file)
        return (session, path) if path is not None else None

    def report_server_error(self, error: Exception, source: Any) -> None:
        """Say nothing: the editor gets what is wrong as the answer to its request."""

    def change(self, uri: str, change: Callable[[EditedFiles, str], None]) -> None:
        """Change the files of a session, and look at them again soon."""
        session_and_path = self.find_session(uri)
        if session_and_path is not None:
            session, path = session_and_path
            session.change(lambda files: change(files, path))
            self.refresh(session.files.root)

    def refresh(self, root: Path) -> None:
        """Look at the files of a folder again soon, in place of what is waiting.

        A look that is due ends before.
        """
        self._changed.setdefault(root, time.monotonic())
        waiting = self._refreshing.get(root)
        if waiting is not None and not waiting.done():
            if self._is_due(root):
                self._unseen.add(root)
                return
            waiting.cancel()
        self._refreshing[root] = asyncio.ensure_future(self._refresh(root))

    def _is_due(self, root: Path) -> bool:
        """Return whether one has typed for long without being shown what is wrong."""
        return time.monotonic() - self._changed.get(root, math.inf) > _LONGEST

    async def _refresh(self, root: Path) -> None:
        await asyncio.sleep(_PAUSE)
        await self._look_at(root)
        if root in self._unseen:
            self._unseen.discard(root)
            self._refreshing.pop(root, None)
            self.refresh(root)

    async def _look_at(self, root: Path) -> None:
        """Look at the files of a folder, and show what is wrong."""
        session = self.sessions[root]
        start = time.monotonic()
        try:
            is_due = self._is_due(root)
            look = await self.in_thread(lambda: session.look(ends_anyway=is_due))
            diagnostics = await self.in_thread(partial(make_diagnostics, look, root))
            self._publish(root, diagnostics)
            self._changed.pop(root, None)
            self.protocol.notify(LOOKED)
            self._complain(session.complaint)
            graded = await self.in_thread(lambda: look.graded.mistakes)
            if graded:
                diagnostics = await self.in_thread(partial(make_diagnostics, look, root, graded))
                self._publish(root, diagnostics)
            seconds = time.monotonic() - start
            files = counted(len(look.tree.files), "file")
            text = f"{root.name}: looked at {files} in {seconds:.2f} s"
            self.window_log_message(lsp.LogMessageParams(lsp.MessageType.Log, text))
        except SupersededError:
            pass
        except GraderError as error:
            self._complain(str(error))
        except Exception as error:  # noqa: BLE001  a fault of a reader must not end the server
            typed = next(iter(session.files.typed), _MANIFEST)
            self._publish(root, {typed: [_fault(error)]})

    def _complain(self, message: str) -> None:
        """Show why the files are not looked at, or not graded, once."""
        if message and message != self._complaint:
            self._complaint = message
            self.window_show_message(lsp.ShowMessageParams(lsp.MessageType.Warning, message))

    async def in_thread(self, work: Callable[[], _T]) -> _T:
        """Return what some work returns that is done beside the messages of the editor."""

        def limited_work() -> _T:
            with self._limits.working():
                return work()

        return await asyncio.get_running_loop().run_in_executor(self._pool, limited_work)

    def _publish(self, root: Path, diagnostics: _Diagnostics) -> None:
        """Show what is wrong in a folder; of files in which nothing is wrong any more, nothing."""
        for path in sorted({*diagnostics, *self._published.get(root, ())}):
            uri = from_fs_path(str(root / path)) or ""
            params = lsp.PublishDiagnosticsParams(uri, diagnostics.get(path, []))
            self.text_document_publish_diagnostics(params)
        self._published[root] = set(diagnostics)

    async def answer(
        self,
        uri: str,
        position: lsp.Position,
        make: Callable[[Look, "places.TextPlace"], _T],
    ) -> _T | None:
        """Return an answer about a place in a file, from a look at the files as they are now.

        It is None where there is none.
        """
        session_and_path = self.find_session(uri)
        if session_and_path is None:
            return None
        session, path = session_and_path

        def work() -> _T:
            look = session.look()
            lines = TextRanges(look, session.files.root).lines(path)
            line, column = lines.place(position)
            return make(look, places.TextPlace(session.files.root, path, lines, line, column))

        try:
            return await self.in_thread(work)
        except (GraderError, SupersededError):
            return None


def _choose_folder(file: Path) -> Path | None:
    """Return the folder to look at for a single file; None where it is no part of a robot."""
    for folder in file.parents:
        if (folder / _MANIFEST).is_file():
            return folder
    return file.parent if file.name.endswith(ROBOT_ENDINGS) else None


def _fault(error: Exception) -> lsp.Diagnostic:
    start = lsp.Position(0, 0)
    message = f"the grader itself failed ({type(error).__name__}); please report it"
    return lsp.Diagnostic(
        lsp.Range(start, start), message, severity=lsp.DiagnosticSeverity.Error, source=SOURCE
    )


def _make_server(rubric: str, limits: ReadingLimits, skipped: Skipped) -> _GraderServer:
    """Return the server of an editor.

    Args:
        rubric: What it grades with, an id or a file; empty for that of the settings, or none.
        limits: The limits of processor time.
        skipped: The texts that take too long to read, by the paths of their files.
    """
    server = _GraderServer(rubric, limits, skipped)
    _follow_disk(server)
    _follow_texts(server)
    _answer_about_places(server)
    _offer_changes(server)
    return server


def _follow_texts(server: _GraderServer) -> None:
    """Let a server follow what is typed."""

    @server.feature(lsp.TEXT_DOCUMENT_DID_OPEN)
    def opened(ls: _GraderServer, params: lsp.DidOpenTextDocumentParams) -> None:
        text = params.text_document.text
        ls.change(params.text_document.uri, lambda files, path: files.type(path, text))

    @server.feature(lsp.TEXT_DOCUMENT_DID_CHANGE)
    def changed(ls: _GraderServer, params: lsp.DidChangeTextDocumentParams) -> None:
        uri = params.text_document.uri
        text = ls.workspace.get_text_document(uri).source
        ls.change(uri, lambda files, path: files.type(path, text))

    @server.feature(lsp.TEXT_DOCUMENT_DID_CLOSE)
    def closed(ls: _GraderServer, params: lsp.DidCloseTextDocumentParams) -> None:
        ls.change(params.text_document.uri, lambda files, path: files.close(path))


def _follow_disk(server: _GraderServer) -> None:
    """Let a server follow which folders are open, and what is saved."""

    @server.feature(lsp.INITIALIZED)
    def initialized(ls: _GraderServer, _: lsp.InitializedParams) -> None:
        ls.open_folders()
        watched = ls.client_capabilities.workspace
        files = watched.did_change_watched_files if watched is not None else None
        if files is not None and files.dynamic_registration:
            options = {"watchers": [{"globPattern": "**/*"}]}
            method = lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES
            registration = lsp.Registration("watched-files", method, options)
            ls.client_register_capability(lsp.RegistrationParams([registration]))

    @server.feature(lsp.TEXT_DOCUMENT_DID_SAVE)
    def saved(ls: _GraderServer, params: lsp.DidSaveTextDocumentParams) -> None:
        ls.change(params.text_document.uri, lambda files, _: files.read_again())

    @server.feature(lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES)
    def written(ls: _GraderServer, params: lsp.DidChangeWatchedFilesParams) -> None:
        for uri in {change.uri for change in params.changes}:
            ls.change(uri, lambda files, _: files.read_again())

    @server.feature(lsp.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS)
    def folders_changed(ls: _GraderServer, params: lsp.DidChangeWorkspaceFoldersParams) -> None:
        for folder in params.event.removed:
            ls.close_folder(folder.uri)
        ls.open_folders()


def _answer_about_places(server: _GraderServer) -> None:
    """Let a server answer what an editor asks about one place of a file."""

    def register(method: str, make: Callable[[Look, places.TextPlace], Any]) -> None:
        @server.feature(method, _OPTIONS.get(method))
        async def answer(ls: _GraderServer, params: Any) -> Any:
            return await ls.answer(params.text_document.uri, params.position, make)

    for method, make in _ANSWERS.items():
        register(method, make)


def _offer_changes(server: _GraderServer) -> None:
    """Let a server list names, links and what can be folded, correct problems, and rename."""

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
    async def answer_symbols(ls: _GraderServer, params: lsp.DocumentSymbolParams) -> Any:
        return await ls.answer(params.text_document.uri, lsp.Position(0, 0), symbols.in_document)

    @server.feature(lsp.TEXT_DOCUMENT_DOCUMENT_LINK)
    async def answer_links(ls: _GraderServer, params: lsp.DocumentLinkParams) -> Any:
        return await ls.answer(params.text_document.uri, lsp.Position(0, 0), places.links)

    @server.feature(lsp.TEXT_DOCUMENT_FOLDING_RANGE)
    async def answer_folding(ls: _GraderServer, params: lsp.FoldingRangeParams) -> Any:
        document = ls.workspace.get_text_document(params.text_document.uri)
        return await ls.in_thread(partial(folding.folding_ranges, document.path, document.source))

    @server.command(logs.EXPLAIN)
    async def explain(ls: _GraderServer, log: str) -> list[str]:
        sessions = list(ls.sessions.values())
        return await ls.in_thread(partial(logs.explain, sessions, log))

    @server.feature(lsp.WORKSPACE_SYMBOL)
    async def all_symbols(ls: _GraderServer, params: lsp.WorkspaceSymbolParams) -> Any:
        symbols_of_roots = []
        for session in list(ls.sessions.values()):
            find = partial(symbols.in_workspace, session, params.query)
            symbols_of_roots += await ls.in_thread(find)
        return symbols_of_roots

    options = lsp.CodeActionOptions(code_action_kinds=[lsp.CodeActionKind.QuickFix])

    @server.feature(lsp.TEXT_DOCUMENT_CODE_ACTION, options)
    async def code_actions(ls: _GraderServer, params: lsp.CodeActionParams) -> Any:
        make = partial(fixes.actions, wanted=params.range)
        return await ls.answer(params.text_document.uri, params.range.start, make)

    @server.feature(lsp.TEXT_DOCUMENT_RENAME, lsp.RenameOptions(prepare_provider=True))
    async def rename(ls: _GraderServer, params: lsp.RenameParams) -> Any:
        make = partial(renaming.renamed, new=params.new_name)
        return await ls.answer(params.text_document.uri, params.position, make)


def serve(rubric: str) -> None:
    """Answer an editor on standard input and output until it says that it ends.

    A worker process reads, where the system has limits of processor time.
    """
    logging.disable()  # what is refused is an answer, and no traceback on standard error
    gc.enable()  # unlike other commands, this one may run for hours
    if CAN_LIMIT:
        os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # none in a process that forks
        supervisor = Supervisor(
            partial(_serve_in_worker, rubric), sys.stdin.fileno(), sys.stdout.fileno()
        )
        supervisor.run()
    else:
        _make_server(rubric, ReadingLimits(), {}).start_io()


def _serve_in_worker(
    rubric: str,
    its_input: BinaryIO,
    its_output: BinaryIO,
    reading: SharedPath,
    skipped: Skipped,
) -> None:
    """Answer the process that started this one."""
    _make_server(rubric, ReadingLimits(reading), skipped).start_io(its_input, its_output)
