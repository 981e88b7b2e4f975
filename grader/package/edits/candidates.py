"""The edits of a package that may make criteria pass, by the files that their checks look at."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager
from itertools import chain, islice
from typing import Any

from grader.edits import Proposal, edited
from grader.package.edits.files import file_proposals, kind_of, package_names
from grader.package.edits.paths import launch_paths, setup_paths
from grader.package.edits.python_difference import PythonDifference
from grader.package.edits.python_file import PythonFile
from grader.package.edits.syntax import repaired
from grader.package.edits.task import Task
from grader.package.edits.trees import tree_proposals
from grader.package.edits.wording import defined, respelt, reworded
from grader.package.edits.xml_syntax import repaired as repaired_xml
from grader.package.launch.model import Launch
from grader.package.package import MANIFEST, SETUP, Package
from grader.source import Edit, Location, Source

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
    task = Task(package, reference, frozenset(chain.from_iterable(_texts(arguments) for _, arguments in wanted)))
    found: dict[tuple[object, ...], Proposal] = {}
    names = dict.fromkeys([package.share.split("/")[1], *filter(None, [package.wanted])])
    makers = [lambda: chain.from_iterable(package_names(task, name) for name in names)]
    makers += [lambda kind=kind: _of_kind(task, kind) for kind in kinds]  # type: ignore[misc]
    for make in makers:
        with isolated():
            own = {
                _result(task, it.edits): it for it in islice(make(), _MAX_MADE) if it.edits
            }  # a later one says better what changes
            found |= {result: own[result] for result in sorted(own, key=lambda it: own[it].size)[:_MAX_PROPOSALS]}
    return list(found.values())


def _texts(arguments: Mapping[str, Any]) -> Iterator[str]:
    for value in arguments.values():
        yield from (it for it in (value if isinstance(value, list) else [value]) if isinstance(it, str))


def _result(task: Task, edits: tuple[Edit, ...]) -> tuple[object, ...]:
    """Return what is the same for edits that make the same change: the text after them."""
    sources = {
        path: task.source(path.removeprefix(task.package.path(""))) for path in dict.fromkeys(it.path for it in edits)
    }
    if any(it.renamed for it in edits) or None in sources.values():
        return edits
    return tuple(
        (path, edited(it.text, path, [edit for edit in edits if edit.path == path]))
        for path, it in sources.items()
        if it
    )


def _of_kind(task: Task, kind: str) -> Iterator[Proposal]:
    """Yield the edits of the files of a kind, and those that rename or create them."""
    package, like = task.package, task.reference
    yield from file_proposals(task, kind)
    if kind in (SETUP, "launch"):
        yield from file_proposals(task, "urdf")
    if kind == SETUP and package.setup is not None:
        setup = package.setup
        places = [setup.location(it.at) for it in (*setup.faults, *setup.stops)]
        faults = [setup.fault.location] if setup.fault is not None else []
        yield from _of_file(task, SETUP, SETUP, SETUP, [*faults, *places], is_broken=bool(faults))
    elif kind == MANIFEST and package.manifest is not None:
        is_broken = package.manifest.name is None
        created = [edit for it in file_proposals(task, SETUP) for edit in it.edits] if SETUP not in task.files else []
        for proposal in _of_file(task, MANIFEST, MANIFEST, MANIFEST, [], is_broken=is_broken):
            yield proposal._replace(edits=(*proposal.edits, *created))
    elif kind == "launch":
        names = [name for name in sorted(task.given) if kind_of(name) == kind]
        for name in names or [""]:
            path, other = package.launch_file(name), like.launch_file(name) if like is not None else None
            launch = package.launch(path) if path is not None else None
            if path is not None and launch is not None:
                faults = [it.location for it in (*filter(None, [launch.syntax]), *launch.faults)]
                yield from _of_file(
                    task, path, other, "the launch file", faults, is_broken=launch.syntax is not None, launch=launch
                )
    elif kind == "rviz":
        launch = next((package.launch(path) for path in package.launch_files[:1]), None)
        path = package.rviz_file(next((name for name in sorted(task.given) if name.endswith(".rviz")), ""), launch)
        if path is not None:
            fault = package.rviz(path).fault
            other = like.rviz_file("", None) if like is not None else None
            yield from _of_file(
                task, path, other, "the RViz file", [fault.location] if fault else [], is_broken=fault is not None
            )


def _of_file(
    task: Task,
    path: str,
    like: str | None,
    what: str,
    faults: list[Location],
    *,
    is_broken: bool,
    launch: Launch | None = None,
) -> Iterator[Proposal]:
    """Yield the edits of a file: of its syntax, its names, its paths, its difference to the reference, and its words."""
    source, wanted = task.source(path), task.wanted(like)
    if source is None:
        return
    own, right = PythonFile(source), Source(source.path, wanted or "")
    is_python = not path.endswith((".xml", ".rviz", ".yaml", ".yml", ".launch"))
    is_like = (like is not None and like.rpartition(".")[2] == path.rpartition(".")[2]) or is_python
    if wanted and is_like:
        yield from reworded(source, wanted, what)
        if not is_broken and is_python:
            yield from PythonDifference(own, PythonFile(right), what).proposals()
        elif not is_broken:
            yield from tree_proposals(source, right, task.given, what)
    if is_broken:
        yield from repaired(own, what) if is_python else repaired_xml(source, what)
    else:
        if is_python:
            yield from defined(own, [it for it in faults if it.path == source.path], what)
        yield from (
            launch_paths(task, launch, source) if launch is not None else setup_paths(task) if path == SETUP else ()
        )
    lines = [place.line for place in faults if place.path == source.path]
    yield from respelt(source, [wanted or "", *(task.files if path == SETUP else task.package.installed)], lines, what)
