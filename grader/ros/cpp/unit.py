"""The C++ files that are compiled into one program or library, and what their names mean."""

import posixpath
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property

from grader.base.grouping import Strings, group_values, only_one
from grader.ros.cpp.declarations import (
    CONDITIONS,
    CppClass,
    CppFile,
    CppFunction,
    CppMacro,
    CppVariable,
    is_guard,
    plain_name,
    short_name,
)
from grader.ros.cpp.syntax import (
    NO_NODE,
    CppNode,
    CppNodes,
    CppSyntax,
)

_Scopes = Sequence[str]

_MAX_ALIASES = 10  # in a row
_MAX_OPENED = 20  # namespaces


class CppUnit:
    """Files that are compiled together, with the headers of the package that they include.

    A name is searched in the scopes around it, from the inside to the outside, then in the
    namespaces that a file opens. One that is defined twice has several meanings.
    """

    def __init__(self, files: Sequence[CppFile]) -> None:
        self.files = tuple(files)
        opened = dict.fromkeys(name for file in files for name in file.opened)
        self.opened = tuple(opened)[:_MAX_OPENED]
        self._meanings: dict[tuple[str, Strings], Strings] = {}

    @cached_property
    def classes(self) -> Mapping[str, Sequence[CppClass]]:
        """The classes by their full names."""
        return group_values((each.name, each) for file in self.files for each in file.classes)

    @cached_property
    def functions(self) -> tuple[CppFunction, ...]:
        """The functions that are defined, with methods."""
        functions = [function for file in self.files for function in file.functions]
        return tuple(each._replace(class_name=self._find_class(each)) for each in functions)

    @cached_property
    def mains(self) -> Sequence[CppFunction]:
        """The functions main()."""
        return [each for each in self.functions if each.name == "main" and not each.owner]

    @cached_property
    def functions_by_name(self) -> Mapping[str, Sequence[CppFunction]]:
        """The functions that are defined by their names, without the class that they are of."""
        return group_values((function.name, function) for function in self.functions)

    @cached_property
    def _functions_by_file(self) -> Mapping[CppSyntax, Sequence[CppFunction]]:
        """The functions of each file, in their order; none is in another one."""
        ordered = sorted(self.functions, key=_start)
        return group_values((function.node.file, function) for function in ordered)

    @cached_property
    def variables(self) -> Mapping[str, Sequence[CppVariable]]:
        """The variables of namespaces and classes by their full names."""
        return group_values((each.name, each) for file in self.files for each in file.variables)

    @cached_property
    def _aliases(self) -> Mapping[str, _Scopes]:
        by_name: dict[str, list[str]] = {}
        for file in self.files:
            for name, target in file.aliases:
                targets = by_name.setdefault(name, [])
                if target not in targets:
                    targets.append(target)
        return by_name

    @cached_property
    def macros(self) -> Mapping[str, Sequence[CppMacro]]:
        """The macros without parameters by their names."""
        return group_values((each.name, each) for file in self.files for each in file.macros)

    @cached_property
    def _called_macros(self) -> Mapping[str, _Scopes]:
        """The texts of the macros with parameters by their names."""
        return group_values(
            (name, text) for file in self.files for name, text in file.called_macros.items()
        )

    def texts_of_macro(self, name: str) -> _Scopes:
        """Return the texts that a macro which is called stands for, with or without parameters."""
        plain_macros = self.macros.get(name, ())
        return [*self._called_macros.get(name, ()), *(macro.text for macro in plain_macros)]

    def meanings(self, name: str, scopes: _Scopes = ()) -> Strings:
        """Return the full names that a name of a type may stand for, in these scopes.

        What is not defined in the files is itself, also in the namespaces that are opened.
        """
        asked = (name, tuple(scopes))
        if asked not in self._meanings:
            self._meanings[asked] = self._search_meanings(name, scopes)
        return self._meanings[asked]

    def _search_meanings(self, name: str, scopes: _Scopes) -> Strings:
        for _ in range(_MAX_ALIASES):
            target = self._resolve_alias(name, scopes)
            if target is None:
                break
            name = target
        for candidate in self._candidates(name, scopes):
            if candidate in self.classes:
                return (candidate,)
        return (name, *(f"{opened}::{name}" for opened in self.opened))

    def _resolve_alias(self, name: str, scopes: _Scopes) -> str | None:
        """Return a name with its beginning replaced by what that stands for; None without one."""
        parts = name.split("::")
        for count in range(len(parts), 0, -1):
            first = "::".join(parts[:count])
            for candidate in self._candidates(first, scopes):
                targets = self._aliases.get(candidate, ())
                if len(targets) == 1 and targets[0] != first:
                    return "::".join((targets[0], *parts[count:]))
        return None

    def _candidates(self, name: str, scopes: _Scopes) -> Iterator[str]:
        for count in range(len(scopes), -1, -1):
            yield "::".join((*scopes[:count], name))
        for opened in self.opened:
            yield f"{opened}::{name}"

    def variables_named(self, name: str, scopes: _Scopes) -> Sequence[CppVariable]:
        """Return the variables that a name in these scopes means; several if it is defined so."""
        for candidate in self._candidates(name, scopes):
            if candidate in self.variables:
                return self.variables[candidate]
        return ()

    def _find_class(self, function: CppFunction) -> str:
        """Return the full name of the class that a function is a method of; empty without one."""
        if not function.owner:
            return ""
        meanings = self.meanings(function.owner, function.scopes)
        return meanings[0] if meanings[0] in self.classes else ""

    def scopes_at(self, node: CppNode) -> Strings:
        """Return the scopes of the function that a place is in; none outside of functions."""
        function = self.function_around(node)
        return function.inner_scopes if function else ()

    @cached_property
    def uses(self) -> Mapping[str, CppNodes]:
        """Where each name of a variable, function or member is written."""
        return group_values((use.text, use) for file in self.files for use in file.uses)

    def uses_in(self, function: CppFunction, name: str) -> CppNodes:
        """Return where a name is written in a function."""
        inside = function.node
        uses = [use for use in self.uses.get(name, ()) if use.file is inside.file]
        return [use for use in uses if inside.start <= use.start < inside.end]

    def calls_in(self, function: CppFunction) -> CppNodes:
        """Return the calls in a function, and what else makes objects or is the object itself."""
        return self._calls.get(function.node, [])

    @cached_property
    def _calls(self) -> Mapping[CppNode, CppNodes]:
        calls = [(self.function_around(node), node) for file in self.files for node in file.calls]
        return group_values((around.node, node) for around, node in calls if around)

    def function_around(self, node: CppNode) -> CppFunction | None:
        """Return the function that a place is in."""
        functions = self._functions_by_file.get(node.file, ())
        after = bisect_right(functions, node.start, key=_start)
        function = functions[after - 1] if after else None
        if function and node.start < function.node.end:
            return function
        return None


def _start(function: CppFunction) -> int:
    return function.node.start


def is_conditional(node: CppNode, until: CppNode) -> bool:
    """Return whether the preprocessor may leave out a place in another one."""
    for around in node.ancestors():
        if around is until:
            return False
        if around.kind in CONDITIONS and not is_guard(around):
            return True
    return False


def called_name(call: CppNode) -> str:
    """Return the name of what a call calls, as it is written, without the object before it."""
    if call.called is None:
        name = call.child("function")
        if name.kind == "field_expression":
            name = name.child("field")
            if name.kind == "dependent_name":
                name = name.first  # behind the word `template`
        call.called = plain_name(name)
    return call.called


def called_object(call: CppNode) -> CppNode:
    """Return the object whose method is called; NO_NODE for a function."""
    function = call.child("function")
    return function.child("argument") if function.kind == "field_expression" else NO_NODE


def is_given_to(node: CppNode, takers: _Scopes) -> bool:
    """Return whether an expression is an argument of a function with one of these names."""
    given = node.parent
    call = node.parent.parent
    if given.kind != "argument_list" or call.kind != "call_expression":
        return False
    return short_name(called_name(call)) in takers


def list_arguments(call: CppNode) -> CppNodes:
    """Return the arguments of a call, of a constructor or of an initializer."""
    given = call.child("arguments")
    if not given:
        lists = call.of_kind("argument_list", "initializer_list")
        given = lists[0] if lists else NO_NODE
    return given.code


def template_arguments(call: CppNode) -> Strings:
    """Return the arguments of the template that is called, as they are written."""
    node = call.child("function") if call.kind == "call_expression" else call
    while node:
        given = node.child("arguments")
        if given.kind == "template_argument_list":
            return tuple(argument.text for argument in given.code)
        if node.kind == "dependent_name":
            node = node.first
        else:
            node = node.child("field") or node.child("name")
    return ()


def resolve_include(path: str, included: str, files: Mapping[str, object]) -> str | None:
    """Return the file of a package that an `#include` in another one means.

    Returns None for one of another package. A folder of headers may be anywhere in the package.

    Args:
        path: The path of the file with the `#include`.
        included: The path that is included, as it is written.
        files: The files of the package by their paths.
    """
    beside = posixpath.normpath(posixpath.join(posixpath.dirname(path), included))
    for candidate in (beside, f"include/{included}", f"src/{included}", included):
        if candidate in files:
            return candidate
    headers = [file for file in files if file.startswith("include/") or "/include/" in file]
    elsewhere = [file for file in headers if file.endswith(f"/{included}")]
    return only_one(elsewhere)
