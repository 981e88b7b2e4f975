"""The slips in the names of a Python launch file: what it imports, calls and defines."""

import ast
from collections.abc import Collection

from grader.base.grouping import StringsByName
from grader.base.names import closest, near
from grader.base.slips import Slip, Slips
from grader.base.text import last_part
from grader.ros.known.package_files import packages_with_files
from grader.ros.known.package_rows import find_programs, lacks_program, package_row
from grader.ros.known.python_names import python_names
from grader.ros.launch.launch_classes import class_named, exports
from grader.ros.python.bindings import bound_names
from grader.ros.python.misspelt_words import read_as
from grader.ros.python.parse import Code
from grader.ros.python.walking import walk

_FUNCTION = "generate_launch_description"


def launch_slips(code: Code, package: str, programs: Collection[str]) -> list[Slip]:
    """Return the slips in names for which Python stops before it launches anything.

    The file is of a package with these programs.
    """
    return list(_LaunchNames(code, package, programs).found())


def name_slips(code: Code, package: str) -> list[Slip]:
    """Return the names that a Python file of a package uses and does not define.

    Each is near one that it defines, or that of the package without quotes.
    """
    return list(_LaunchNames(code, package).undefined())


class _LaunchNames:
    """The names of one file."""

    def __init__(self, code: Code, package: str, programs: Collection[str] = ()) -> None:
        self._code = code
        self._package = package
        self._programs = programs
        self._nodes = walk(code.tree)
        self._bound: set[str] = set()
        self._classes: dict[str, str] = {}  # the full names of imported classes
        self._renamed: dict[str, str] = {}  # what an import is read as
        for node in self._nodes:
            self._bound.update(bound_names(node))
            if isinstance(node, ast.ImportFrom) and node.module:
                for alias in node.names:
                    self._classes[alias.asname or alias.name] = f"{node.module}.{alias.name}"

    def found(self) -> Slips:
        """Yield the slips in the order of the file, those of imports first."""
        for node in self._nodes:
            if isinstance(node, ast.ImportFrom):
                known = exports().get(node.module or "")
                if known is not None:
                    yield from self._of_import(node, known)
        yield from self._of_function()
        yield from self.undefined()
        for node in self._nodes:
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                yield from self._of_arguments(node, node.func.id)
                if last_part(self._full_name(node.func.id)) == "Node":
                    yield from self._of_program(node)

    def _of_import(self, node: ast.ImportFrom, known: StringsByName) -> Slips:
        for alias in node.names:
            if alias.name in known or alias.name == "*":
                continue
            if alias.asname is None:
                self._bound.discard(alias.name)
            # A class is not a module: LaunchDescription and launch_description.
            is_class = alias.name[:1].isupper()
            meant = _surely(alias.name, [name for name in known if name[:1].isupper() == is_class])
            if meant is None:
                continue
            if alias.asname is None:
                self._renamed[alias.name] = meant
                self._bound.add(meant)
                self._classes[meant] = f"{node.module}.{meant}"
            yield read_as(
                self._code, alias, alias.name, meant, f"{node.module} has no {alias.name}"
            )

    def _of_function(self) -> Slips:
        functions = [node for node in self._code.tree.body if isinstance(node, ast.FunctionDef)]
        if any(node.name == _FUNCTION for node in functions):
            return
        for node in functions:
            if near(node.name, [_FUNCTION]) is not None:
                reaction = f"the launch file defines no {_FUNCTION}()"
                yield read_as(self._code, node, node.name, _FUNCTION, reaction)

    def undefined(self) -> Slips:
        """Yield the names that are used and not defined."""
        if "*" in self._bound:
            return
        defined = {*self._bound, "__file__", *python_names("builtins", self._code.releases)}
        for node in self._nodes:
            if not isinstance(node, ast.Name) or not isinstance(node.ctx, ast.Load):
                continue
            name = node.id
            if name in defined:
                continue
            meant = self._renamed.get(name) or _surely(name, self._bound)
            if name == self._package:
                meant = repr(name)
            if meant is not None:
                yield read_as(self._code, node, name, meant, f"the name {name} is not defined")

    def _of_arguments(self, call: ast.Call, function: str) -> Slips:
        known = class_named(self._full_name(function))
        if not known:
            return
        given = {keyword.arg for keyword in call.keywords}
        for keyword in call.keywords:
            name = keyword.arg
            if name is None or name in known.parameters:
                continue
            meant = _surely(name, known.parameters.keys() - given)
            if meant is not None:
                yield read_as(
                    self._code, keyword, name, meant, f"{function}() has no argument {name}"
                )

    def _of_program(self, call: ast.Call) -> Slips:
        """Yield the package or the program of a node near one that ROS 2 has."""
        given = {}
        for keyword in call.keywords:
            if isinstance(keyword.value, ast.Constant) and isinstance(keyword.value.value, str):
                given[keyword.arg or ""] = keyword.value
        if not {"package", "executable"} <= given.keys():
            return
        package = str(given["package"].value)
        program = str(given["executable"].value)
        if package_row(package).is_installed:
            meant = (
                near(program, find_programs(package)) if lacks_program(package, program) else None
            )
            if meant is not None:
                reaction = f"the package {package} has no program {program!r}"
                yield read_as(self._code, given["executable"], program, meant, reaction)
            return
        meant = near(package, (self._package, *packages_with_files()))
        if meant is None:
            return
        is_own = meant == self._package and program in self._programs
        if is_own or program in (package_row(meant).programs or ()):
            reaction = f"ROS 2 has no package {package!r}"
            yield read_as(self._code, given["package"], package, meant, reaction)

    def _full_name(self, function: str) -> str:
        """Return the full name of an imported class, where it is defined."""
        module, _, name = self._classes.get(function, "").rpartition(".")
        return exports().get(module, {}).get(name, "")


def _surely(name: str, known: Collection[str]) -> str | None:
    return near(name, known) or closest(name, known, is_clear=True)
