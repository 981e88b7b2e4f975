"""The slips in the files of a package, and what keeps its programs from running.

They are what its build, its launch files, or what reads its YAML refuses.
"""

import ast
import re

from grader.base.slips import Slip, Slips
from grader.base.source import Source
from grader.base.text import blanked
from grader.ros.config.yaml_slips import yaml_slips
from grader.ros.installation.installation import Installation
from grader.ros.launch.launch_slips import launch_slips, name_slips
from grader.ros.package.entry_points import entry_fault, entry_points
from grader.ros.package.package import SETUP, Package
from grader.ros.python.misspelt_words import read_as
from grader.ros.python.parse import Code, parse
from grader.ros.python.walking import walk

_LIMIT = 32 * 1024  # bytes of a file, because what may be meant is tried by reading it again
_MAX_FILES = 20
_MAX_ENTRIES = 20  # of setup.py
_YAML = (".yaml", ".yml", ".rviz")


def package_slips(package: Package) -> Slips:
    """Yield the slips in the files of a package: those of its build, of launch files, of YAML."""
    installation = package.installation
    yield from _manifest_slips(package)
    if installation:
        yield from _build_slips(package, installation)
    for path in package.launch_files[:_MAX_FILES]:
        if not path.endswith((".xml", ".yaml", ".yml")):
            yield from _python_file(package, path, is_launch_file=True)
    if installation and _has_programs(installation):
        from grader.ros.nodes.python.python_nodes import (
            program_slips,  # late: many have no programs
        )

        yield from program_slips(package)
    paths = [path for path in package.tree.files if path.lower().endswith(_YAML)]
    for path in paths[:_MAX_FILES]:
        data = package.tree.read(path, _LIMIT)
        if data is not None:
            yield from yaml_slips(data, package.path(path))


def _manifest_slips(package: Package) -> Slips:
    """Yield the build type that stands in package.xml beside the <export> that it belongs in."""
    data = package.tree.read("package.xml", _LIMIT)
    source = Source(package.path("package.xml"), (data or b"").decode("utf-8", "replace"))
    text = re.sub(r"(?s)<!--.*?(?:-->|\Z)", blanked, source.text)
    matches = list(re.finditer(r"<build_type>[^<>]*</build_type>", text))
    if len(matches) == 1 and "<export" not in text:
        [match] = matches
        edit = source.edit(*match.span(), f"<export>{match[0]}</export>")
        reaction = "the tools of ROS 2 read <build_type> in <export> only"
        assumption = f"{match[0]} is read inside of <export>"
        location = source.at(match.start())
        yield Slip((edit,), reaction, assumption, location, is_refused=True)


def _has_programs(installation: Installation) -> bool:
    copies = (copy for copy in installation.copies if copy.target.startswith("lib/"))
    return bool(installation.console_scripts) or any(copies)


def _programs(package: Package) -> set[str]:
    """Return the names of the programs that a build of a package installs."""
    installation = package.installation
    if not installation:
        return set()
    known = installation.known_programs()
    folder = f"lib/{package.name}/"
    copied = {path.removeprefix(folder) for path in known.targets if path.startswith(folder)}
    return copied.union(known.listed or ())


def _python_file(package: Package, path: str, *, is_launch_file: bool) -> Slips:
    data = package.tree.read(path, _LIMIT)
    if data is None:
        return
    parsed = parse(data, package.path(path), package.releases)
    if isinstance(parsed, Code) and is_launch_file:
        yield from launch_slips(parsed, package.name, _programs(package))
    elif isinstance(parsed, Code):
        yield from name_slips(parsed, package.name)
    else:
        from grader.ros.python.python_slips import python_slips  # late: most files are read

        yield from python_slips(data, package.path(path))


def _build_slips(package: Package, installation: Installation) -> Slips:
    manifest = package.manifest
    name = (manifest.name if manifest else None) or ""
    if package.is_cmake:
        if len(installation.source.text) > _LIMIT:
            return
        from grader.ros.installation.cmake.cmake_slips import cmake_slips

        needed = manifest.dependencies if manifest else ()
        yield from cmake_slips(installation.source, package.tree, name, needed)
        return
    yield from _python_file(package, SETUP, is_launch_file=False)
    data = package.tree.read(SETUP, _LIMIT)
    code = parse(data or b"", package.path(SETUP), package.releases)
    if isinstance(code, Code):
        yield from _absolute_slips(code)
        yield from _argument_slips(installation, code)
        yield from _entry_slips(package, code.source)
        yield from _name_slips(package, installation, code, name)


def _absolute_slips(code: Code) -> Slips:
    """Yield the last part of a path that begins with a slash, for which join() drops the others."""
    for node in walk(code.tree):
        match node:
            case ast.Call(
                func=ast.Attribute(attr="join"), args=[_, *_, ast.Constant(value=str(part)) as last]
            ) if part.startswith("/"):
                reaction = f"os.path.join() drops what stands before {part!r}"
                yield read_as(code, last, part, part.lstrip("/"), reaction)


def _argument_slips(installation: Installation, code: Code) -> Slips:
    """Yield the argument that setup() does not have, near one that it has."""
    ignored = installation.misspelt
    if not ignored or not ignored.meant:
        return
    for node in walk(code.tree):
        if isinstance(node, ast.keyword) and node.arg == ignored.name:
            reaction = f"setuptools ignores the argument {ignored.name}"
            yield read_as(code, node, ignored.name, ignored.meant, reaction, is_refused=False)


def _entry_slips(package: Package, source: Source) -> Slips:
    """Yield the module or function of an entry point that is not there, where one surely is meant.

    It is one of nearly the same name, or the only function of the module.
    """
    for entry in entry_points(package)[:_MAX_ENTRIES]:
        fault = entry_fault(package, entry.name)
        if not fault or fault.meant is None or not fault.is_sure:
            continue
        start = source.start_offset(entry.location)
        written = re.match(r"[^'\"\n]*", source.text[start:])
        places = [
            match.start()
            for match in re.finditer(r"\w+", written[0] if written else "")
            if match[0] == fault.written
        ]
        if places:
            begin = start + places[-1]
            edit = source.edit(begin, begin + len(fault.written), fault.meant)
            assumption = f"{fault.written} is read as {fault.meant}"
            message = f"the entry point of {entry.name!r} names no function: {fault.message}"
            yield Slip((edit,), message, assumption, entry.location, is_refused=True)


def _name_slips(package: Package, installation: Installation, code: Code, name: str) -> Slips:
    """Yield where setup.py has another name than package.xml.

    The files of the package have the name of package.xml.
    """
    written = installation.name
    if not written or not name or written == name or f"resource/{name}" not in package.tree.files:
        return
    for node in walk(code.tree):
        if isinstance(node, ast.Constant) and node.value == written:
            reaction = f"package.xml names the package {name!r}, setup.py {written!r}"
            yield read_as(code, node, written, name, reaction, is_refused=False)
