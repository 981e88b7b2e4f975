"""Programs and nodes: what launch files start, entry points, and the nodes that a lifecycle
manager looks after.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress

from grader.base.errors import InputError
from grader.base.names import closest, near
from grader.base.source import Location
from grader.ros.known.known import known
from grader.ros.launch.launch_model import StartedNode
from grader.ros.launch.node_parameters import parameters_of
from grader.ros.package.entry_points import entry_fault, entry_points
from grader.ros.package.package import CMAKE, SETUP, Package
from grader.ros.workspace.names import (
    Compared,
    Definition,
    Fact,
    Mismatch,
    Open,
    Undecided,
    Use,
    corrections,
)
from grader.ros.workspace.workspace import Workspace

_MAX_FIRST_LINE = 100  # bytes


def program_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the programs that launch files start and no package has, and nodes that nothing
    starts.
    """
    for package in workspace.packages:
        yield from _entry_points(package)
    for package, node in workspace.nodes:
        if not workspace.means_one(package, node.package):
            yield Undecided("programs", f"several packages are named {node.package!r}")
            continue
        owner = package.find(node.package)
        if owner is not None:
            yield Compared("programs")
        setup = owner.installation if owner is not None else None
        if setup is not None and setup.unread:
            yield Undecided("programs", setup.unread)
        if owner is not None and owner.has_program(node.package, node.executable) is False:
            reason, meant = _why_no_program(owner, node.executable)
            start = Location(owner.path(CMAKE if owner.is_cmake else SETUP), 1, 1)
            either = corrections(node.executable, node.location, meant, start)
            yield Mismatch("programs", reason, node.location, corrections=either)
        elif owner is not None:
            yield from _not_executed(owner, node)
        if owner is None:
            names = known()["programs"].get(node.package, [node.executable])
        else:
            names = [node.executable]
        if node.executable not in names:
            reason, meant = _unknown_program(node.package, node.executable, names)
            either = corrections(node.executable, node.location, meant)
            yield Mismatch("programs", reason, node.location, corrections=either)
    yield from _lifecycle(workspace)


def _entry_points(package: Package) -> Iterator[Fact]:
    """Yield the entry points of a package that name no function."""
    for entry in entry_points(package):
        yield Compared("programs")
        fault = entry_fault(package, entry.name)
        if fault is not None:
            message = f"the entry point of {entry.name!r} names no function: {fault.message}"
            either = corrections(fault.written, fault.location, fault.meant)
            yield Mismatch("programs", message, fault.location, corrections=either)


def _not_executed(package: Package, node: StartedNode) -> Iterator[Mismatch]:
    """Yield that Linux cannot execute a script: its first line has to name the interpreter, and end
    without CR.
    """
    copies = package.installation.copies if package.installation is not None else ()
    started = [it.source for it in copies if it.target == f"lib/{package.name}/{node.executable}"]
    for source in [it for it in started if it.endswith(".py")]:
        with suppress(InputError):
            line, _, _ = (
                package.tree.files[source].read(_MAX_FIRST_LINE, first=True).partition(b"\n")
            )
            if line.startswith(b"#!") and not line.endswith(b"\r"):
                continue
            wrong = (
                "ends as on Windows, with CR LF"
                if line.startswith(b"#!")
                else "is not #!/usr/bin/env python3"
            )
            message = f"Linux cannot execute {node.executable}: its first line {wrong}"
            yield Mismatch("programs", message, Location(package.path(source), 1, 1), node.location)


def _why_no_program(package: Package, name: str) -> tuple[str, str | None]:
    """Return that ros2 run does not find a program, and where it is installed, or which there are;
    what is meant.
    """
    setup, entries = package.installation, [entry.name for entry in entry_points(package)]
    folder = setup.scripts_folder if setup is not None else ""
    if name in entries:
        home = f"lib/{package.name}: see install_scripts of setup.cfg"
        return f"a build installs {name!r} in {folder}, not in {home}", None
    files = [*setup.programs, *(copy.target for copy in setup.copies)] if setup is not None else []
    elsewhere = next((path for path in files if path.rpartition("/")[2] == name), None)
    if elsewhere == f"lib/{package.name}/{name}":
        return (
            (
                f"a build installs {name!r} without the right to execute it: write "
                "install(PROGRAMS ...)"
            ),
            None,
        )
    if elsewhere is not None:
        return (
            f"a build installs {name!r} as {elsewhere}, but ros2 run looks in lib/{package.name}",
            None,
        )
    names = sorted(
        {
            *(path.rpartition("/")[2] for path in files if path.startswith(f"lib/{package.name}/")),
            *entries,
        }
    )
    return _unknown_program(package.name, name, names)


def _unknown_program(package: str, name: str, names: Sequence[str]) -> tuple[str, str | None]:
    """Return that a package has only programs of other names, and the one that may be meant."""
    guess = closest(name, names) or near(name, names, "node")
    there = f"; did you mean {guess!r}?" if guess else f"; it has {', '.join(names) or 'none'}"
    return f"the package {package!r} has no program {name!r}{there}", guess


def _lifecycle(workspace: Workspace) -> Iterator[Fact]:
    """Yield the nodes that lifecycle managers are told of, and all that are started."""
    managers = [
        (package, node)
        for package, node in workspace.nodes
        if node.executable == "lifecycle_manager"
    ]
    if managers:
        yield from _started(workspace)
    for package, node in managers:
        found = parameters_of(node, package.open_installed, "lifecycle_manager")
        given = found.values.get("node_names")
        if found.unknown and given is None:
            yield Undecided("programs", found.unknown)
        if given is not None and isinstance(given.value, list):
            for name in given.value:
                yield Use("node", str(name).rpartition("/")[2], given.location, "node_names")


def _started(workspace: Workspace) -> Iterator[Fact]:
    """Yield the nodes that launch files start, and that there may be more."""
    for _, _, launch in workspace.launches:
        if launch.more:
            yield Open("node", reason=launch.more)
    for _, node in workspace.nodes:
        name = workspace.name_of(node)
        if name is not None:
            yield Definition("node", name, node.location)
        elif node.package not in known()["without_lifecycle"]:
            yield Open("node")
