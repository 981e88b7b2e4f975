"""The edits of a package that may make criteria pass, by the files that their checks look at."""

import posixpath
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager
from itertools import islice
from typing import Any

from grader.edits import Proposal, edited
from grader.package.edits.paths import launch_paths, setup_paths
from grader.package.edits.python_file import PythonFile
from grader.package.edits.python_tree import python_tree
from grader.package.edits.task import WHAT, PackageTask, change, file_proposals, package_names
from grader.package.edits.trees import markup_tree, tree_proposals
from grader.package.edits.wording import respellings, reword, undefined_names
from grader.package.package import SETUP, Package
from grader.source import Edit, Edits, Source
from grader.static_python.parse import SyntaxFault

_BRACKETS = ("()", "[]", "{}")
_QUOTES = str.maketrans("“”„‘’‚", "\"\"\"'''")
_MAX_TRIES, _MAX_PARSED = 250, 512 * 1024  # edits that are parsed, and characters
_MAX_FOUND = 10
_MAX_MADE, _MAX_PROPOSALS = 100, 24  # for one kind of files


def repairs(file: PythonFile, what: str) -> Iterator[Proposal]:
    """Yield edits of one token after which Python can read a file, the nearest to the error first."""
    fault = file.parsed
    if not isinstance(fault, SyntaxFault):
        return
    tries = min(_MAX_TRIES, _MAX_PARSED // len(file.text))
    found = (change([edit], "syntax", "", what) for edit in dict.fromkeys(islice(_edits(file, fault), tries)))
    yield from islice((it for it in found if _is_read(file, it)), _MAX_FOUND)


def _is_read(file: PythonFile, repair: Proposal) -> bool:
    after = edited(file.text, file.source.path, repair.edits)
    return after is not None and not isinstance(PythonFile(Source(file.source.path, after)).parsed, SyntaxFault)


def _edits(file: PythonFile, fault: SyntaxFault) -> Iterator[Edit]:
    """Yield edits of one token, the nearest to the error first: lone quotes and brackets, indentation, then others."""
    source, last = file.source, fault.location.line
    at = source.offset(last, fault.location.column)
    if (plain := file.text.translate(_QUOTES)) != file.text:
        changed = [index for index, char in enumerate(file.text) if char != plain[index]]
        yield source.edit(changed[0], changed[-1] + 1, plain[changed[0] : changed[-1] + 1])
    odd = _loose_marks([token.text for token in file.tokens if token.kind == "op"])
    tokens = sorted(file.tokens, key=lambda it: min(abs(it.start - at), abs(it.end - at)))
    near = [token for token in tokens if source.at(token.start).line in (last, last - 1)]
    for token in near:
        if token.text in odd and token.kind == "op":
            yield from (source.edit(token.start, token.end, char) for char in ("", *odd))
    for token in tokens if odd else ():
        for place in (token.end, token.start):
            yield from (source.edit(place, place, char) for char in odd)
    yield from _indents(file, (last, last - 1))
    for token in near:
        yield from (source.edit(token.end, token.end, char) for char in ",:=.([])")


def _loose_marks(ops: Sequence[str]) -> list[str]:
    """Return the quotes that are tokens of their own, and the brackets that are not all paired."""
    unpaired = [pair for pair in _BRACKETS if ops.count(pair[0]) != ops.count(pair[1])]
    return [char for char in "'\"" if char in ops] + list("".join(unpaired))


def _indents(file: PythonFile, lines: tuple[int, ...]) -> Iterator[Edit]:
    """Yield edits that indent a line as the lines around it."""
    for number in lines:
        text, start = file.source.line(number), file.source.offset(number, 1)
        around = [file.source.line(other) for other in (number - 1, number - 2, number + 1)]
        indents = [line[: len(line) - len(line.lstrip())] for line in around if line.strip()]
        for indent in dict.fromkeys(indents):
            yield file.source.edit(start, start + len(text) - len(text.lstrip()), indent)


def package_proposals(
    package: Package | None,
    reference: Package | None,
    wanted: Iterable[tuple[tuple[str, ...], Mapping[str, Any]]],
    isolated: Callable[[], AbstractContextManager[None]],
) -> list[Proposal]:
    """Return edits of a package for checks: what each looks at, with its arguments. Each edit is made once.

    The edits for each kind of files are made in a context `isolated`, which keeps a fault from those for others.
    """
    if package is None:
        return []
    wanted = list(wanted)
    kinds = dict.fromkeys(kind for looks_at, _ in wanted for kind in looks_at)
    values = [
        value
        for _, arguments in wanted
        for it in arguments.values()
        for value in (it if isinstance(it, list) else [it])
    ]
    task = PackageTask(package, reference, frozenset(value for value in values if isinstance(value, str)))
    found: dict[Edits, Proposal] = {}
    for kind in ("", *kinds):
        with isolated():
            # Of equal ones, a later one says better what changes.
            own = {it.edits: it for it in islice(_of_kind(task, kind), _MAX_MADE) if it.edits}
            best = sorted(own.values(), key=lambda it: (it.rank, it.size))[:_MAX_PROPOSALS]
            found |= {it.edits: it for it in best}
    return list(found.values())


def _of_kind(task: PackageTask, kind: str) -> Iterator[Proposal]:
    """Yield edits of the file of a kind, and those that rename or create one; without a kind, of the package's name."""
    if not kind:
        yield from package_names(task, task.package.lab_name or task.package.share.split("/")[1])
        return
    yield from file_proposals(task, kind)
    yield from file_proposals(task, "urdf") if kind in (SETUP, "launch") else ()
    path, like = task.file(task.package, kind), task.file(task.reference, kind)
    source = task.source(path)
    if source is not None and path is not None:
        yield from (it for it in _of_text(task, kind, source, path, like) if it.edits)


def _of_text(task: PackageTask, kind: str, source: Source, path: str, like: str | None) -> Iterator[Proposal]:
    """Yield the edits of a file: its difference to the reference, its syntax, its names, its paths and its words."""
    what, wanted = WHAT.get(kind, kind), task.wanted(like) or ""
    own = PythonFile(source)
    ending, other = (posixpath.splitext(it or "")[1] for it in (path, like))
    is_python = ending in (".py", "")
    if wanted and (ending == other or is_python):
        yield from reword(source, wanted, what)
    if is_python:
        trees = python_tree(own, own), python_tree(PythonFile(Source(source.path, wanted)), own)
        yield from tree_proposals(source, trees, what, own.needs)
        yield from repairs(own, what)
        yield from undefined_names(own, what)
    else:
        trees = markup_tree(source), markup_tree(Source(source.path, wanted if ending == other else ""))
        yield from tree_proposals(source, trees, what)
    if kind == "launch":
        yield from launch_paths(task, task.launch(path, source), source)
    elif kind == SETUP:
        yield from setup_paths(task)
    yield from respellings(source, [wanted, *(task.files if kind == SETUP else task.package.installed)], what)
