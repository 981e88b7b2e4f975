"""Limits of the processor time of the process that reads for an editor.

The system ends the process at a limit, whatever it does: a pattern that searches a text cannot be
stopped by an exception in another thread than the main one.
"""

import mmap
import os
import signal
import struct
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from math import ceil
from threading import Lock

from grader.base.processor_time import INSPECT_SECONDS

MAX_FILE_SECONDS = 5.0  # of processor time, from one file to the next
_LENGTH = struct.Struct("H")
_SIZE = 8192  # bytes: a path and its length


class SharedPath:
    """The file that a process reads, which the process that started it sees also after its end."""

    def __init__(self) -> None:
        self._memory = mmap.mmap(-1, _SIZE)  # a process that is forked shares it

    def write(self, path: str) -> None:
        """Replace the path."""
        data = os.fsencode(path)[: _SIZE - _LENGTH.size]
        end = _LENGTH.size + len(data)
        self._memory[:end] = _LENGTH.pack(len(data)) + data

    def read(self) -> str:
        """Return the path; empty if no file has been read."""
        [length] = _LENGTH.unpack(self._memory[: _LENGTH.size])
        return os.fsdecode(self._memory[_LENGTH.size : _LENGTH.size + length])


class ReadingLimits:
    """The limits of this process; without a shared path there are none.

    Its methods may be called from several threads.
    """

    def __init__(self, shared: SharedPath | None = None) -> None:
        self._shared = shared
        self._is_looking = False
        self._path = ""
        self._starts: list[float] = []  # the processor times at which work began
        self._lock = Lock()

    def begin_file(self, path: str) -> None:
        """Note that a file is read from now on, if it is another one than before."""
        if self._shared and path != self._path:
            self._path = path
            self._shared.write(path)
            self.restart()

    def restart(self) -> None:
        """Give a look the whole time of a file again: it is about to read something else."""
        if self._shared and self._is_looking and sys.platform != "win32":
            signal.setitimer(signal.ITIMER_PROF, MAX_FILE_SECONDS)

    @contextmanager
    def looking(self) -> Iterator[None]:
        """Limit the time from one file to the next. One thread at a time looks."""
        self._is_looking = True
        self.restart()
        try:
            yield
        finally:
            self._is_looking = False
            if self._shared and sys.platform != "win32":
                signal.setitimer(signal.ITIMER_PROF, 0)

    @contextmanager
    def working(self) -> Iterator[None]:
        """Limit the time of some work. Work in another thread at the same time counts as well."""
        start = time.process_time()
        with self._lock:
            self._starts.append(start)
            self._limit_process()
        try:
            yield
        finally:
            with self._lock:
                self._starts.remove(start)
                self._limit_process()

    def _limit_process(self) -> None:
        """Set the limit of the process to that of the oldest work."""
        if not self._shared or sys.platform == "win32":
            return
        import resource

        _, hard = resource.getrlimit(resource.RLIMIT_CPU)
        end = hard
        if self._starts:
            end = ceil(min(self._starts)) + INSPECT_SECONDS
            if hard != resource.RLIM_INFINITY:
                end = min(end, hard)
        resource.setrlimit(resource.RLIMIT_CPU, (end, hard))
