"""The edits of a package that may make criteria pass, by the files that their checks look at."""

import posixpath
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager
from itertools import chain, islice
from typing import Any

from grader.edits import Proposal, composed, edited
from grader.package.edits.files import WHAT, file_proposals, package_names
from grader.package.edits.paths import in_xml, launch_paths, setup_paths
from grader.package.edits.python_difference import PythonDifference
from grader.package.edits.python_file import PythonFile
from grader.package.edits.syntax import repaired
from grader.package.edits.task import Task
from grader.package.edits.trees import tree_proposals
from grader.package.edits.wording import defined, respelt, reworded
from grader.package.edits.xml_syntax import repaired as repaired_xml
from grader.package.package import MANIFEST, SETUP, Package
from grader.source import Edit, Source

_MAX_MADE, _MAX_PROPOSALS = 100, 24  # for one kind of files
_MAX_MISTAKES = 3  # in one launch file
_MAX_FIRST = 2


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
    task = Task(package, reference, frozenset(chain.from_iterable(_texts(arguments) for _, arguments in wanted)))
    found: dict[tuple[object, ...], Proposal] = {}
    for kind in ("", *kinds):
        with isolated():
            # Of equal ones, a later one says better what changes.
            own = {_result(task, it.edits): it for it in islice(_of_kind(task, kind), _MAX_MADE) if it.edits}
            found |= {result: own[result] for result in sorted(own, key=lambda it: own[it].size)[:_MAX_PROPOSALS]}
    return list(found.values())


def _texts(arguments: Mapping[str, Any]) -> Iterator[str]:
    for value in arguments.values():
        yield from (it for it in (value if isinstance(value, list) else [value]) if isinstance(it, str))


def _result(task: Task, edits: tuple[Edit, ...]) -> tuple[object, ...]:
    """Return what is the same for edits that make the same change: the text after them, of one file."""
    source = task.source(edits[0].path.removeprefix(task.package.path("")))
    if source is None or any(it.renamed or it.path != source.path for it in edits):
        return edits
    return source.path, edited(source.text, source.path, edits)


def _of_kind(task: Task, kind: str) -> Iterator[Proposal]:
    """Yield the edits of the file of a kind, and those that rename or create files of the kind; without a kind, of its name."""
    if not kind:
        yield from package_names(task, task.package.wanted or task.package.share.split("/")[1])
        return
    yield from file_proposals(task, kind)
    if kind == MANIFEST and SETUP not in task.files:  # with the build type alone, the package could not be built
        needed = tuple(edit for it in file_proposals(task, SETUP) for edit in it.edits)
        yield from (it._replace(edits=(*it.edits, *needed)) for it in _of_file(task, kind))
    else:
        yield from _of_file(task, kind)


def _of_file(task: Task, kind: str) -> Iterator[Proposal]:
    """Yield the edits of a file, and those of several mistakes in a launch file one after the other."""
    yield from file_proposals(task, "urdf") if kind in (SETUP, "launch") else ()
    path, like = task.file(task.package, kind), task.file(task.reference, kind)
    source = task.source(path)
    if source is not None and path is not None:
        yield from _of_text(task, kind, source, path, like, _MAX_MISTAKES)


def _of_text(task: Task, kind: str, source: Source, path: str, like: str | None, depth: int) -> Iterator[Proposal]:
    """Yield the edits of the text of a file; for those that leave fewer mistakes, also with the edits of the others."""
    found = [*islice(_of_one(task, kind, source, path, like), _MAX_MADE)]
    yield from found
    if kind != "launch" or task.reference is None or like is None or depth == 1:
        return
    wanted = {(it.package, it.executable) for it in task.reference.launch(like).nodes}

    def left(text: Source) -> tuple[bool, int]:
        launch = task.package.launch(path, text.text.encode("utf-8", "surrogateescape"))
        started = {(it.package, it.executable) for it in launch.nodes}
        return launch.syntax is not None, len(launch.faults) + len(wanted - started)

    afters = [(it, Source(source.path, edited(source.text, source.path, it.edits) or "")) for it in found if it.edits]
    ranked = sorted(((left(after), it.size, index) for index, (it, after) in enumerate(afters)))
    now = left(source)
    for _, _, index in [it for it in ranked if (False, 0) < it[0] < now][:_MAX_FIRST]:
        first, after = afters[index]
        for second in _of_text(task, kind, after, path, like, depth - 1):
            edits = composed(source.text, source.path, first.edits, second.edits)
            yield Proposal(edits, f"{first.cause} and {second.cause}", f"{first.action} and {second.action}")


def _of_one(task: Task, kind: str, source: Source, path: str, like: str | None) -> Iterator[Proposal]:
    """Yield the edits of a file: its difference to the reference, its syntax, its names, its paths and its words."""
    wanted = task.wanted(like)
    if (
        path.endswith(".xml")
        and kind == "launch"
        and like is not None
        and task.reference is not None
        and not like.endswith(".xml")
    ):
        wanted, like = in_xml(task, task.reference.launch(like)), path
    what = WHAT.get(kind, kind)
    is_python = posixpath.splitext(path)[1] in (".py", "")
    is_like = is_python or (like is not None and posixpath.splitext(path)[1] == posixpath.splitext(like)[1])
    own, right = PythonFile(source), Source(source.path, wanted or "")
    if wanted and is_like:
        yield from reworded(source, wanted, what)
        compared = PythonDifference(own, PythonFile(right), what).proposals()
        yield from compared if is_python else tree_proposals(source, right, task.given, what)
    if is_python:
        yield from repaired(own, what)
        yield from defined(own, what)
    elif kind != "rviz":
        yield from repaired_xml(source, what)
    if kind == "launch":
        yield from launch_paths(task, task.package.launch(path, source.text.encode("utf-8", "surrogateescape")), source)
    elif kind == SETUP:
        yield from setup_paths(task)
    yield from respelt(source, [wanted or "", *(task.files if kind == SETUP else task.package.installed)], what)
