"""Edits of setup.py: its syntax, its imports, and what it installs."""

from collections.abc import Iterator, Mapping, Sequence
from fnmatch import fnmatch
from typing import Any

from grader.edits import Proposal
from grader.package.edits.data_files import entries, files_of
from grader.package.edits.difference import restored
from grader.package.edits.python_names import defined
from grader.package.edits.spelling import respelt
from grader.package.edits.syntax import repaired
from grader.package.edits.task import Task, proposal
from grader.package.package import SETUP
from grader.source import Edit

_KINDS = ("urdf", "launch", "rviz")


def installs(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits with which a build installs the file of a kind."""
    kind, name = arguments["kind"], arguments["name"]
    yield from _installing(task, files_of(task, kind, name))


def installs_files(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits with which a build installs files that match patterns."""
    patterns = arguments["files"]
    yield from _installing(task, [path for path in task.files if any(fnmatch(path, pattern) for pattern in patterns)])


def _installing(task: Task, files: Sequence[str]) -> Iterator[Proposal]:
    file, setup = task.setup, task.package.setup
    if file is None or setup is None:
        yield from created_setup(task)
        return
    if setup.fault is None and files:
        yield from entries(task, file, setup, files, _missing(task, files))
    yield from readable(task, {})


def _missing(task: Task, files: Sequence[str]) -> dict[str, Sequence[str]]:
    """Return the files of each kind that a build does not install at all, with these files among them."""
    installed = set(task.package.installed.values())
    found: dict[str, Sequence[str]] = {}
    for kind in _KINDS:
        own = [path for path in files_of(task, kind, "") if path in files] or files_of(task, kind, "")
        if own and not installed.intersection(own):
            found[kind] = own
    if not any(set(files) & set(paths) for paths in found.values()) and not installed.intersection(files):
        found["file"] = files
    return found


def readable(task: Task, arguments: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield edits after which Python reads setup.py, and every name in it is defined."""
    del arguments
    yield from task.once(SETUP, lambda: _readable(task))


def _readable(task: Task) -> Iterator[Proposal]:
    file, setup = task.setup, task.package.setup
    if file is None or setup is None:
        yield from created_setup(task)
        return
    faults = [setup.location(fault.at) for fault in setup.faults] + [setup.location(stop.at) for stop in setup.stops]
    if setup.fault is not None:
        faults.append(setup.fault.location)
        yield from repaired(file, SETUP)
    else:
        yield from defined(file, faults, SETUP)
    wanted = task.wanted(SETUP) or ""
    yield from respelt(file.source, [wanted, *task.files], (place.line for place in faults), SETUP)
    if wanted:
        yield from restored(file.source, wanted, SETUP)


def created_setup(task: Task) -> Iterator[Proposal]:
    """Yield the edit that creates setup.py as in the reference, with the files that it needs."""
    if edits := new_setup(task):
        yield proposal(edits, "a missing setup.py", "create setup.py as ros2 pkg create does, with the lab's entries")


def new_setup(task: Task) -> list[Edit]:
    """Return the edits that create setup.py, setup.cfg and the file of the resource index."""
    if SETUP in task.files:
        return []
    edits = task.created(SETUP, SETUP)
    marker = f"resource/{task.package.name}"
    if edits and marker not in task.files:
        edits.append(Edit(task.package.path(marker), 1, 1, "", ""))
    return [*edits, *task.created("setup.cfg", "setup.cfg")] if edits else []
