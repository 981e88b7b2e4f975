"""The messages, services and actions that a package of a workspace generates code for."""

import posixpath
from collections.abc import Collection, Iterable, Mapping, Sequence
from itertools import chain

from grader.base.records import Named
from grader.base.source import Location
from grader.ros.interfaces.interface_file import INTERFACE_ENDINGS, read_interface
from grader.ros.interfaces.interface_types import Interface
from grader.ros.package.package import Package

_MAX_FILES = 200
_MAX_FILE = 32 * 1024  # bytes
_BYTES_A_PART = 8


class _OwnInterface(Named):
    """A message, service or action of a package, and the path of its file in the workspace."""

    interface: Interface
    path: str


class PackageInterfaces(Named):
    """The messages, services and actions of a package by their names, msg.Twist.

    Without `is_complete`, the package may have more of them.
    """

    types: Mapping[str, _OwnInterface] = {}
    unlisted: Mapping[str, str] = {}  # those of files that nothing generates, and their paths
    dependencies: frozenset[str] = frozenset()  # packages whose messages they may use
    location: Location | None = None  # of rosidl_generate_interfaces()
    needs_group: bool = False
    is_complete: bool = True


def read_interfaces(package: Package) -> PackageInterfaces:
    """Return the messages, services and actions of a package. It never raises."""
    setup = package.installation
    if not setup or setup.fault:
        return PackageInterfaces(is_complete=False)
    files = _interface_files(package)
    calls = setup.interfaces
    paths = list(chain.from_iterable(call.files[:_MAX_FILES] for call in calls))
    types, are_all_read = _read_types(package, paths)
    dependencies = frozenset(chain.from_iterable(call.dependencies for call in calls))
    return PackageInterfaces(
        types,
        _name_others(package, files, paths, types),
        dependencies,
        setup.location(calls[0].at) if calls else None,
        needs_group=any(call.needs_group and call.is_certain for call in calls),
        is_complete=are_all_read and _are_files_certain(package, files),
    )


def _name_others(
    package: Package, files: Iterable[str], listed: Iterable[str], types: Collection[str]
) -> dict[str, str]:
    """Return the files that no call lists, by the names of interfaces that are not read."""
    known = set(listed)
    others = {}
    for path in files:
        name = _read_name(path)
        if path not in known and name not in types:
            others[name] = package.path(path)
    return others


def _are_files_certain(package: Package, files: Collection[str]) -> bool:
    """Return whether all interfaces of a package are certainly made of these files."""
    setup = package.installation
    if not setup or setup.doubt or len(files) > _MAX_FILES:
        return False
    return all(call.is_certain for call in setup.interfaces) and not _has_modules(package)


def _read_types(package: Package, paths: Iterable[str]) -> tuple[dict[str, _OwnInterface], bool]:
    """Return the interfaces in files of a package by their names, and whether all are read."""
    types = {}
    is_complete = True
    for path in paths:
        if not path.endswith(INTERFACE_ENDINGS):
            is_complete = False  # .idl is not read
            continue
        data = package.tree.read(path, _MAX_FILE)
        if data is None or not package.budget.take_of_whole(len(data) // _BYTES_A_PART):
            is_complete = False
            continue
        interface = read_interface(data, package.path(path), package.name)
        types[_read_name(path)] = _OwnInterface(interface, package.path(path))
    return types, is_complete


def _interface_files(package: Package) -> Sequence[str]:
    inner = (*package.inner, "test/")
    return [
        path
        for path in package.tree.files
        if path.endswith(INTERFACE_ENDINGS) and not path.startswith(inner)
    ]


def _read_name(path: str) -> str:
    """Return the name of the type that a file defines: its folder, as rosidl does, and its name."""
    folder, name = posixpath.split(posixpath.splitext(path)[0])
    return f"{posixpath.basename(folder)}.{name}"


def _has_modules(package: Package) -> bool:
    """Return whether a package has own Python modules in the place of generated ones."""
    folder = f"{package.name}/"
    starts = tuple(
        f"{folder}{kind}{end}" for kind in ("msg", "srv", "action") for end in ("/", ".py")
    )
    return any(path.startswith(starts) and path.endswith(".py") for path in package.tree.files)
