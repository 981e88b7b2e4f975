"""Paths that name no file: one text of a file changes, with which the path becomes the most similar one that exists."""

import ast
import posixpath
import re
from collections.abc import Iterable, Iterator
from difflib import SequenceMatcher
from itertools import islice

from grader.hints.edits import Proposal
from grader.hints.package.python_file import PythonFile
from grader.hints.package.task import PackageTask, change
from grader.package.launch.model import Launch, NamedFile
from grader.package.launch.places import HOME, PREFIX, WORKING_FOLDER
from grader.package.package import SETUP
from grader.source import Edit, Source

_PIECE = re.compile(r"[^\s\"'<>=(){},\[\]$;|]+")
# What is before the name of a package: get_package_share_directory(', FindPackageShare(", $(find-pkg-share and a space.
_PACKAGE_ARGUMENT = re.compile(r"(?:package_share_\w+|package_prefix|FindPackage\w*|find-pkg-\w+)[\s(]*['\"]?$")
_MAX_PIECES = 1000  # of one file
_MAX_CALL = 80  # characters before an argument that are looked at
_REST_OF_ARGUMENT = re.compile(r"\s*,\s*")
_ENDINGS = {"urdf": (".urdf", ".xacro"), "rviz": (".rviz",), "include": (".launch.py", ".launch.xml", ".launch.yaml")}
_ENDINGS["read"] = _ENDINGS["urdf"]
_SHARE_FUNCTION = "get_package_share_directory"
_MAX_PATHS = 8  # that are wrong in one file
_MAX_EDITS = 3  # of one path
_MAX_FILES = 200
_LAUNCH = "the launch file"


def setup_paths(task: PackageTask) -> Iterator[Proposal]:
    """Yield edits of the paths and patterns in setup.py that name no file, or a folder."""
    source, setup = task.source(SETUP), task.package.setup
    if source is None or setup is None:
        return
    wrong = [(it.path.rstrip("/"), it.at.line) for it in setup.stops] + [(it.pattern, it.at.line) for it in setup.empty]
    files = {path: posixpath.dirname(path) for path in islice(task.files, _MAX_FILES)}
    patterns = [f"{folder}/*{end}" for path, folder in files.items() for end in ("", posixpath.splitext(path)[1])]
    for path, line in wrong[:_MAX_PATHS]:
        is_folder, above = path in task.package.tree.folders, posixpath.dirname(path)
        known = [it for it in patterns if posixpath.dirname(it) in (above, path)] if is_folder else [*files, *patterns]
        for actual in (path, f"{above}/*")[: 1 + is_folder]:
            for wanted in _similar(actual, known)[:_MAX_EDITS]:
                edits = moved(source, actual, wanted, line)[:2]
                yield from (change([edit], "a path", SETUP) for edit in edits)


def _similar(path: str, known: Iterable[str]) -> list[str]:
    """Return known paths, the most similar first."""
    return sorted(dict.fromkeys(known), key=lambda it: -SequenceMatcher(None, it, path, autojunk=False).ratio())


def launch_paths(task: PackageTask, launch: Launch, source: Source) -> Iterator[Proposal]:
    """Yield edits with which a launch file finds its files: of all together, then of one path each."""
    installed = task.package.installed
    named = [it for it in launch.references[:_MAX_PATHS] if it.path is not None]
    wrong = [it for it in named if posixpath.normpath(it.path or "").removeprefix(f"{PREFIX}/") not in installed]
    ways = [way for way in (_edits_of_path(task, source, named)[:_MAX_EDITS] for named in wrong) if way]
    if len(ways) > 1:
        yield change([edit for way in ways for edit in way[0]], "the paths", _LAUNCH)
    for way in ways:
        yield from (change(edits, "a path", _LAUNCH) for edits in way)


def _targets(task: PackageTask, purpose: str) -> list[str]:
    """Return the paths in the package's share folder of the files that it installs for a purpose."""
    share = f"share/{task.package.name}/"
    own = (it.removeprefix(share) for it in task.package.installed if it.startswith(share))
    return [it for it in own if it.lower().endswith(_ENDINGS[purpose])]


def _edits_of_path(task: PackageTask, source: Source, named: NamedFile) -> list[list[Edit]]:
    """Return the edits with which a path becomes the one that the file is installed at."""
    actual, share = named.path or "", f"{PREFIX}/share/{task.package.name}/"
    for below in _similar(actual.removeprefix(share), _targets(task, named.purpose))[:1]:
        if actual.startswith(PREFIX):
            return [[edit] for edit in moved(source, actual, share + below, named.location.line)]
        if source.path.endswith(".py"):
            return [*_of_one_machine(task.package.name, PythonFile(source), actual, below)]
    return []


def _of_one_machine(name: str, file: PythonFile, actual: str, target: str) -> Iterator[list[Edit]]:
    """Yield the edits that replace a path of one machine, or relative to the working folder, by the share folder.

    The difference to the reference has no answer where the file is built in another way: launch-home-path,
    sensors-launch-home-path.
    """
    share = f"{_SHARE_FUNCTION}({name!r})"
    for literal in [it for it in file.nodes if isinstance(it, ast.Constant) and it.value and isinstance(it.value, str)]:
        for path in (str(literal.value).rstrip("/").replace("~", HOME, 1), f"{WORKING_FOLDER}/{literal.value!s}"):
            rest = actual.removeprefix(path).strip("/") if f"{actual}/".startswith(f"{path}/") else None
            others = moved(file.source, rest, target)[:1] if rest and rest != target else []
            if rest in ("", target) or others:
                new = share if rest else f"os.path.join({share}, {target!r})"
                imports = file.with_imports([_SHARE_FUNCTION, *([] if rest else ["os"])])
                yield [*imports, file.replaced(literal, new), *others]


def path_offsets(source: Source) -> Iterator[tuple[int, int]]:
    """Yield the offsets of the texts in a file that a path may be put together from."""
    if not source.path.endswith(".py"):
        yield from (match.span() for match in _PIECE.finditer(source.text))
        return
    yield from ((it.start, it.end) for it in PythonFile(source).literals)


def moved(source: Source, actual: str, wanted: str, line: int = 1) -> list[Edit]:
    """Return the edits of one text each with which a path becomes the wanted one; those nearest to a line first."""
    found: dict[Edit, int] = {}
    for start, end in islice(path_offsets(source), _MAX_PIECES):
        piece = source.text[start:end]
        if piece.strip("./") and piece in actual:
            is_package = _PACKAGE_ARGUMENT.search(source.text, max(start - _MAX_CALL, 0), start) is not None
            for new in _replacements(piece, actual, wanted):
                if is_package and ("/" in new or not new):
                    continue  # the name of a package has no folders
                edit = source.edit(start, end, new) if new else _without(source, start, end)
                found.setdefault(edit, abs(edit.line - line))
    return sorted(found, key=lambda edit: (found[edit], -edit.line))


def _replacements(piece: str, actual: str, wanted: str) -> Iterator[str]:
    for place in re.finditer(re.escape(piece), actual):
        head, tail = actual[: place.start()], actual[place.end() :]
        if wanted.startswith(head) and wanted.endswith(tail) and len(head) + len(tail) <= len(wanted):
            new = wanted[len(head) : len(wanted) - len(tail)]
            if new != piece:
                yield new


def _without(source: Source, start: int, end: int) -> Edit:
    """Return the edit that removes a text, as an argument with its quotes and comma where it is one."""
    text = source.text
    after = _REST_OF_ARGUMENT.match(text, end + 1)
    if text[start - 1 : start] in "'\"" and text[end : end + 1] == text[start - 1 : start] and after is not None:
        return source.edit(start - 1, after.end(), "")
    return source.edit(start, end + (text[end : end + 1] == "/"), "")
