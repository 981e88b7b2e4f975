"""Functions with which a Python file looks for files of its own package: answered from the package's list of files."""

import posixpath
import re
from collections.abc import Callable
from pathlib import PurePosixPath
from typing import TYPE_CHECKING, NamedTuple

from grader.files.ignore_rules import ignored_part
from grader.package.globbing import BeyondError, Listing
from grader.static_python.values import Made, Spot, Steering, TooHard, Unknown, Value, unknown_in

if TYPE_CHECKING:
    from grader.static_python.machine import Library, Machine

WRITING = "builtins.open(w)"  # the name of a call that opens a file to write into it
_OUTSIDE = "it looks at files outside of the package"


class EmptyGlob(NamedTuple):
    """A pattern that finds no file."""

    pattern: str
    at: Spot


class Found(NamedTuple):
    """What a search for files has found, as it is spelt there."""

    paths: tuple[str | PurePosixPath, ...]
    at: Spot


_MOST_NOTED = 200  # paths of one search whose place is kept


def file_functions(listing: Listing, root: str) -> "Library":
    """The functions by full name; `root` is the absolute path that the package's folder goes by."""
    package = _Package(listing, root)
    named: dict[str, Callable[..., Value]] = {
        "glob.glob": package.glob,
        "glob.iglob": package.glob,
        "glob.escape": package.escape,
        "os.listdir": package.listdir,
        "os.walk": package.walk,
        "os.chdir": package.chdir,
        "builtins.open": package.open,
        "pathlib.Path.iterdir": package.iterdir,
        "pathlib.Path.glob": package.path_glob,
        "pathlib.Path.rglob": package.path_rglob,
    }
    named["os.path.exists"] = named["pathlib.Path.exists"] = package.of_path(lambda path: path is not None)
    named["os.path.isfile"] = named["pathlib.Path.is_file"] = package.of_path(lambda path: path in listing.files)
    named["os.path.isdir"] = named["pathlib.Path.is_dir"] = package.of_path(lambda path: path in listing.folders)
    return {name: _answered(function, listing) for name, function in named.items()}


def _answered(function: Callable[..., Value], listing: Listing) -> Callable[..., Value]:
    def answer(machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        before = listing.looked_at
        try:
            return function(machine, args, kwargs, spot)
        except BeyondError as error:
            return Unknown(str(error), spot)
        finally:
            machine.step((listing.looked_at - before) // 10)  # a search through many files takes its time

    return answer


class _Package:
    """The package's folder, in which a file looks for others."""

    def __init__(self, listing: Listing, root: str) -> None:
        self.listing = listing
        self.root = root

    def inside(self, value: Value) -> str:
        """A path or pattern relative to the package's folder. Raises BeyondError."""
        text = str(value) if isinstance(value, str | PurePosixPath) else None
        if text == self.root:
            return "."
        if text is not None and text.startswith(self.root + "/"):
            text = text.removeprefix(self.root).lstrip("/") or "."
        if text is None or text.startswith("/"):
            unknown = unknown_in(value)
            raise BeyondError(_OUTSIDE if unknown is None else unknown.reason)
        return text

    def real(self, value: Value) -> str | None:
        """The file or folder that a path leads to; None where there is nothing. Raises BeyondError."""
        path = self.inside(value)
        real = self.listing.real(path)
        if real is None and ignored_part(posixpath.normpath(path)):
            raise BeyondError(f"{path} is among files that are not looked at")
        return real

    def glob(self, machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        pattern = args[0] if args else kwargs.get("pathname")
        start = kwargs.get("root_dir")
        options = [kwargs.get(name, False) for name in ("recursive", "include_hidden")]
        if isinstance(pattern, PurePosixPath):
            machine.fault("glob needs a text, and this is a path: write str(...) around it", spot)
        unknown = unknown_in([pattern, start, *options])
        plain = all(isinstance(each, int | None) for each in options) and isinstance(start, str | PurePosixPath | None)
        if unknown or not plain or not isinstance(pattern, str) or not kwargs.keys() <= _GLOB_OPTIONS or len(args) > 1:
            return unknown or Unknown("this search for files is not followed", spot)
        recursive, hidden = map(bool, options)
        if pattern == self.root:
            return [pattern]
        above = self.root + "/" if pattern.startswith(self.root + "/") else ""
        folder = "" if start is None or above else self.inside(start)
        pattern = pattern.removeprefix(above)
        found = self.listing.glob(pattern, recursive=recursive, hidden=hidden, start=folder, above=above)
        if not found:
            machine.notes.append(EmptyGlob(posixpath.join(folder, pattern), spot))
        machine.notes.append(Found(tuple(found[:_MOST_NOTED]), spot))
        return found

    def escape(self, _: "Machine", args: list[Value], __: dict[str, Value], spot: Spot) -> Value:
        if len(args) == 1 and isinstance(args[0], str):
            return re.sub(r"([*?\[])", r"[\1]", args[0])
        return unknown_in(args) or Unknown("this is not followed as a text", spot)

    def path_glob(
        self, machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot, start: str = ""
    ) -> Value:
        pattern = args[1] if len(args) == 2 else kwargs.get("pattern") if len(args) == 1 else None
        if not isinstance(pattern, str) or not kwargs.keys() <= {"pattern"}:
            return unknown_in(args) or Unknown("this search for files is not followed", spot)
        found = self.listing.path_glob(self.inside(args[0]), start + pattern)
        if not found:
            machine.notes.append(EmptyGlob(str(PurePosixPath(self.inside(args[0])) / pattern), spot))
        machine.notes.append(Found(tuple(args[0] / path for path in found[:_MOST_NOTED]), spot))
        return [args[0] / path for path in found]

    def path_rglob(self, machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        return self.path_glob(machine, args, kwargs, spot, "**/")

    def of_path(self, answer: Callable[[str | None], bool]) -> Callable[..., Value]:
        def follow(_: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
            if len(args) != 1 or kwargs:
                return unknown_in(args) or Unknown("this is not followed", spot)
            return answer(self.real(args[0]))

        return follow

    def names(self, machine: "Machine", path: Value, spot: Spot) -> list[Value]:
        """The names in a folder, which has to be one."""
        real = self.real(path)
        if real in self.listing.folders:
            return list(self.listing.names(real or ""))
        if real is None:
            machine.fault(f"there is no folder {str(path)!r}", spot, FileNotFoundError)
        else:
            machine.fault(f"{str(path)!r} is a file, not a folder", spot, NotADirectoryError)
        return []

    def listdir(self, machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        path = args[0] if args else kwargs.get("path")
        return self.names(machine, "." if path is None else path, spot)

    def iterdir(self, machine: "Machine", args: list[Value], _: dict[str, Value], spot: Spot) -> Value:
        return [args[0] / name for name in self.names(machine, args[0], spot)]

    def walk(self, _: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        if len(args) != 1 or not kwargs.keys() <= {"topdown", "followlinks"}:
            return unknown_in(args) or Unknown("this walk through folders is not followed", spot)
        real = self.real(args[0])
        steps: list[Value] = []
        waiting = [(real, str(args[0]))] if real is not None and real in self.listing.folders else []
        while waiting:
            here, spelt = waiting.pop()
            paths = {name: f"{here}/{name}" if here else name for name in self.listing.names(here)}
            folders = [name for name, path in paths.items() if path in self.listing.folders]
            steps.append((spelt, Steering(folders), [name for name in paths if name not in folders]))
            waiting += [(paths[name], posixpath.join(spelt, name)) for name in reversed(folders)]
        return steps

    def chdir(self, _: "Machine", args: list[Value], __: dict[str, Value], ___: Spot) -> Value:
        try:
            stays = len(args) == 1 and self.real(args[0]) == ""
        except BeyondError:
            stays = False
        if not stays:
            raise TooHard("it changes the working folder: what follows is not told")

    def open(self, machine: "Machine", args: list[Value], kwargs: dict[str, Value], spot: Spot) -> Value:
        made = Made("builtins.open", args, kwargs, spot)
        path, mode = made.argument(0, "file"), made.argument(1, "mode")
        if mode is not None and (not isinstance(mode, str) or set(mode) & set("wax+")):
            machine.made.append(Made(WRITING, args, kwargs, spot))
            machine.may_fail()
            return made
        try:
            real = self.real(path)
        except BeyondError:
            machine.may_fail()
            return made
        if real is None:
            machine.fault(f"there is no file {str(path)!r}", spot, FileNotFoundError)
        elif real in self.listing.folders:
            machine.fault(f"{str(path)!r} is a folder, not a file", spot, IsADirectoryError)
        return made


_GLOB_OPTIONS = {"pathname", "root_dir", "recursive", "include_hidden"}
