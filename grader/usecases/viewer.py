"""Open a file or an address in the system's viewer."""

import subprocess
import sys
from collections.abc import Iterable
from contextlib import suppress

from grader.usecases import Warn

_COMMANDS = {"darwin": "open", "linux": "xdg-open"}
_SECONDS = 2.0  # after which a viewer that is still running counts as opened


class Viewer:
    """Opens pictures and pages. After a failure, which is reported in one line, it opens nothing more."""

    def __init__(self, warn: Warn) -> None:
        self._warn, self._works = warn, True
        self._running: list[subprocess.Popen[bytes]] = []  # viewers that are still open

    def open(self, targets: Iterable[str]) -> None:
        """Open files or addresses."""
        for target in targets:
            if self._works and (problem := self._problem(target)):
                self._works = False
                self._warn(f"cannot open the viewer: {problem}; open it yourself: {target}")

    def _problem(self, target: str) -> str:
        """Open a target; return why that failed, or an empty string."""
        self._running = [viewer for viewer in self._running if viewer.poll() is None]
        command = _COMMANDS.get(sys.platform)
        if command is None:
            return _start_file(target)
        try:
            viewer = subprocess.Popen(
                [command, target],
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                start_new_session=True,  # Ctrl-C ends the review only
            )
        except OSError as error:
            return f"{command}: {error.strerror}"
        with suppress(subprocess.TimeoutExpired):
            code = viewer.wait(_SECONDS)
            return f"{command} failed with exit code {code}" if code else ""
        self._running.append(viewer)
        return ""


def _start_file(target: str) -> str:
    """Open a target on Windows."""
    import os

    start = getattr(os, "startfile", None)
    if start is None:
        return f"no viewer is known for the platform {sys.platform}"
    try:
        start(target)
    except OSError as error:
        return str(error.strerror)
    return ""
