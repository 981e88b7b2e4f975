"""The C++ files that are compiled into one program or library, and what their names mean."""

import posixpath
from bisect import bisect_right
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property

from grader.ros.cpp.declarations import (
    CONDITIONS,
    CppClass,
    CppFile,
    CppFunction,
    CppMacro,
    CppVariable,
    is_guard,
    plain_name,
)
from grader.ros.cpp.syntax import CppNode, CppSyntax

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
        self._meanings: dict[tuple[str, tuple[str, ...]], tuple[str, ...]] = {}

    @cached_property
    def classes(self) -> Mapping[str, Sequence[CppClass]]:
        """The classes by their full names."""
        by_name: dict[str, list[CppClass]] = {}
        for file in self.files:
            for each in file.classes:
                by_name.setdefault(each.name, []).append(each)
        return by_name

    @cached_property
    def functions(self) -> tuple[CppFunction, ...]:
        """The functions that are defined, with methods."""
        return tuple(function for file in self.files for function in file.functions)

    @cached_property
    def functions_by_name(self) -> Mapping[str, Sequence[CppFunction]]:
        """The functions that are defined by their names, without the class that they are of."""
        by_name: dict[str, list[CppFunction]] = {}
        for function in self.functions:
            by_name.setdefault(function.name, []).append(function)
        return by_name

    @cached_property
    def _functions_by_file(self) -> Mapping[CppSyntax, Sequence[CppFunction]]:
        """The functions of each file, in their order; none is in another one."""
        return {file.syntax: sorted(file.functions, key=_start) for file in self.files}

    @cached_property
    def variables(self) -> Mapping[str, Sequence[CppVariable]]:
        """The variables of namespaces and classes by their full names."""
        by_name: dict[str, list[CppVariable]] = {}
        for file in self.files:
            for each in file.variables:
                by_name.setdefault(each.name, []).append(each)
        return by_name

    @cached_property
    def _aliases(self) -> Mapping[str, Sequence[str]]:
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
        by_name: dict[str, list[CppMacro]] = {}
        for file in self.files:
            for name, each in file.macros.items():
                by_name.setdefault(name, []).extend(each)
        return by_name

    @cached_property
    def _called_macros(self) -> Mapping[str, Sequence[str]]:
        """The texts of the macros with parameters by their names."""
        by_name: dict[str, list[str]] = {}
        for file in self.files:
            for name, text in file.called_macros.items():
                by_name.setdefault(name, []).append(text)
        return by_name

    def texts_of_macro(self, name: str) -> Sequence[str]:
        """Return the texts that a macro which is called stands for, with or without parameters."""
        plain_macros = self.macros.get(name, ())
        return [*self._called_macros.get(name, ()), *(macro.text for macro in plain_macros)]

    def meanings(self, name: str, scopes: Sequence[str] = ()) -> tuple[str, ...]:
        """Return the full names that a name of a type may stand for, in these scopes.

        What is not defined in the files is itself, also in the namespaces that are opened.
        """
        asked = (name, tuple(scopes))
        if asked not in self._meanings:
            self._meanings[asked] = self._search_meanings(name, scopes)
        return self._meanings[asked]

    def _search_meanings(self, name: str, scopes: Sequence[str]) -> tuple[str, ...]:
        for _ in range(_MAX_ALIASES):
            target = self._resolve_alias(name, scopes)
            if target is None:
                break
            name = target
        for candidate in self._candidates(name, scopes):
            if candidate in self.classes:
                return (candidate,)
        return (name, *(f"{opened}::{name}" for opened in self.opened))

    def _resolve_alias(self, name: str, scopes: Sequence[str]) -> str | None:
        """Return a name with its beginning replaced by what that stands for; None without one."""
        parts = name.split("::")
        for count in range(len(parts), 0, -1):
            first = "::".join(parts[:count])
            for candidate in self._candidates(first, scopes):
                targets = self._aliases.get(candidate, ())
                if len(targets) == 1 and targets[0] != first:
                    return "::".join((targets[0], *parts[count:]))
        return None

    def _candidates(self, name: str, scopes: Sequence[str]) -> Iterator[str]:
        for count in range(len(scopes), -1, -1):
            yield "::".join((*scopes[:count], name))
        for opened in self.opened:
            yield f"{opened}::{name}"

    def variables_named(self, name: str, scopes: Sequence[str]) -> Sequence[CppVariable]:
        """Return the variables that a name in these scopes means; several if it is defined so."""
        for candidate in self._candidates(name, scopes):
            if candidate in self.variables:
                return self.variables[candidate]
        return ()

    def find_owner(self, function: CppFunction) -> str:
        """Return the full name of the class that a function is a method of; empty without one."""
        if not function.owner:
            return ""
        meanings = self.meanings(function.owner, function.scopes)
        return meanings[0] if meanings[0] in self.classes else ""

    def list_scopes(self, function: CppFunction) -> tuple[str, ...]:
        """Return the namespaces and classes in which the names of a function are searched."""
        owner = self.find_owner(function)
        return tuple(owner.split("::")) if owner else function.scopes

    @cached_property
    def uses(self) -> Mapping[str, Sequence[CppNode]]:
        """Where each name of a variable, function or member is written."""
        by_name: dict[str, list[CppNode]] = {}
        for file in self.files:
            for name, nodes in file.uses.items():
                by_name.setdefault(name, []).extend(nodes)
        return by_name

    def calls_in(self, function: CppFunction) -> Sequence[CppNode]:
        """Return the calls in a function, and what else makes objects or is the object itself."""
        return self._calls.get(function.node, ())

    @cached_property
    def _calls(self) -> Mapping[CppNode, Sequence[CppNode]]:
        calls: dict[CppNode, list[CppNode]] = {}
        for file in self.files:
            for node in file.calls:
                function = self.function_around(node)
                if function is not None:
                    calls.setdefault(function.node, []).append(node)
        return calls

    def function_around(self, node: CppNode) -> CppFunction | None:
        """Return the function that a place is in."""
        functions = self._functions_by_file.get(node.file, ())
        after = bisect_right(functions, node.start, key=_start)
        function = functions[after - 1] if after else None
        if function is not None and node.start < function.node.end:
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
        if name is not None and name.kind == "field_expression":
            name = name.child("field")
            if name is not None and name.kind == "dependent_name" and name.children:
                name = name.children[0]  # behind the word `template`
        call.called = plain_name(name) if name is not None else ""
    return call.called


def list_arguments(call: CppNode) -> list[CppNode]:
    """Return the arguments of a call, of a constructor or of an initializer."""
    given = call.child("arguments")
    if given is None:
        lists = call.of_kind("argument_list", "initializer_list")
        given = lists[0] if lists else None
    if given is None:
        return []
    return [child for child in given.children if child.kind != "comment"]


def template_arguments(call: CppNode) -> tuple[str, ...]:
    """Return the arguments of the template that is called, as they are written."""
    node = call.child("function") if call.kind == "call_expression" else call
    while node is not None:
        given = node.child("arguments")
        if given is not None and given.kind == "template_argument_list":
            return tuple(argument.text for argument in given.children if argument.kind != "comment")
        if node.kind == "dependent_name" and node.children:
            node = node.children[0]
            continue
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
    return elsewhere[0] if len(elsewhere) == 1 else None
