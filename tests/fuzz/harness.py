"""A harness: a function of bytes, the seeds that its inputs are made of, and what holds for all of them."""

import os
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from grader.base.errors import GraderError
from grader.base.source import Location
from grader.base.text import printable
from tests.samples import ROOT

FOLDER = Path(__file__).parent
_MAX_MADE = 500
MAX_SECONDS = 5.0  # of processor time, for one input
MAX_SEED = 24 * 1024  # bytes; larger files make slow inputs
_START = re.compile(rb"(?:\A|\n)=== ([^\n]{1,200})\n")  # of a file in an input that holds several
_TOKEN = re.compile(rb"\s+|[A-Za-z_][\w.]*|[-+]?[\d.]+(?:[eE][-+]?\d+)?|[\x80-\xff]+|.", re.DOTALL)
_NUMBERS = (
    b"0",
    b"-0",
    b"1",
    b"-1",
    b"1e308",
    b"-1e-308",
    b"nan",
    b"inf",
    b"1e400",
    b"9" * 30,
    b"0.1",
    b"3.14159",
    b"",
)
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
_REFUSED = frozenset(
    [
        "subprocess.Popen",
        "os.system",
        "os.exec",
        "os.posix_spawn",
        "os.fork",
        "os.kill",
        "socket.connect",
        "socket.bind",
        "socket.getaddrinfo",
    ]
)
_CHANGES = frozenset(
    [
        "os.remove",
        "os.rename",
        "os.mkdir",
        "os.rmdir",
        "os.symlink",
        "os.link",
        "os.truncate",
        "os.chmod",
        "shutil.rmtree",
    ]
)


class Harness(NamedTuple):
    """A harness. Its seeds are the files and folders that the patterns find below the root, what is made, and its corpus.

    `words` are pieces that mutated inputs are made of, and `size` is the largest input in bytes.
    """

    run: Callable[[bytes], object]
    seeds: tuple[str, ...] = ()
    words: tuple[str, ...] = ()
    size: int = 4096
    made: Callable[[], Iterable[bytes]] = tuple

    @property
    def meaning(self) -> str:
        """What holds of every input, in a sentence."""
        return (getattr(self.run, "func", self.run).__doc__ or "").rstrip(".")

    def inputs(self, name: str) -> list[bytes]:
        """Return the seeds, without those that are too large, and the inputs that once failed."""
        found = [path for pattern in self.seeds for path in sorted(ROOT.glob(pattern))]
        own = [
            path
            for kind in ("corpus", "crashes")
            for path in sorted((FOLDER / kind / name).glob("*"))
        ]
        texts = (packed(path) if path.is_dir() else path.read_bytes() for path in (*found, *own))
        made = [text for text in dict.fromkeys(self.made()) if len(text) <= MAX_SEED]
        return [
            *made[:: 1 + len(made) // _MAX_MADE],
            *(text for text in texts if len(text) <= MAX_SEED),
        ]


def packed(folder: Path) -> bytes:
    """Return the files of a folder as one input, the inverse of `read_files`."""
    files = [
        path
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.name != "expected.toml"
    ]
    return b"\n".join(
        b"=== %b\n%b" % (os.fsencode(path.relative_to(folder)), path.read_bytes()) for path in files
    )


def files_of(data: bytes) -> dict[str, bytes]:
    """Return the files in an input that holds several; what precedes the first one is not used."""
    _, *pieces = _START.split(data)
    names = (os.fsdecode(name) for name in pieces[::2])
    return dict(zip(names, pieces[1::2], strict=True))


def mutated(data: bytes, chance: Random, words: tuple[str, ...], size: int) -> bytes:
    """Return an input with one to four changes of its words, numbers, lines and bytes."""
    tokens = _TOKEN.findall(data)
    for _ in range(chance.choice((1, 1, 2, 4))):
        start = chance.randrange(len(tokens) + 1)
        end = min(len(tokens), start + chance.choice((1, 1, 1, 3, 12, 60)))
        match chance.randrange(8):
            case 0:
                del tokens[start:end]
            case 1:
                tokens[start:start] = tokens[start:end]
            case 2:
                other = chance.randrange(len(tokens) + 1)
                tokens[start:start] = tokens[other : other + end - start]
            case 3 if words:
                tokens[start : start + chance.randrange(2)] = [chance.choice(words).encode()]
            case 4:
                tokens[start : start + 1] = [bytes([chance.randrange(256)])]
            case 5:
                lines = b"".join(tokens).split(b"\n")
                lines.insert(
                    chance.randrange(len(lines) + 1), lines.pop(chance.randrange(len(lines)))
                )
                tokens = _TOKEN.findall(b"\n".join(lines))
            case _:
                at = next(
                    (at for at in range(start, len(tokens)) if tokens[at][-1:].isdigit()), start
                )
                tokens[at : at + 1] = [
                    _other_number(tokens[at] if at < len(tokens) else b"", chance)
                ]
    return b"".join(tokens)[:size]


def _other_number(token: bytes, chance: Random) -> bytes:
    try:
        value = float(token)
    except ValueError:
        return chance.choice(_NUMBERS)
    near = (
        value * chance.choice((-1, 2, 0.5, 10, 1000, 57.29578)),
        value + chance.choice((0.001, -0.02, 1)),
    )
    return chance.choice((*(f"{number:g}".encode() for number in near), chance.choice(_NUMBERS)))


@contextmanager
def user_errors() -> Iterator[None]:
    """Accept an error that a user can meet, if its message says something."""
    try:
        yield
    except GraderError as error:
        check_message(str(error))


def check_message(text: str) -> None:
    """Assert that a message says something, and shows no object of Python."""
    assert printable(text).strip()
    assert not re.search(r"<[\w.]+ object at 0x", text), text


def check_location(location: Location | None, texts: Mapping[str, str]) -> None:
    """Assert that a location is in its file; files that have no text here are not checked."""
    if location is None or location.path not in texts:
        return
    lines = texts[location.path].split("\n")
    assert 1 <= location.line <= len(lines), location
    assert 1 <= location.column <= len(lines[location.line - 1]) + 1, location
    for _, called in location.calls:
        check_location(called, texts)


def decoded(data: bytes) -> str:
    """Return the text of a file as readers decode it: offsets are the same however they treat bytes that are not UTF-8."""
    return data.decode("utf-8", "surrogateescape")


class Guard:
    """Watches what Python does: no harness starts a process, connects, or writes outside of one folder."""

    folder = ""  # the only one that files are written in
    is_active = False

    def __init__(self) -> None:
        """Add the hook, which cannot be removed."""
        sys.addaudithook(self._audit)

    def _audit(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self.is_active:
            return
        if event == "open":
            path, mode, flags = arguments
            is_write = (
                bool(flags & _WRITING)
                if isinstance(flags, int) and flags
                else isinstance(mode, str) and "r" not in mode
            )
            assert not is_write or self._is_inside(path), f"writes {path!r}"
        assert event not in _REFUSED, f"{event} {arguments!r:.200}"
        assert event not in _CHANGES or self._is_inside(arguments[0]), f"{event} {arguments!r:.200}"

    def _is_inside(self, path: object) -> bool:
        if isinstance(path, int) or path is None:
            return True
        text = os.fsdecode(path) if isinstance(path, str | bytes | os.PathLike) else ""
        return bool(self.folder) and os.path.realpath(text).startswith(
            os.path.realpath(self.folder)
        )

    @contextmanager
    def watching(self, *, is_active: bool = True) -> Iterator[None]:
        """Watch what the block does, or not."""
        before = self.is_active, sys.dont_write_bytecode
        self.is_active = sys.dont_write_bytecode = is_active
        try:
            yield
        finally:
            self.is_active, sys.dont_write_bytecode = before


GUARD = Guard()
