"""The entry points that a package's setup.py names, and whether their functions exist.

They are the programs of a Python package.
"""

import ast
import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import lru_cache
from posixpath import basename

from grader.base.grouping import group_values, only_one
from grader.base.names import closest, near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import MAX_NAMED, enumerated, first_part, last_part
from grader.ros.known.python_names import MODULES, python_names
from grader.ros.known.released import is_released
from grader.ros.known.rosdep_words import rosdep_words
from grader.ros.launch.launch_model import StartedNode
from grader.ros.package.package import Package
from grader.ros.python.budget import PYTHON_LIMIT
from grader.ros.python.constants import binds_unseen
from grader.ros.python.parse import (
    Code,
    SyntaxFault,
    bound_in,
    parse,
)
from grader.ros.python.walking import walk

_ENTRY = on_use(
    r"\s*([^=\s]+)\s*=\s*(\w+(?:\.\w+)*)\s*(?::\s*(\w+)(?:\.\w+)*\s*)?(?:\[.*)?", re.ASCII
)


_WRITTEN_NAME = on_use(r"""(?<=['"])[ \t]*([^'"=\s]+)[ \t]*=""")


_MAIN = "main"
# Arguments of setup() by which it installs modules that packages does not name.
_OTHER_MODULES = on_use(r"package_dir|py_modules|package_data|['\"]lib\b|site-packages")
_NAMES_PACKAGES = on_use(r"\bpackages\s*+=")
_CHANGES_PATH = on_use(r"\bsys\.(?:path|modules)\b|\baddsitedir\b")


class _EntryPoint(Named):
    """A program of console_scripts: `average_filter = sensor_hub.average_filter:main`."""

    name: str
    module: str
    function: str  # empty if it names none
    location: Location


class _EntryFault(Named):
    """Why a program certainly does not start, and where setup.py names it.

    It has the word there that may mean another one, which is sure for nearly the same name, or the
    only one that there is.
    """

    message: str
    location: Location
    written: str
    meant: str | None
    entry: _EntryPoint  # the one that is meant, else as it is written
    is_sure: bool = False


@lru_cache(maxsize=4)
def entry_points(package: Package) -> Sequence[_EntryPoint]:
    """Return the entry points that are known.

    These are those of console_scripts in setup.py that are written as texts.
    """
    setup = package.installation
    scripts = setup.console_scripts if setup else None
    if not isinstance(scripts, list | tuple):
        return []
    entries = []
    places = _places_of_names(package)
    for script in scripts:
        parts = _ENTRY.fullmatch(script) if isinstance(script, str) else None
        if parts:
            name, module, function = parts.groups()
            location = _locate_name(package, name, places)
            entries.append(_EntryPoint(name, module, function or "", location))
    return entries


def _places_of_names(package: Package) -> dict[str, int]:
    """Return where setup.py writes the beginnings of entry points."""
    setup = package.installation
    places = dict[str, int]()
    for written in _WRITTEN_NAME.finditer(setup.source.text if setup else ""):
        places.setdefault(written[1], written.start())
    return places


def _locate_name(package: Package, name: str, places: Mapping[str, int]) -> Location:
    """Return where setup.py writes an entry point.

    Returns where it calls setup() if the text is computed.
    """
    setup = package.installation
    assert setup
    if name in places:
        return setup.source.at(places[name])
    return setup.location(setup.called_at)


def entry_as_meant(package: Package, entry: _EntryPoint) -> _EntryPoint:
    """Return an entry point, or the one that is meant if it surely names no function."""
    fault = entry_fault(package, entry.name)
    return fault.entry if fault else entry


def certain_fault(package: Package, nodes: Collection[StartedNode]) -> _EntryFault | None:
    """Return the first fault of nodes none of whose programs starts; None where one may start."""
    faults = []
    for node in nodes:
        owner = package.find(node.package)
        faults.append(entry_fault(owner, node.executable) if owner else None)
    if None in faults:
        return None
    return next(iter(faults), None)


def entry_fault(package: Package, name: str) -> _EntryFault | None:
    """Return why a program certainly does not start; None where that is not known.

    Its module or the function in it is not there. Modules of other packages are not known, nor is
    what a module does to its own names: a star import, `exec`, `globals()`.
    """
    setup = package.installation
    named = _entries_by_name(package).get(name, ())
    if not setup or len(named) != 1 or package.tree.links or setup.unknown:
        return None
    [entry] = named
    path = module_path(package, entry.module)
    if path is not None:
        return _missing_function(package, entry, path) or _not_installed(package, entry, path)
    if _lacks_module(package, entry.module):
        return _missing_module(package, entry)
    return _without_package(package, entry) or _misspelt_package(package, entry)


def _missing_function(package: Package, entry: _EntryPoint, path: str) -> _EntryFault | None:
    """Return that a module lacks the function of an entry point; None if it may have it."""
    code, names = _names_of_module(package, path)
    if names is None or entry.function in names:
        return None
    if not entry.function:
        return _module_alone(entry, names)
    known = []
    functions = []
    for node in code.tree.body if code else ():
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            known.append(node.name)
        if isinstance(node, ast.FunctionDef):
            functions.append(node.name)
    only = only_one(functions) or ""
    fault = _fault(entry, f"{path} has no {entry.function!r}", entry.function, known, only)
    return fault._replace(entry=entry._replace(function=fault.meant or entry.function))


def _module_alone(entry: _EntryPoint, names: Collection[str]) -> _EntryFault | None:
    """Return that an entry point names no function; None if its module may do the work."""
    if _MAIN not in names:
        return None
    message = f"{entry.module} is a module; write {entry.module}:{_MAIN}"
    meant = entry._replace(function=_MAIN)
    return _EntryFault(message, entry.location, entry.module, None, meant)


def _not_installed(package: Package, entry: _EntryPoint, path: str) -> _EntryFault | None:
    """Return that setup.py does not install the package of Python with an entry point's module."""
    setup = package.installation
    home = path.rpartition("/")[0].replace("/", ".")
    if not setup or setup.unread or package.is_cmake or home in ("", *setup.packages):
        return None
    text = setup.source.text
    if not _NAMES_PACKAGES.search(text) or _OTHER_MODULES.search(text):
        return None
    message = f"setup.py installs no package {home}"
    if f"{home.replace('.', '/')}/__init__.py" not in package.tree.files:
        message += ", a folder without __init__.py"
    return _EntryFault(message, entry.location, home, None, entry)


@lru_cache(maxsize=4)
def _names_of_module(package: Package, path: str) -> tuple[Code | None, frozenset[str] | None]:
    """Return a parsed module of a package, and the names that it may bind."""
    code = read_module(package, path)
    return code, _certain_names(code) if code else None


@lru_cache(maxsize=4)
def _entries_by_name(package: Package) -> Mapping[str, Sequence[_EntryPoint]]:
    return group_values((entry.name, entry) for entry in entry_points(package))


def read_module(package: Package, path: str) -> Code | None:
    """Return a parsed Python file of a package; None for one that is not read."""
    code = _parse_module(package, path)
    return code if isinstance(code, Code) else None


def unreadable_module(package: Package, path: str) -> SyntaxFault | None:
    """Return why Python cannot read a file of a package, certainly or in the version that runs."""
    fault = _parse_module(package, path)
    return fault if isinstance(fault, SyntaxFault) else None


def _parse_module(package: Package, path: str) -> Code | SyntaxFault | None:
    data = package.tree.read(path, PYTHON_LIMIT)
    return parse(data, package.path(path), package.releases) if data is not None else None


def module_path(package: Package, module: str) -> str | None:
    """Return the file of a module by its full name; None where the package has none."""
    stem = module.replace(".", "/")
    return next(
        (path for path in (f"{stem}/__init__.py", f"{stem}.py") if path in package.tree.files), None
    )


class _MissingModule(Named):
    """A module of a package that a node imports and no build installs."""

    module: str  # as it is imported, with the name of what is imported from it
    package: str  # of Python, which setup.py does not install
    location: Location


def modules_not_installed(package: Package) -> Iterator[_MissingModule]:
    """Yield the modules of the package that an entry point imports and no build installs.

    setup.py lists the packages of Python that it installs; a folder in one of them is another one.
    Other modules may be those of other packages.
    """
    setup = package.installation
    if not setup or package.is_cmake or setup.unread or not setup.packages:
        return
    for path, code in _modules_of_entries(package):
        for module, statement in _imported_modules(code, path.rpartition("/")[0]):
            is_own = any(module.startswith(f"{name}.") for name in setup.packages)
            needed = _package_of_module(package, module) if is_own else None
            if needed is not None and needed not in setup.packages:
                at = code.at(statement)
                yield _MissingModule(module, needed, at)


def _modules_of_entries(package: Package) -> Iterator[tuple[str, Code]]:
    """Yield the modules that entry points name, each with its path."""
    for path in dict.fromkeys(module_path(package, each.module) for each in entry_points(package)):
        code = read_module(package, path) if path is not None else None
        if path is not None and code:
            yield path, code


def modules_beside(package: Package) -> Iterator[_MissingModule]:
    """Yield the modules that an entry point imports as if its own folder were searched.

    An installed program does not find them there. Other packages may have a module of such a name.
    """
    if not package.installation or package.is_cmake or package.installation.unread:
        return
    for path, code in _modules_of_entries(package):
        folder = path.rpartition("/")[0]
        around = read_module(package, f"{folder}/__init__.py")
        texts = [each.source.text for each in (code, around) if each]
        if not folder or any(map(_CHANGES_PATH.search, texts)):
            continue
        for module, statement in _imported_modules(code, ""):
            top = first_part(module)
            if getattr(statement, "level", 0) or f"{folder}/{top}.py" == path:
                continue
            if _is_only_beside(package, folder, top):
                at = code.at(statement)
                yield _MissingModule(top, folder.replace("/", "."), at)


def _is_only_beside(package: Package, folder: str, module: str) -> bool:
    """Return whether a module is in a folder, and nothing installs one of its name elsewhere."""
    is_there = f"{folder}/{module}.py" in package.tree.files
    return is_there and not _may_be_elsewhere(package, module)


def _may_be_elsewhere(package: Package, module: str) -> bool:
    """Return whether something installs a module of this name that is in no package of Python."""
    setup = package.installation
    if not setup or _OTHER_MODULES.search(setup.source.text):
        return True
    if module in setup.packages or f"{module}.py" in package.tree.files:
        return True
    if package.find(module) or package.depends_on(module) or is_released(module):
        return True
    return module in python_names(MODULES, package.releases) or module in rosdep_words().modules


def _imported_modules(code: Code, folder: str) -> Iterator[tuple[str, ast.stmt]]:
    """Yield the modules that the statements of a file import, without those in other statements."""
    for statement in code.tree.body:
        if isinstance(statement, ast.Import):
            for name in statement.names:
                yield name.name, statement
        elif isinstance(statement, ast.ImportFrom):
            parts = folder.split("/")[: 1 - statement.level or None] if statement.level else []
            base = parts + (statement.module or "").split(".")
            for name in statement.names:
                yield ".".join(filter(None, [*base, name.name])), statement


def _package_of_module(package: Package, module: str) -> str | None:
    """Return the package of Python that holds a module, or a name in it; None without one."""
    for name in (module, module.rpartition(".")[0]):
        path = module_path(package, name) if name else None
        if path is not None:
            return path.rpartition("/")[0].replace("/", ".") or None
    return None


def _lacks_module(package: Package, module: str) -> bool:
    """Return whether importing a module certainly fails.

    Then its parent packages are here, and none of them has it.
    """
    top = first_part(module)
    stem = module.replace(".", "/")
    tree = package.tree
    paths = dict.fromkeys((*tree.files, *tree.folders, *tree.unseen))
    homes = []
    for path in paths:
        if basename(path) == top and not path.startswith("resource/"):
            homes.append(path)
    if not homes:  # no other package of ROS 2 installs a Python package of this name
        single = (f"{top}.py", f"{top}.so")
        is_single = any(basename(path).startswith(single) for path in paths)
        return top == package.name and not is_single
    module_or_folder = (f"{stem}.", f"{stem}/")
    if homes != [top] or any(f"{path}/".startswith(module_or_folder) for path in paths):
        return False
    return _are_names_certain(package, stem)


def _are_names_certain(package: Package, stem: str) -> bool:
    """Return whether it is known what the packages above a module bind."""
    for path in package.tree.files:
        if path.endswith("/__init__.py") and stem.startswith(path.removesuffix("__init__.py")):
            code = read_module(package, path)
            if not code or _certain_names(code) is None:
                return False
    return True


def _without_package(package: Package, entry: _EntryPoint) -> _EntryFault | None:
    """Return that an entry point names a module of a package of Python without this package."""
    setup = package.installation
    module = entry.module
    if not setup or "." in module or _may_be_elsewhere(package, module):
        return None
    for top in setup.packages:
        path = f"{top.replace('.', '/')}/{module}.py"
        if path in package.tree.files and not _missing_function(package, entry, path):
            meant = f"{top}.{module}"
            message = f"there is no module {module}; did you mean {meant!r}?"
            named = entry._replace(module=meant)
            return _EntryFault(message, entry.location, module, meant, named, is_sure=True)
    return None


def _misspelt_package(package: Package, entry: _EntryPoint) -> _EntryFault | None:
    """Return that the top package of an entry point is not one that setup.py installs.

    It is like one that it installs. Returns None where another package may have it.
    """
    setup = package.installation
    top = first_part(entry.module)
    names = setup.packages if setup else ()
    installed = {first_part(name) for name in names}
    meant = near(top, installed)
    paths = (*package.tree.files, *package.tree.folders, *package.tree.unseen)
    is_there = any(top in path.removesuffix(".py").split("/") for path in paths)
    is_other = package.find(top) is not None or package.depends_on(top)
    if top in installed or meant is None or is_there or is_other:
        return None
    return _with_module(_fault(entry, f"there is no package {top}", top, [meant]), 0)


def _missing_module(package: Package, entry: _EntryPoint) -> _EntryFault:
    folder = entry.module.rpartition(".")[0].replace(".", "/")
    others = [
        path.removeprefix(f"{folder}/").removesuffix(".py")
        for path in package.tree.files
        if path.rpartition("/")[0] == folder
        and path.endswith(".py")
        and not path.endswith("__init__.py")
    ]
    same_name = entry.name if entry.name in others else ""
    written = last_part(entry.module)
    message = f"there is no module {entry.module}"
    return _with_module(_fault(entry, message, written, others, same_name), -1)


def _fault(
    entry: _EntryPoint, message: str, written: str, known: list[str], fallback: str = ""
) -> _EntryFault:
    """Return the fault of an entry point, with the name that may be meant.

    If none may be, it has the names that there are.
    """
    meant = closest(written, known) or fallback or None
    is_sure = meant is not None and meant in (near(written, known), fallback)
    if meant is not None:
        message += f"; did you mean {meant!r}?"
    elif known:
        message += f"; there is {enumerated([repr(module) for module in known[:MAX_NAMED]])}"
    return _EntryFault(message, entry.location, written, meant, entry, is_sure)


def _with_module(fault: _EntryFault, position: int) -> _EntryFault:
    """Return a fault of one of the names in a module's, whose entry has the one that is meant."""
    if fault.meant is None:
        return fault
    names = fault.entry.module.split(".")
    names[position] = fault.meant
    return fault._replace(entry=fault.entry._replace(module=".".join(names)))


def _certain_names(code: Code) -> frozenset[str] | None:
    """Return the names that a module may bind; None if it may bind others."""
    nodes = walk(code.tree)
    if binds_unseen(nodes) or any(
        isinstance(node, ast.alias) and node.name == "*" for node in nodes
    ):
        return None
    shared = {name for node in nodes if isinstance(node, ast.Global) for name in node.names}
    return bound_in(code.tree) | shared
