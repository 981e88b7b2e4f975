"""The process that an editor talks to: it passes messages on to a worker process, which reads.

A worker that uses too much processor time is ended by the system. Another one then gets what the
editor has said, and leaves out the file that took too long until its text changes.
"""

import json
import os
import selectors
import signal
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from typing import Any, BinaryIO, NamedTuple

from lsprotocol import types as lsp
from lsprotocol.converters import get_converter
from pygls.uris import to_fs_path
from pygls.workspace import PositionCodec, TextDocument

from grader.app.editor.edited_files import SkippedText
from grader.app.editor.reading_limits import MAX_FILE_SECONDS, SharedPath
from grader.base.patterns import on_use
from grader.base.processor_time import INSPECT_SECONDS
from grader.base.text import printable_path

LOOKED = "$/grader/looked"  # a worker has looked at the files; the editor is not told
_Message = dict[str, Any]
# What is asked about one place is answered in any case, before an editor seems to hang: nothing,
# until the worker has read the files.
_NOTHING_YET = {
    lsp.TEXT_DOCUMENT_HOVER: None,
    lsp.TEXT_DOCUMENT_DEFINITION: None,
    lsp.TEXT_DOCUMENT_REFERENCES: None,
    lsp.TEXT_DOCUMENT_PREPARE_RENAME: None,
    lsp.TEXT_DOCUMENT_DOCUMENT_LINK: None,
    lsp.TEXT_DOCUMENT_FOLDING_RANGE: None,
    lsp.TEXT_DOCUMENT_DOCUMENT_SYMBOL: None,
    lsp.TEXT_DOCUMENT_COMPLETION: {"isIncomplete": True, "items": []},
}
_PATIENCE = 0.7  # seconds of the worker's processor time before that
_MAX_PATIENCE = 5.0  # seconds of any time
_POLL = 0.1  # seconds between two looks at what waits for an answer
_POLL_UNSENT = 0.005  # and at what waits to be sent
_MAX_ENDED = 5  # workers that end before one has looked at the files
_CHUNK = 65_536  # bytes
_CHANGES = (
    lsp.TEXT_DOCUMENT_DID_OPEN,
    lsp.TEXT_DOCUMENT_DID_CHANGE,
    lsp.TEXT_DOCUMENT_DID_CLOSE,
    lsp.TEXT_DOCUMENT_DID_SAVE,
    lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES,
)
Skipped = Mapping[str, SkippedText]  # by the real paths of the files
_Serve = Callable[[BinaryIO, BinaryIO, SharedPath, Skipped], None]


_LENGTH = on_use(rb"(?i)content-length:[ \t]*(\d{1,12})[ \t]*(?=\r|\Z)")


class _Stream:
    """The messages in the bytes that arrive, which have headers before each."""

    def __init__(self) -> None:
        self._data = bytearray()

    def messages(self, data: bytes) -> Iterator[bytes]:
        """Yield the messages that are complete with more bytes."""
        self._data += data
        while True:
            head, mark, rest = self._data.partition(b"\r\n\r\n")
            # Behind a wrong header, that of the next message follows the text of the one before.
            lengths = _LENGTH.findall(head)
            length = int(lengths[-1]) if lengths else 0
            if not mark or len(rest) < length:
                return
            self._data = rest[length:]
            yield bytes(rest[:length])


def _framed(body: bytes) -> bytes:
    return b"Content-Length: %d\r\n\r\n" % len(body) + body


class _Worker:
    """A process that serves, with the pipes to it."""

    def __init__(self, serve: _Serve, skipped: Skipped) -> None:
        self.reading = SharedPath()
        self.stream = _Stream()
        self._unsent = bytearray()
        its_input, self.input = os.pipe()
        self.output, its_output = os.pipe()
        self.pid = os.fork()
        if self.pid == 0:
            os.close(self.input)
            os.close(self.output)
            _serve_and_end(serve, its_input, its_output, self.reading, skipped)
        os.close(its_input)
        os.close(its_output)
        os.set_blocking(self.input, False)  # a worker that is busy takes nothing

    @property
    def has_unsent(self) -> bool:
        """Whether some bytes were not taken yet."""
        return bool(self._unsent)

    def send(self, data: bytes = b"") -> None:
        """Send bytes, and what was not taken before; what is not taken now is kept."""
        self._unsent += data
        with suppress(BlockingIOError, BrokenPipeError):
            while self._unsent:
                sent = os.write(self.input, self._unsent[:_CHUNK])
                del self._unsent[:sent]

    def seconds(self) -> float:
        """Return the processor time that it has used; any time where the system does not tell."""
        with suppress(OSError, ValueError):
            if sys.platform == "linux":
                return time.clock_gettime((~self.pid << 3) | 2)  # see clock_getcpuclockid(3)
        return time.monotonic()

    def end(self) -> int:
        """End it, if it has not ended, and return its exit code: below 0 that of a signal."""
        with suppress(ProcessLookupError):
            os.kill(self.pid, signal.SIGKILL)
        os.close(self.input)
        os.close(self.output)
        _, status = os.waitpid(self.pid, 0)
        return os.waitstatus_to_exitcode(status)


def _serve_and_end(
    serve: _Serve, its_input: int, its_output: int, reading: SharedPath, skipped: Skipped
) -> None:
    """Serve in this process, which has been forked, and end it."""
    code = 1
    try:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # the process that started it handles it
        nowhere = os.open(os.devnull, os.O_RDWR)
        os.dup2(nowhere, 0)
        os.dup2(nowhere, 1)
        serve(os.fdopen(its_input, "rb"), os.fdopen(its_output, "wb"), reading, skipped)
        code = 0
    finally:
        os._exit(code)


class _Waiting(NamedTuple):
    """A request that has no answer yet."""

    method: str
    start: float  # the processor time of the worker
    clock: float


class Supervisor:
    """Passes messages between an editor and a worker, and starts another worker when one ends."""

    def __init__(self, serve: _Serve, editor_input: int, editor_output: int) -> None:
        self._serve = serve
        self._input = editor_input
        self._output = editor_output
        self._stream = _Stream()
        self._selector = selectors.DefaultSelector()
        self._worker: _Worker | None = None
        self._is_ended = False
        self._ended = 0  # workers since the last look
        self._is_first = True  # whether the worker is the first one
        self._waiting: dict[object, _Waiting] = {}
        self._start: list[bytes] = []  # what starts a session, and the changes of its folders
        self._texts: dict[str, TextDocument] = {}  # the files that are open, by URI
        self._seen: dict[str, str] = {}  # their texts at the last look
        self._skipped: dict[str, SkippedText] = {}
        self._named: set[str] = set()
        self._codec = PositionCodec()
        self._converter = get_converter()

    def run(self) -> None:
        """Pass messages until the editor ends the session."""
        self._selector.register(self._input, selectors.EVENT_READ)
        self._start_worker()
        try:
            while not self._is_ended:
                self._step()
        finally:
            self._selector.close()
            if self._worker:
                self._worker.end()

    def _step(self) -> None:
        """Wait for messages, and for a worker that takes what was not sent."""
        worker = self._worker
        pause = _POLL if self._waiting else None
        if worker and worker.has_unsent:
            worker.send()
            pause = _POLL_UNSENT
        for key, _ in self._selector.select(pause):
            data = os.read(key.fd, _CHUNK)
            if key.fd == self._input:
                self._take_from_editor(data)
            elif worker and self._worker is worker:
                self._take_from_worker(worker, data)
        self._answer_late()

    def _take_from_editor(self, data: bytes) -> None:
        self._is_ended = not data
        for body in self._stream.messages(data):
            try:
                message = json.loads(body)
            except (ValueError, RecursionError):
                self._refuse(None, lsp.ErrorCodes.ParseError, "the message is no JSON")
                continue
            is_request = isinstance(message, dict) and isinstance(message.get("method", ""), str)
            if is_request and isinstance(message.get("id", ""), int | str):
                self._pass_to_worker(message, body)
            else:
                reason = "a message is an object with a method and an id, a number or a text"
                self._refuse(None, lsp.ErrorCodes.InvalidRequest, reason)

    def _pass_to_worker(self, message: _Message, body: bytes) -> None:
        method = message.get("method", "")
        if method == lsp.SHUTDOWN:
            self._answer(message.get("id"), None)
            return
        if method == lsp.EXIT:
            self._is_ended = True
            return
        with suppress(Exception):  # what is said wrongly is for the worker to refuse
            self._follow(method, message.get("params"), body)
        if not self._worker and method in _CHANGES:
            self._start_worker()  # with the change
        elif self._worker:
            if method and "id" in message and not self._note_request(message):
                return
            self._worker.send(_framed(body))
        elif method and "id" in message:
            self._answer(message["id"], _NOTHING_YET.get(method))

    def _note_request(self, message: _Message) -> bool:
        """Note that a request waits; return whether it does: wrong parameters are refused."""
        assert self._worker
        wrong = self._why_wrong(message)
        if wrong:
            self._refuse(message["id"], lsp.ErrorCodes.InvalidParams, wrong)
            return False
        waiting = _Waiting(message["method"], self._worker.seconds(), time.monotonic())
        self._waiting[message["id"]] = waiting
        return True

    def _follow(self, method: str, params: Any, body: bytes) -> None:
        """Keep what another worker has to know."""
        match method:
            case lsp.INITIALIZE | lsp.INITIALIZED | lsp.WORKSPACE_DID_CHANGE_WORKSPACE_FOLDERS:
                self._start.append(body)
            case lsp.TEXT_DOCUMENT_DID_OPEN:
                item = params["textDocument"]
                self._texts[item["uri"]] = TextDocument(
                    item["uri"],
                    item["text"],
                    item["version"],
                    item["languageId"],
                    position_codec=self._codec,
                )
            case lsp.TEXT_DOCUMENT_DID_CHANGE:
                self._change(self._converter.structure(params, lsp.DidChangeTextDocumentParams))
            case lsp.TEXT_DOCUMENT_DID_CLOSE:
                self._texts.pop(params["textDocument"]["uri"], None)
            case lsp.WORKSPACE_DID_CHANGE_WATCHED_FILES:
                for change in params["changes"]:
                    self._skipped.pop(_read_path(change["uri"]), None)

    def _change(self, params: lsp.DidChangeTextDocumentParams) -> None:
        document = self._texts.get(params.text_document.uri)
        if document is not None:
            for change in params.content_changes:
                document.apply_change(change)
            document.version = params.text_document.version
            self._skipped.pop(_read_path(document.uri), None)

    def _take_from_worker(self, worker: _Worker, data: bytes) -> None:
        if not data:
            self._replace_worker(worker)
            return
        for body in worker.stream.messages(data):
            message = json.loads(body)
            method = message.get("method")
            if method == LOOKED:
                self._note_look()
            elif method is None:
                self._pass_answer(message, body)
            elif "id" in message and not self._is_first:  # asked by the first worker already
                answer = {"jsonrpc": "2.0", "id": message["id"], "result": None}
                worker.send(_framed(json.dumps(answer).encode()))
            else:
                self._write(body)

    def _pass_answer(self, message: _Message, body: bytes) -> None:
        """Pass an answer on, unless the request was answered before."""
        waiting = self._waiting.pop(message.get("id"), None)
        if not waiting:
            return
        if waiting.method == lsp.INITIALIZE and "result" in message:
            encoding = message["result"]["capabilities"].get("positionEncoding")
            self._codec = PositionCodec(encoding or lsp.PositionEncodingKind.Utf16)
        self._write(body)

    def _note_look(self) -> None:
        """Keep the texts that were looked at."""
        self._ended = 0
        for uri, document in self._texts.items():
            path = _read_path(uri)
            if path not in self._skipped:
                self._seen[uri] = document.source
                self._named.discard(path)

    def _answer_late(self) -> None:
        """Answer with nothing what waits for too long."""
        for number, waiting in list(self._waiting.items()):
            if waiting.method in _NOTHING_YET and self._worker:
                used = self._worker.seconds() - waiting.start
                if used > _PATIENCE or time.monotonic() - waiting.clock > _MAX_PATIENCE:
                    del self._waiting[number]
                    self._answer(number, _NOTHING_YET[waiting.method])

    def _replace_worker(self, worker: _Worker) -> None:
        """Start another worker in place of one that has ended."""
        self._selector.unregister(worker.output)
        path = worker.reading.read()
        code = worker.end()
        self._worker = None
        self._is_first = False
        for number, waiting in self._waiting.items():
            self._answer(number, _NOTHING_YET.get(waiting.method))
        self._waiting.clear()
        for skipped, text in self._find_causes(path).items():
            self._skipped[skipped] = text
            if skipped not in self._named:
                self._named.add(skipped)
                self._say(f"{_reason(code, printable_path(skipped))}: {_WHAT_IS_SHOWN}")
        self._ended += 1
        if self._ended < _MAX_ENDED:
            self._start_worker()
        else:
            self._ended = _MAX_ENDED - 1  # once more after each change

    def _find_causes(self, path: str) -> dict[str, SkippedText]:
        """Return the texts that may have ended a worker, by the paths of their files.

        These are the texts that have changed since the last look, else that of the file that was
        read.
        """
        causes = {}
        slow = None
        for uri, document in self._texts.items():
            before = self._seen.get(uri)
            changed = _read_path(uri)
            if before not in (None, document.source) and changed not in self._skipped:
                causes[changed] = SkippedText(document.source, before)
            if changed == path:
                slow = document.source
        if not causes and path:
            causes[path] = SkippedText(slow, None)
        return causes

    def _start_worker(self) -> None:
        """Start a worker, and tell it what the editor has said."""
        worker = self._worker = _Worker(self._serve, dict(self._skipped))
        self._selector.register(worker.output, selectors.EVENT_READ)
        for body in self._start:
            worker.send(_framed(body))
        for document in self._texts.values():
            item = lsp.TextDocumentItem(
                document.uri,
                document.language_id or "",
                document.version or 0,
                document.source,
            )
            opened = lsp.DidOpenTextDocumentNotification(lsp.DidOpenTextDocumentParams(item))
            worker.send(_framed(json.dumps(self._converter.unstructure(opened)).encode()))

    def _say(self, message: str) -> None:
        """Show a message to the user."""
        params = {"type": lsp.MessageType.Warning.value, "message": message}
        shown = {"jsonrpc": "2.0", "method": lsp.WINDOW_SHOW_MESSAGE, "params": params}
        self._write(json.dumps(shown).encode())

    def _why_wrong(self, message: _Message) -> str:
        """Return why the parameters of a request are not those of its method; else nothing."""
        kinds = lsp.METHOD_TO_TYPES.get(message["method"])
        try:
            if kinds is not None:
                self._converter.structure({"jsonrpc": "2.0", **message}, kinds[0])
        except Exception as error:  # noqa: BLE001  cattrs raises groups of any errors
            return f"the parameters are not those of {message['method']} ({type(error).__name__})"
        return ""

    def _refuse(self, number: object, code: lsp.ErrorCodes, reason: str) -> None:
        """Answer with an error."""
        error = {"code": code.value, "message": reason}
        self._write(json.dumps({"jsonrpc": "2.0", "id": number, "error": error}).encode())

    def _answer(self, number: object, result: object) -> None:
        self._write(json.dumps({"jsonrpc": "2.0", "id": number, "result": result}).encode())

    def _write(self, body: bytes) -> None:
        """Write a message to the editor; one that is gone has ended the session."""
        left = memoryview(_framed(body))
        try:
            while left:
                left = left[os.write(self._output, left) :]
        except BrokenPipeError:
            self._is_ended = True


_WHAT_IS_SHOWN = "it is read again when it changes, and until then what was found before is shown"


def _read_path(uri: str) -> str:
    """Return the real path of a file; empty for what is no file."""
    path = to_fs_path(uri)
    return os.path.realpath(path) if path else ""


def _reason(code: int, name: str) -> str:
    """Return why a worker ended while it read a file."""
    if code == -signal.SIGPROF:
        return f"reading {name} takes more than {MAX_FILE_SECONDS:g} s of processor time"
    if code == -signal.SIGXCPU:
        return f"reading {name} takes more than {INSPECT_SECONDS} s of processor time"
    return f"reading {name} ended the process that read it"
