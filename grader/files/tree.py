"""The files of a submission, wherever they come from: a folder or an archive looks the same from here on."""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import partial
from typing import NamedTuple, Protocol

from grader.errors import InputError
from grader.files.reading import MAX_FILE_SIZE
from grader.text import printable_path

# Products of a build, tools' folders and other people's code: what a student wrote is not in them.
BUILT = frozenset({"build", "install", "log"})
IGNORED = BUILT | {"node_modules", "site-packages", "__pycache__", "__MACOSX"}  # and what holds a pyvenv.cfg
_LITTER = frozenset({"Thumbs.db", "desktop.ini", "Icon\r", "AMENT_IGNORE", "COLCON_IGNORE"})
MOST_FILES = 50_000


class Reader(Protocol):
    """Gives the bytes of a file: of at most `limit` bytes (InputError beyond), or only the first `limit` of them."""

    def __call__(self, limit: int, *, first: bool = False) -> bytes:
        """The bytes."""


class PassedOver(NamedTuple):
    """A file that might have been graded, and why it is not."""

    path: str
    because: str


@dataclass(frozen=True, slots=True)
class File:
    """One regular file; `path` is relative to the submission, with forward slashes, and printable."""

    path: str
    size: int
    read: Reader = field(repr=False, compare=False)

    @property
    def name(self) -> str:
        """The last part of its path."""
        return self.path.rpartition("/")[2]

    @property
    def suffix(self) -> str:
        """The ending of its name, in lower case: .png."""
        name = self.name
        dot = name.rfind(".")
        return name[dot:].lower() if 0 < dot < len(name) - 1 else ""


@dataclass(frozen=True, slots=True, weakref_slot=True)
class Tree:
    """The files of a submission by path, in the order of the alphabet, and its folders, empty ones included.

    `left_out` says in one line each what was not taken in, and why; `generated` names URDFs that a build has left. `unseen` are
    folders that are there, but were not looked into.
    """

    name: str
    files: Mapping[str, File]
    folders: frozenset[str]
    left_out: tuple[str, ...] = ()
    generated: tuple[str, ...] = ()
    unseen: frozenset[str] = frozenset()
    unopened: tuple[str, ...] = ()  # archives in it that could not be opened
    kept: "tuple[Tree, ...]" = field(default=(), repr=False, compare=False)  # trees whose archives have to stay open

    def below(self, folder: str) -> "Tree":
        """The files of one folder as a tree of their own; their paths are relative to it."""
        if not folder:
            return self
        start = folder + "/"
        files = {
            path.removeprefix(start): File(path.removeprefix(start), file.size, file.read)
            for path, file in self.files.items()
            if path.startswith(start)
        }
        folders, unseen = (
            frozenset(each.removeprefix(start) for each in paths if each.startswith(start))
            for paths in (self.folders, self.unseen)
        )
        return Tree(folder.rpartition("/")[2], files, folders, unseen=unseen, kept=(self,))


def make_tree(
    name: str,
    files: Iterable[File],
    folders: Iterable[str],
    left_out: Iterable[str] = (),
    generated: Iterable[str] = (),
    unseen: Iterable[str] = (),
    unopened: Iterable[str] = (),
    kept: "tuple[Tree, ...]" = (),
) -> Tree:
    """A tree of these files, its folders completed by those that the files stand in; raises InputError for too many.

    A file that is too large is named, and never read.
    """
    by_path = {file.path: file for file in sorted(files, key=lambda each: each.path)}
    large = {path: _too_large(file) for path, file in by_path.items() if file.size > MAX_FILE_SIZE}
    by_path |= {path: replace(by_path[path], read=partial(_refuse, reason)) for path, reason in large.items()}
    given = set(folders)
    above = folders_above([*by_path, *given], name)
    everything = frozenset(above | given)
    return Tree(
        name,
        by_path,
        everything,
        tuple(dict.fromkeys([*left_out, *large.values()])),
        tuple(generated),
        frozenset(unseen) - everything,
        tuple(unopened),
        kept,
    )


def _too_large(file: File) -> str:
    return f"{file.path} ({file.size / 1e6:.0f} MB) is larger than {MAX_FILE_SIZE >> 20} MiB, the limit for one file, and was ignored"


def _refuse(reason: str, limit: int, *, first: bool = False) -> bytes:
    del limit, first
    raise InputError(reason)


def folders_above(paths: Iterable[str], name: str) -> set[str]:
    """Every folder that one of these paths stands in; raises InputError for too many."""
    above: set[str] = set()
    for path in paths:
        for parent in parents(path):
            if parent in above:  # and with it those above it
                break
            above.add(parent)
        if len(above) > MOST_FILES:
            raise too_many(name)
    return above


def parents(path: str) -> Iterator[str]:
    """The folders that a path stands in, the nearest first."""
    while path := path.rpartition("/")[0]:
        yield path


def is_ignored(path: str) -> str | None:
    """The part of a path for which it is not looked at: a folder of tools or of a build, or something hidden."""
    *folders, name = path.split("/")
    for folder in folders:
        if folder in IGNORED or folder.startswith("."):
            return folder
    return name if name.startswith(".") or name in _LITTER else None


def ignored_folder(path: str) -> str | None:
    """The folder on the way to a path that is not looked into, if there is one."""
    steps = path.split("/")
    for index, step in enumerate(steps[:-1]):
        if step in IGNORED or step.startswith("."):
            return "/".join(steps[: index + 1])
    return None


def is_generated(path: str) -> bool:
    """Whether a path is that of a URDF which a build has copied somewhere."""
    return path.lower().endswith(".urdf") and not BUILT.isdisjoint(path.split("/")[:-1])


def too_many(shown: str) -> InputError:
    """What to say of a submission with more files than anyone hands in."""
    return InputError(f"{shown} holds more than {MOST_FILES} files: name the package or the URDF")


def clean(path: str) -> str:
    """A path as messages show it."""
    return printable_path(path)
