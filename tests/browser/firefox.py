"""A headless Firefox that needs no driver: it answers the commands of Marionette on a port."""

import json
import shutil
import socket
import subprocess
import time
from pathlib import Path
from typing import Any

FIREFOX = shutil.which("firefox-esr") or shutil.which("firefox")
_PATIENCE = 60  # seconds


class Firefox:
    """A Firefox with a profile in a new folder. A call sends a command and returns the value of its answer."""

    def __init__(self, profile: Path) -> None:
        profile.mkdir()
        (profile / "user.js").write_text('user_pref("marionette.port", 0);\n', encoding="utf-8")  # any that is free
        options = ("--headless", "--marionette", "--remote-allow-system-access", "--profile", str(profile))
        self._process = subprocess.Popen([str(FIREFOX), *options], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        port, end = profile / "MarionetteActivePort", time.monotonic() + _PATIENCE
        while not port.exists() and time.monotonic() < end:
            time.sleep(0.1)
        self._socket = socket.create_connection(("127.0.0.1", int(port.read_text())), timeout=_PATIENCE)
        self._read()
        self("WebDriver:NewSession")

    def __call__(self, command: str, **parameters: object) -> Any:
        """Send a command and return the value of its answer."""
        message = json.dumps([0, 1, command, parameters]).encode()
        self._socket.sendall(b"%d:%s" % (len(message), message))
        _, _, error, found = self._read()
        assert error is None, error
        return (found or {}).get("value")

    def run(self, script: str) -> Any:
        """Return what a script returns in the page."""
        return self("WebDriver:ExecuteScript", script=script, args=[], sandbox=None)

    def messages(self) -> list[str]:
        """Return the messages of the console since the start that name a file or a local address."""
        self("Marionette:SetContext", value="chrome")
        found: list[str] = self.run("return Services.console.getMessageArray().map((one) => String(one.message))")
        self("Marionette:SetContext", value="content")
        return [message for message in found if "file://" in message or "127.0.0.1" in message]

    def close(self) -> None:
        """End the browser."""
        self._socket.close()
        self._process.terminate()
        self._process.wait(_PATIENCE)

    def _read(self) -> Any:
        """Return the next message: its length, a colon, and JSON."""
        length, text = b"", b""
        while (digit := self._socket.recv(1)) != b":":
            assert digit, "Firefox has closed the connection"
            length += digit
        while len(text) < int(length):
            text += self._socket.recv(int(length) - len(text))
        return json.loads(text)
