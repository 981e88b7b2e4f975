"""Control the shim that fails calls of libc, or records them, in this process and all that it starts."""

import ctypes
import errno
import mmap
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

SOURCE = Path(__file__).with_name("shim.c")
COMPILER = shutil.which("cc") or shutil.which("gcc")
KINDS = (
    "open",
    "read",
    "write",
    "sync",
    "rename",
    "unlink",
    "truncate",
    "mkdir",
    "list",
    "stat",
    "lock",
    "spawn",
    "send",
)
# The errors of each kind, as real systems return them.
ERRORS = {
    "open": (errno.EIO, errno.EMFILE),
    "read": (errno.EIO,),
    "write": (errno.ENOSPC, errno.EIO),
    "sync": (errno.EIO,),
    "rename": (errno.EACCES,),
    "unlink": (errno.EACCES,),
    "truncate": (errno.EIO,),
    "mkdir": (errno.ENOSPC,),
    "list": (errno.EIO,),
    "stat": (errno.EIO,),
    "lock": (errno.EIO,),
    "spawn": (errno.EAGAIN,),
    "send": (errno.EPIPE,),
}
ALWAYS = 1 << 30  # the last call of a fault that stays


class _Control(ctypes.Structure):
    """The mapped file, as shim.c declares it."""

    _fields_ = (
        *(
            (name, ctypes.c_int)
            for name in ("is_on", "kind", "first", "last", "error", "is_recorded")
        ),
        ("counts", ctypes.c_int * len(KINDS)),
        ("root", ctypes.c_char * 1024),
        ("record", ctypes.c_char * 1024),
    )


def run_preloaded(module: str, arguments: Sequence[str]) -> int:
    """Run a module in a process with the shim preloaded; its folder for temporary files is on a memory disk."""
    if COMPILER is None:
        sys.exit("this needs a C compiler, cc or gcc")
    memory = Path("/dev/shm")
    with TemporaryDirectory(prefix="faults-", dir=memory if memory.is_dir() else None) as folder:
        library, control = Path(folder, "shim.so"), Path(folder, "control")
        subprocess.run(
            [COMPILER, "-shared", "-fPIC", "-O2", "-o", library, SOURCE, "-ldl"], check=True
        )
        control.write_bytes(bytes(ctypes.sizeof(_Control)))
        (top := Path(folder, "tmp")).mkdir()
        own = {"LD_PRELOAD": str(library), "FAULT_CONTROL": str(control), "TMPDIR": str(top)}
        return subprocess.run(
            [sys.executable, "-m", module, *arguments], env={**os.environ, **own}, check=False
        ).returncode


def is_preloaded() -> bool:
    """Return whether this process has the shim."""
    return "FAULT_CONTROL" in os.environ


class Shim:
    """The shim of this process, for calls that concern paths below `root`."""

    def __init__(self, root: Path) -> None:
        with Path(os.environ["FAULT_CONTROL"]).open("r+b") as file:
            self._control = _Control.from_buffer(mmap.mmap(file.fileno(), ctypes.sizeof(_Control)))
        self._control.root = os.fsencode(root)

    def arm(self, kind: str = "", first: int = 0, last: int = 0, error: int = 0) -> None:
        """Count calls from now on, and fail the calls of a kind from the first to the last."""
        control = self._control
        control.kind, control.first, control.last = KINDS.index(kind) if kind else -1, first, last
        control.error = error
        ctypes.memset(control.counts, 0, ctypes.sizeof(control.counts))
        control.is_on = 1

    def disarm(self) -> None:
        """Let all calls pass."""
        self._control.is_on = self._control.is_recorded = 0

    @contextmanager
    def armed(
        self, kind: str = "", first: int = 0, last: int = 0, error: int = 0
    ) -> Iterator[None]:
        """Fail calls inside."""
        self.arm(kind, first, last, error)
        try:
            yield
        finally:
            self.disarm()

    @contextmanager
    def recording(self, to: Path) -> Iterator[None]:
        """Append the calls inside that change files to a record; `power.py` reads it."""
        to.touch()
        self._control.record, self._control.is_recorded = os.fsencode(to), 1
        with self.armed():
            yield

    @property
    def counts(self) -> dict[str, int]:
        """The number of calls of each kind since it was armed."""
        return dict(zip(KINDS, self._control.counts, strict=True))
