"""The names that may be written at a place of a workspace: what an editor offers."""

from collections.abc import Callable, Iterable, Mapping

from grader.ros.interfaces.known_interfaces import known_interfaces
from grader.ros.known.package_rows import find_programs, known_packages
from grader.ros.package.package import Package
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Definition
from grader.workspace.rules.reading import facts_once


def offered_names(workspace: Workspace, kind: str, owner: str = "") -> list[str]:
    """Return the names of a kind in alphabetical order, each once.

    Args:
        workspace: The packages and robots.
        kind: What is named, a key of `_FINDERS`.
        owner: The package of a program, a file or an interface, or what owns an argument; without
            it, any.
    """
    return sorted({name for name in _FINDERS[kind](workspace, owner) if name})


def _links(workspace: Workspace, _: str) -> Iterable[str]:
    return (link.name for robot in workspace.robots.known for link in robot.robot.links)


def _joints(workspace: Workspace, _: str) -> Iterable[str]:
    return (joint.name for robot in workspace.robots.known for joint in robot.robot.joints)


def _frames(workspace: Workspace, owner: str) -> Iterable[str]:
    return [*_links(workspace, owner), *_defined(workspace, "frame", "")]


def _materials(workspace: Workspace, _: str) -> Iterable[str]:
    for robot in workspace.robots.known:
        for element in robot.root.iter("material"):
            yield element.get("name", "")


def _controllers(workspace: Workspace, _: str) -> Iterable[str]:
    return [*workspace.installed.typed_sections, *_defined(workspace, "controller", "")]


def _packages(workspace: Workspace, _: str) -> Iterable[str]:
    return [*(package.name for package in workspace.packages), *known_packages()]


def _programs(workspace: Workspace, owner: str) -> Iterable[str]:
    programs = [*find_programs(owner)]
    for package in _owners(workspace, owner):
        folder = f"lib/{package.name}/"
        setup = package.installation
        installed = package.known_programs.targets if setup is not None else ()
        programs += (path.removeprefix(folder) for path in installed if path.startswith(folder))
        programs += (package.known_programs.listed or ()) if setup is not None else ()
    return programs


def _launch_files(workspace: Workspace, owner: str) -> Iterable[str]:
    for package in _owners(workspace, owner):
        yield from (path.rpartition("/")[2] for path in package.launch_files)


def _files(workspace: Workspace, owner: str) -> Iterable[str]:
    """Yield the paths of files below the share folder of their package."""
    for package in _owners(workspace, owner):
        for target in package.installed:
            if target.startswith(package.share):
                yield target.removeprefix(package.share)


def _owners(workspace: Workspace, owner: str) -> Iterable[Package]:
    return (package for package in workspace.packages if not owner or package.name == owner)


def _interfaces(part: str) -> Callable[[Workspace, str], Iterable[str]]:
    def find(workspace: Workspace, owner: str) -> Iterable[str]:
        own_interfaces = workspace.code.interfaces.get(owner)
        names = [*own_interfaces.types] if own_interfaces is not None else []
        names += known_interfaces(owner, workspace.releases) or ()
        start = f"{part}."
        return (name.removeprefix(start) for name in names if name.startswith(start))

    return find


def _arguments(kind: str) -> Callable[[Workspace, str], Iterable[str]]:
    return lambda workspace, owner: _defined(workspace, kind, owner)


def _defined(workspace: Workspace, kind: str, owner: str) -> Iterable[str]:
    for fact in facts_once(workspace).facts:
        if isinstance(fact, Definition) and fact.kind == kind and owner in ("", fact.owner):
            yield fact.name


_FINDERS: Mapping[str, Callable[[Workspace, str], Iterable[str]]] = {
    "link": _links,
    "joint": _joints,
    "frame": _frames,
    "material": _materials,
    "controller": _controllers,
    "package": _packages,
    "program": _programs,
    "launch file": _launch_files,
    "file": _files,
    "launch argument": _arguments("launch argument"),
    "xacro argument": _arguments("xacro argument"),
    "message": _interfaces("msg"),
    "service": _interfaces("srv"),
    "action": _interfaces("action"),
}
