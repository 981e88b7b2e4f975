"""A client that breaks the protocol gets an error as LSP has it, and the server goes on."""

import json
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import HANG_TIMEOUT, ROOT
from tests.editor.client import COMMAND

pytestmark = pytest.mark.slow

_PARSE, _REQUEST, _PARAMETERS = -32700, -32600, -32602
_FILE = ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf"
_PLACE = {"line": 0, "character": 0}


class _Client:
    """A client that writes what it is told."""

    def __init__(self) -> None:
        pipe = subprocess.PIPE
        self._process = subprocess.Popen(COMMAND, stdin=pipe, stdout=pipe)
        self.write(_framed({"jsonrpc": "2.0", "id": 1, "method": "initialize", "params": _START}))
        self.answer(1)

    def write(self, data: bytes) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(data)
        self._process.stdin.flush()

    def answer(self, number: int | None) -> dict[str, Any]:
        """Return the next message that answers a request of a number."""
        assert self._process.stdout is not None
        while True:
            length = 0
            while (line := self._process.stdout.readline().strip()) != b"":
                name, _, value = line.partition(b":")
                length = int(value) if name == b"Content-Length" else length
            message: dict[str, Any] = json.loads(self._process.stdout.read(length))
            if "method" not in message and message["id"] == number:
                return message

    def end(self) -> int:
        self.write(_framed({"jsonrpc": "2.0", "id": 9, "method": "shutdown"}))
        self.answer(9)
        self.write(_framed({"jsonrpc": "2.0", "method": "exit"}))
        with self._process:
            return self._process.wait(HANG_TIMEOUT)


_START: dict[str, Any] = {
    "processId": None,
    "rootUri": ROOT.joinpath("rubrics/lab6").as_uri(),
    "capabilities": {},
}


def _framed(message: object) -> bytes:
    body = message if isinstance(message, bytes) else json.dumps(message).encode()
    return b"Content-Length: %d\r\n\r\n%b" % (len(body), body)


def _asked(number: object, position: object, method: str = "hover") -> dict[str, Any]:
    parameters = {"textDocument": {"uri": Path(_FILE).as_uri()}, "position": position}
    return {
        "jsonrpc": "2.0",
        "id": number,
        "method": f"textDocument/{method}",
        "params": parameters,
    }


@pytest.fixture(scope="module")
def client() -> Iterator[_Client]:
    client = _Client()
    yield client
    assert client.end() == 0


_HOVER = json.dumps(_asked(5, _PLACE)).encode()


@pytest.mark.parametrize(
    ("data", "code"),
    [
        (_framed(_asked({"a": 1}, _PLACE)), _REQUEST),
        (_framed([_asked(5, _PLACE)]), _REQUEST),
        (_framed({"jsonrpc": "2.0", "id": 5, "method": 7}), _REQUEST),
        (_framed(b"[" * 200_000), _PARSE),
        (_framed(b'{"a":' * 20_000 + b"1" + b"}" * 20_000), _PARSE),
        (_framed(b"{nothing"), _PARSE),
        (b"Content-Length: abc\r\n\r\n" + _HOVER, _PARSE),
        (b"Content-Length: -5\r\n\r\n" + _HOVER, _PARSE),
    ],
    ids=range(8),
)
def test_a_message_that_is_none_is_refused(client: _Client, data: bytes, code: int) -> None:
    """The error has no id, and the next request is answered, also right behind a wrong header."""
    client.write(data + _framed(_asked(6, _PLACE)))
    assert client.answer(None)["error"]["code"] == code
    assert "error" not in client.answer(6)


@pytest.mark.parametrize("method", ["hover", "documentHighlight", "signatureHelp", "codeAction"])
@pytest.mark.parametrize(
    "position", [{"line": -1, "character": 0}, {"line": 2**63, "character": 0}, {"line": "a"}, None]
)
def test_wrong_parameters_are_refused(client: _Client, method: str, position: object) -> None:
    """The error has the id of the request."""
    client.write(_framed(_asked(7, position, method)) + _framed(_asked(6, _PLACE)))
    assert client.answer(7)["error"]["code"] == _PARAMETERS
    assert "error" not in client.answer(6)
