"""What one C++ file declares: includes, classes, functions, variables, other names and macros."""

import re
from collections.abc import Iterator
from functools import cached_property
from itertools import islice
from typing import NamedTuple

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.cpp.syntax import (
    NO_NODE,
    CppNode,
    CppNodes,
    CppSyntax,
)

_NOT_PLAIN = on_use(r"[<>\s]")  # in a name
CONDITIONS = (
    "preproc_if",
    "preproc_ifdef",
    "preproc_else",
    "preproc_elif",
    "preproc_elifdef",
)
_CLASSES = ("class_specifier", "struct_specifier")
_CONSTANTS = ("const", "constexpr", "constinit")
_CALLS = ("call_expression", "new_expression", "init_declarator", "declaration", "this")
_MAX_SCOPES = 64  # namespaces in each other, whose names are joined
_VARIABLES = (
    "declaration",
    "parameter_declaration",
    "optional_parameter_declaration",
    "for_range_loop",
    "init_statement",
)
_NAMES = ("identifier", "field_identifier", "type_identifier")


class CppClass(NamedTuple):
    """A class that is defined: its full name, and its bases as they are written."""

    name: str
    bases: Strings
    node: CppNode
    is_conditional: bool
    is_template: bool


class CppFunction(NamedTuple):
    """A function that is defined.

    `owner` is the class or namespace that its name begins with, as it is written, or the full name
    of the class around it. `class_name` is the full name of the class that it is a method of; the
    unit knows it.
    """

    name: str
    owner: str
    scopes: Strings  # the namespaces and classes around it
    node: CppNode
    is_conditional: bool
    is_template: bool
    class_name: str = ""

    @property
    def inner_scopes(self) -> Strings:
        """The namespaces and classes in which the names in it are searched."""
        return tuple(self.class_name.split("::")) if self.class_name else self.scopes

    @property
    def body(self) -> CppNode:
        """Its statements."""
        return self.node.child("body")

    @property
    def parameters(self) -> CppNodes:
        """Its parameters, in their order."""
        kinds = ("parameter_declaration", "optional_parameter_declaration")
        return _function_declarator(self.node).child("parameters").of_kind(*kinds)


class CppVariable(NamedTuple):
    """A variable of a namespace or class, with the value that it is declared with."""

    name: str  # in full
    declarator: CppNode  # of its name
    type: str  # as it is written
    value: CppNode
    is_constant: bool
    is_conditional: bool


class CppMacro(NamedTuple):
    """A macro without parameters, and the text that it stands for."""

    name: str
    text: str
    node: CppNode
    is_conditional: bool


class CppFile:
    """What a C++ file declares."""

    def __init__(self, syntax: CppSyntax) -> None:
        self.syntax = syntax
        self.includes: list[str] = []
        self.classes: list[CppClass] = []
        self.functions: list[CppFunction] = []
        self.variables: list[CppVariable] = []
        # Other names for types and namespaces, in full, each with the name that they stand for.
        self.aliases: list[tuple[str, str]] = []
        self.opened: list[str] = []  # what `using namespace` names
        self.macros: list[CppMacro] = []
        self.called_macros: dict[str, str] = {}  # those with parameters, and their texts
        _Reader(self).read()

    @cached_property
    def uses(self) -> CppNodes:
        """The names of variables, functions and members, in the order of the text."""
        names = ("identifier", "field_identifier")
        return [node for node in self.syntax.nodes if node.kind in names or is_argument(node)]

    @cached_property
    def words(self) -> frozenset[str]:
        """The names in the file, also those of types."""
        kinds = ("identifier", "field_identifier", "type_identifier", "namespace_identifier")
        return frozenset(node.text for node in self.syntax.nodes if node.kind in kinds)

    def of_kind(self, *kinds: str) -> Iterator[CppNode]:
        """Yield the nodes of these kinds, in the order of the text."""
        for node in self.syntax.nodes:
            if node.kind in kinds:
                yield node

    @cached_property
    def _comments(self) -> CppNodes:
        return list(self.of_kind("comment"))

    def found(self, pattern: re.Pattern[str]) -> Iterator[tuple[str, Location]]:
        """Yield what the first group of a pattern matches outside of comments, and its place."""
        for match in pattern.finditer(self.syntax.source.text):
            at = len(self.syntax.source.text[: match.start(1)].encode("utf-8", "replace"))
            if not any(comment.start <= at < comment.end for comment in self._comments):
                yield match[1], self.syntax.source.at(match.start(1))

    @cached_property
    def calls(self) -> CppNodes:
        """The calls and what makes objects, in the order of the text."""
        return [node for node in self.syntax.nodes if node.kind in _CALLS]


class _Around(NamedTuple):
    """Where a declaration is: in which scopes, and under what."""

    scopes: Strings = ()
    is_class: bool = False
    is_conditional: bool = False
    is_template: bool = False

    def full(self, name: str) -> str:
        return "::".join((*self.scopes, name))


_Inner = Iterator[tuple[CppNode, _Around]]  # declarations in another one, each with its place


class _Reader:
    """Reads the declarations of a file one by one, without those in functions."""

    def __init__(self, file: CppFile) -> None:
        self.file = file

    def read(self) -> None:
        pending = [(node, _Around()) for node in reversed(self.file.syntax.root.children)]
        while pending:
            node, place = pending.pop()
            pending += reversed(list(self._read(node, place)))

    def _read(self, node: CppNode, place: _Around) -> _Inner:
        """Read a declaration; yield those in it."""
        if node.kind in _DECLARATIONS:
            _DECLARATIONS[node.kind](self, node, place)
        if node.kind in _CLASSES:
            yield from self._read_class(node, place)
        elif node.kind == "namespace_definition":
            name = node.child("name").text
            inner = (*place.scopes, *name.split("::")) if name else place.scopes
            yield from _inside(node.child("body"), place._replace(scopes=inner[:_MAX_SCOPES]))
        elif node.kind == "linkage_specification":
            yield from _inside(node, place)
            yield from _inside(node.child("body"), place)
        elif node.kind == "template_declaration":
            yield from _inside(node, place._replace(is_template=True))
        elif node.kind == "ERROR" or (node.kind in CONDITIONS and not is_guard(node)):
            yield from _inside(node, place._replace(is_conditional=True))
        elif node.kind in CONDITIONS:
            yield from _inside(node, place)
        elif node.kind in ("declaration", "field_declaration", "type_definition"):
            kind = node.child("type")
            if kind.kind in _CLASSES:
                yield kind, place

    def read_include(self, node: CppNode, _: _Around) -> None:
        """Read an #include."""
        self.file.includes.append(node.child("path").text[1:-1])

    def read_called_macro(self, node: CppNode, _: _Around) -> None:
        """Read a macro with parameters."""
        self.file.called_macros[node.child("name").text] = node.child("value").text

    def read_macro(self, node: CppNode, place: _Around) -> None:
        """Read a macro without parameters."""
        name = node.child("name")
        if name:
            text = node.child("value").text.strip()
            self.file.macros.append(CppMacro(name.text, text, node, place.is_conditional))

    def read_using(self, node: CppNode, place: _Around) -> None:
        """Read a `using` of a name or of a namespace."""
        words = node.text.removesuffix(";").split()
        name = plain(words[-1]) if words else ""
        if "namespace" in words:
            self.file.opened.append(name)
        else:
            self.file.aliases.append((place.full(short_name(name)), name))

    def add_alias(self, node: CppNode, place: _Around) -> None:
        """Add another name for a type or a namespace."""
        name = node.child("name")
        kind = node.child("type")
        if not kind:
            kind = next((child for child in node.children if child is not name), NO_NODE)
        if name and kind:
            self.file.aliases.append((place.full(name.text), plain(kind.text)))

    def read_typedef(self, node: CppNode, place: _Around) -> None:
        """Read a typedef."""
        kind = node.child("type")
        for declarator in node.children:
            if declarator.field == "declarator" and kind:
                self.file.aliases.append((place.full(declarator.text), plain(kind.text)))

    def _read_class(self, node: CppNode, place: _Around) -> _Inner:
        name = node.child("name")
        body = node.child("body")
        if not name or not body:
            return
        bases = []
        for clause in node.of_kind("base_class_clause"):
            for base in clause.of_kind("type_identifier", "qualified_identifier", "template_type"):
                bases.append(plain(base.text))
        full = place.full(plain(name.text))
        self.file.classes.append(
            CppClass(full, tuple(bases), node, place.is_conditional, place.is_template)
        )
        inner = place._replace(scopes=(*place.scopes, plain(name.text)), is_class=True)
        yield from _inside(body, inner)

    def read_function(self, node: CppNode, place: _Around) -> None:
        """Read a function or method that is defined."""
        name = _function_declarator(node).child("declarator")
        if not name:
            return
        owner, _, last = plain(name.text).rpartition("::")
        if not owner and place.is_class:
            owner = "::".join(place.scopes)
        self.file.functions.append(
            CppFunction(last, owner, place.scopes, node, place.is_conditional, place.is_template)
        )

    def read_variables(self, node: CppNode, place: _Around) -> None:
        """Read the variables or members of a declaration."""
        type_node = node.child("type")
        for name, value in declared_in(node):
            if name.kind == "qualified_identifier":
                continue  # a static member, which is defined outside of its class
            variable = CppVariable(
                name=place.full(name.text),
                declarator=name,
                type=type_node.text,
                value=value,
                is_constant=is_constant(node),
                is_conditional=place.is_conditional,
            )
            self.file.variables.append(variable)
        if place.is_class and node.child("default_value"):  # it runs before the constructor
            owner = "::".join(place.scopes)
            self.file.functions.append(
                CppFunction("", owner, place.scopes, node, place.is_conditional, place.is_template)
            )


_DECLARATIONS = {
    "preproc_include": _Reader.read_include,
    "preproc_def": _Reader.read_macro,
    "preproc_function_def": _Reader.read_called_macro,
    "using_declaration": _Reader.read_using,
    "alias_declaration": _Reader.add_alias,
    "namespace_alias_definition": _Reader.add_alias,
    "type_definition": _Reader.read_typedef,
    "function_definition": _Reader.read_function,
    "declaration": _Reader.read_variables,
    "field_declaration": _Reader.read_variables,
}


def _inside(node: CppNode, place: _Around) -> _Inner:
    for child in node.children:
        yield child, place


def is_guard(node: CppNode) -> bool:
    """Return whether a condition only prevents that a header is read twice."""
    name = node.child("name")
    is_outermost = node.parent is node.file.root
    if node.kind != "preproc_ifdef" or not name or not is_outermost:
        return False
    defined = node.of_kind("preproc_def")
    return bool(defined) and defined[0].child("name").text == name.text


def is_constant(declaration: CppNode) -> bool:
    """Return whether a declaration says that its variables do not change."""
    return any(qualifier.text in _CONSTANTS for qualifier in declaration.of_kind("type_qualifier"))


def declared_in(declaration: CppNode) -> Iterator[tuple[CppNode, CppNode]]:
    """Yield the variables that a declaration declares: the node of each name, and its value."""
    value = declaration.child("default_value")
    for child in declaration.children:
        if child.field != "declarator":
            continue
        name = name_in(child)
        given = child.child("parameters")
        if given.children and all(map(_is_given, given.children)):
            name = child.child("declarator")
            value = given
        if name:
            yield name, child.child("value") if child.kind == "init_declarator" else value


def _is_given(parameter: CppNode) -> bool:
    """Return whether the parameter of what looks like a function is an argument of an object."""
    return any(map(is_argument, parameter.children))


def is_argument(node: CppNode) -> bool:
    """Return whether a name is an argument although the grammar takes it for a parameter's type.

    In a function, such a name is in `Type name(argument);`.
    """
    parent = node.parent
    is_name = node.kind in ("type_identifier", "qualified_identifier")
    if not is_name or parent.kind != "parameter_declaration":
        return False
    around = list(islice(node.ancestors(), 5))
    return len(around) == 5 and around[4].kind == "compound_statement" and len(parent.children) == 1


def find_declaration(name: CppNode) -> CppNode:
    """Return the declaration that declares a name as a local variable or a parameter.

    Returns NO_NODE for a name that is used.
    """
    node = name
    for around in name.ancestors():
        if around.kind in _VARIABLES:
            is_declared = any(declared is name for declared, _ in declared_in(around))
            return around if is_declared else NO_NODE
        if node.field == "value" or around.kind in ("argument_list", "compound_statement"):
            break
        node = around
    return NO_NODE


def name_in(declarator: CppNode) -> CppNode:
    """Return the name that a declarator declares; NO_NODE for a function, or without one."""
    node = declarator
    while node and node.kind not in (*_NAMES, "qualified_identifier"):
        if node.kind in ("function_declarator", "abstract_function_declarator"):
            return NO_NODE
        names = node.of_kind(*_NAMES)
        node = node.child("declarator") or (names[0] if names else node.first)
    return node


def _function_declarator(function: CppNode) -> CppNode:
    """Return the declarator of a function with its name and parameters."""
    node = function.child("declarator")
    while node and node.kind != "function_declarator":
        node = node.child("declarator") or node.first
    return node


def plain(name: str) -> str:
    """Return a name without white space, the arguments of templates and :: at its start."""
    if not _NOT_PLAIN.search(name):
        return name.removeprefix("::")
    depth = 0
    kept = []
    for letter in name:
        depth += (letter == "<") - (letter == ">")
        if depth == 0 and letter != ">" and not letter.isspace():
            kept.append(letter)
    return "".join(kept).removeprefix("::")


def short_name(name: str) -> str:
    """Return a name without the namespaces and classes before it."""
    return name.rpartition("::")[2]


def plain_name(node: CppNode) -> str:
    """Return the name that a node is, without the arguments of templates."""
    return plain(node.text)
