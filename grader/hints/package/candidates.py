"""The edits of a package that may make criteria pass, by the files that their checks look at."""

import posixpath
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager
from itertools import islice
from typing import Any

from grader.hints.edits import Proposal
from grader.hints.package.entries import as_lists, missing_entries
from grader.hints.package.paths import launch_paths, setup_paths
from grader.hints.package.python_file import PythonFile
from grader.hints.package.task import WHAT, PackageTask, file_proposals, package_names
from grader.hints.package.wording import other_values, respellings, reword, undefined_names
from grader.package.package import SETUP, Package
from grader.source import Edits, Source

_MAX_MADE, _MAX_PROPOSALS = 100, 24  # for one kind of files


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
        yield from missing_entries(own, PythonFile(Source(source.path, wanted)), what)
        yield from as_lists(own, what)
        yield from undefined_names(own, what)
    elif ending == other:
        yield from other_values(source, wanted, what)
    if kind == "launch":
        yield from launch_paths(task, task.launch(path, source), source)
    elif kind == SETUP:
        yield from setup_paths(task)
    yield from respellings(source, [wanted, *(task.files if kind == SETUP else task.package.installed)], what)
