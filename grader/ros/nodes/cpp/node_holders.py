"""What holds a node in C++ code: a variable, a parameter or a member that is given one.

A helper that is given a node declares and opens for it. So the facts of a holder are those of each
node that reaches it.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import Literal, NamedTuple

from grader.base.grouping import Strings, only_one
from grader.ros.cpp.declarations import (
    CppFunction,
    declared_in,
    find_declaration,
    is_argument,
    name_in,
    plain,
    short_name,
)
from grader.ros.cpp.objects import class_written, made_in
from grader.ros.cpp.syntax import (
    NO_NODE,
    CppNode,
    CppNodes,
)
from grader.ros.cpp.unit import (
    CppUnit,
    called_name,
    called_object,
    list_arguments,
    template_arguments,
)
from grader.ros.known.package_tables import cpp_table
from grader.ros.python.budget import Budget

_MAX_DEPTH = 10  # of expressions that are other expressions
_MAKERS = ("make_shared", "make_unique")
# Methods and functions whose result is the node itself, of its owner or of its first argument.
_SAME_METHODS = ("get", "lock", "shared_from_this", "weak_from_this")
_SAME_FUNCTIONS = ("move", "ref", "static_pointer_cast", "dynamic_pointer_cast", "shared_ptr")
_AROUND = ("pointer_expression", "parenthesized_expression")  # an expression that is the same
_SAME = (*_AROUND, "initializer_list")
_LISTS = ("argument_list", "initializer_list", "parameter_list")
# The endings of types of pointers to a class, as in rclcpp::Node::SharedPtr.
_POINTERS = ("SharedPtr", "ConstSharedPtr", "WeakPtr", "UniquePtr")
_NAMES = ("identifier", "field_identifier", "type_identifier")
_NODE_NAMES = ("Node", "LifecycleNode")
_GETTER = "get_node"
_PARAMETERS = ("parameter_declaration", "optional_parameter_declaration")


class Holder(NamedTuple):
    """What may hold a node.

    `scope` is the function of a local variable or of a parameter, the full name of the class of a
    member, and empty for a variable of a namespace. `own` is the node of a base class of another
    package, which `get_node()` returns.
    """

    kind: Literal["local", "member", "shared", "own"]
    scope: str | CppNode
    name: str


NodeKey = str | CppNode | Holder  # a class of nodes, where one is made, or what holds one


class NodeHolders:
    """Finds which node an expression is, and what is given a node."""

    def __init__(
        self,
        unit: CppUnit,
        node_classes: frozenset[str],
        node_made: Callable[[CppNode], NodeKey | None],
        budget: Budget,
    ) -> None:
        """Args as `_Target` has them.

        Args:
            unit: The files.
            node_classes: The classes of nodes, with those of rclcpp, by their full names.
            node_made: Returns the key of the node that a call or declaration makes.
            budget: What is charged.
        """
        self._unit = unit
        self._classes = node_classes
        self._budget = budget
        self._node_made = node_made
        self._declared: dict[tuple[CppNode, str], CppNodes] = {}
        self._types: dict[tuple[str, Strings], bool] = {}

    # --- Types
    # ----------------------------------------------------------------------

    def is_node_type(self, written: str, scopes: Sequence[str]) -> bool:
        """Return whether a type is that of a node, of a pointer or of a reference to one."""
        key = (written, tuple(scopes))
        if key not in self._types:
            self._budget.charge(1, len(written))
            self._types[key] = self._names_node(written, scopes)
        return self._types[key]

    def _names_node(self, written: str, scopes: Sequence[str]) -> bool:
        outer, _, inner = written.partition("<")
        if inner and short_name(plain(outer)) in ("shared_ptr", "weak_ptr", "unique_ptr"):
            return self.is_node_type(inner.rpartition(">")[0], scopes)
        words = [word for word in written.split() if word not in ("const", "typename", "class")]
        name = plain("".join(words).rstrip("&*"))
        if self._is_of_another_package(name):
            return True
        for meaning in self._unit.meanings(name, scopes):
            first, _, last = meaning.rpartition("::")
            if last in _POINTERS:
                meanings = self._unit.meanings(first, scopes)
                return not self._classes.isdisjoint(meanings)
            if meaning in self._classes:
                return True
        return False

    def _is_of_another_package(self, name: str) -> bool:
        """Return whether a type is a class of nodes of another package, as its name says."""
        first, _, last = name.rpartition("::")
        written = first if last in _POINTERS else name
        scope, _, short = written.rpartition("::")
        return short in _NODE_NAMES and bool(scope) and scope != "YAML"

    @cached_property
    def _members(self) -> dict[str, set[str]]:
        """The classes that have a member which holds a node, by its name."""
        classes: dict[str, set[str]] = {}
        for full, variables in self._unit.variables.items():
            scope, _, name = full.rpartition("::")
            scopes = scope.split("::") if scope else []
            is_node = any(self.is_node_type(variable.type, scopes) for variable in variables)
            if is_node or any(self._is_any_type(variable.type, scope) for variable in variables):
                classes.setdefault(name, set()).add(scope)
        return classes

    def _is_any_type(self, written: str, name: str) -> bool:
        """Return whether a type is a parameter of the template that a class is."""
        words = set(re.findall(r"\w+", written))
        for each in self._unit.classes.get(name, ()):
            for parameter in each.node.parent.child("parameters").children:
                if parameter.text.split()[-1] in words:
                    return True
        return False

    # --- Expressions
    # ----------------------------------------------------------------------

    def find_node(self, node: CppNode, function: CppFunction, depth: int = 0) -> NodeKey | None:
        """Return the node that an expression in a function is; None where that is not known."""
        self._budget.charge(1)
        if depth > _MAX_DEPTH:
            return None
        if node.kind == "this":
            owner = function.class_name
            is_own = owner in self._classes and owner not in cpp_table().nodes
            return owner if is_own else None
        if node.kind in _NAMES:
            return self._node_named(node, function, depth)
        if node.kind == "field_expression":
            return self._node_of_member(node, function)
        if node.kind in _SAME and node.children:
            inner = node.child("argument") or node.first
            return self.find_node(inner, function, depth + 1)
        made = self._node_made(node)
        is_call = made is None and node.kind == "call_expression"
        return self._node_of_call(node, function, depth) if is_call else made

    def _node_named(self, node: CppNode, function: CppFunction, depth: int) -> NodeKey | None:
        name = node.text
        declared = self._declared_in(function, name)
        if len(declared) > 1:
            return None
        if declared:
            return self._node_of_local(declared[0], function, depth)
        return self._holder_of_member(function.class_name, name)

    def _declared_in(self, function: CppFunction, name: str) -> CppNodes:
        """Return the names in the declarations of a local variable or parameter of a function."""
        key = (function.node, name)
        if key not in self._declared:
            uses = self._uses_in(function, name)
            self._declared[key] = [use for use in uses if find_declaration(use)]
        return self._declared[key]

    def _uses_in(self, function: CppFunction, name: str) -> CppNodes:
        self._budget.charge(1 + len(self._unit.uses.get(name, ())))
        return self._unit.uses_in(function, name)

    def _is_assigned(self, function: CppFunction, name: str) -> bool:
        """Return whether a local variable gets another value than that of its declaration."""
        for use in self._uses_in(function, name):
            if use.parent.kind == "assignment_expression" and use.field == "left":
                return True
        return False

    def _node_of_local(self, name: CppNode, function: CppFunction, depth: int) -> NodeKey | None:
        """Return the node of a local variable: the one that it is made with, or what holds it."""
        declaration = find_declaration(name)
        kind = declaration.child("type").text
        is_node = self.is_node_type(kind, function.inner_scopes)
        if declaration.kind in _PARAMETERS:
            is_given = function.is_template
        else:
            made = self._node_made(made_in(name.parent))
            if made is not None and not self._is_assigned(function, name.text):
                return made
            value = dict(declared_in(declaration)).get(name, NO_NODE)
            is_given = bool(value) and self.find_node(value, function, depth + 1) is not None
        return Holder("local", function.node, name.text) if is_node or is_given else None

    def _holder_of_member(self, owner: str, name: str) -> Holder | None:
        """Return the member of a class or of its bases, or the variable of a namespace."""
        classes = self._members.get(name, set())
        for each in self.with_bases(owner):
            if each in classes:
                return Holder("member", each, name)
        shared = [scope for scope in classes if scope not in self._unit.classes]
        if len(shared) == 1:
            return Holder("shared", shared[0], name)
        is_known = owner in self._classes or self._is_variable(owner, name)
        return None if is_known or not self.has_other_base(owner) else Holder("own", owner, "")

    def _is_variable(self, owner: str, name: str) -> bool:
        """Return whether a class, one of its bases or a namespace has a variable of a name."""
        scopes = owner.split("::")
        if self._unit.variables_named(name, scopes):
            return True
        return any(f"{each}::{name}" in self._unit.variables for each in self.with_bases(owner))

    def with_bases(self, name: str) -> Iterator[str]:
        """Yield a class and those of its bases that the files define."""
        pending = [name]
        seen = set()
        while pending:
            each = pending.pop(0)
            if each in seen or each not in self._unit.classes:
                continue
            seen.add(each)
            yield each
            scopes = each.split("::")[:-1]
            for base in self._unit.classes[each][0].bases:
                self._budget.charge(1)
                pending += self._unit.meanings(base, scopes)

    def has_other_base(self, name: str) -> bool:
        """Return whether a class is derived from one that the files do not define."""
        for each in self.with_bases(name):
            scopes = each.split("::")[:-1]
            for base in self._unit.classes[each][0].bases:
                meanings = self._unit.meanings(base, scopes)
                is_standard = meanings[0].startswith("std::")
                if not is_standard and not any(name in self._unit.classes for name in meanings):
                    return True
        return False

    def _node_of_member(self, node: CppNode, function: CppFunction) -> NodeKey | None:
        """Return the node that a member of the object itself, or of another one, holds."""
        name = node.child("field").text
        if node.child("argument").kind == "this":
            return self._holder_of_member(function.class_name, name)
        classes = self._members.get(name, set())
        return Holder("member", next(iter(classes)), name) if len(classes) == 1 else None

    def _node_of_call(self, call: CppNode, function: CppFunction, depth: int) -> NodeKey | None:
        """Return the node that a call returns: what it is given, or a member of its object."""
        name = short_name(called_name(call))
        owner = called_object(call)
        same = owner if name in _SAME_METHODS else NO_NODE
        if name in _SAME_FUNCTIONS:
            same = next(iter(list_arguments(call)), NO_NODE)
        if same:
            return self.find_node(same, function, depth + 1)
        of_class = function.class_name
        if name in _SAME_METHODS:
            return of_class if of_class in self._classes else None
        is_own = owner.kind in ("", "this")
        getters = self._methods_named(name, of_class if is_own else None)
        if len(getters) == 1:
            return self._node_returned(getters[0], depth)
        is_inherited = is_own and not getters and self.has_other_base(of_class)
        return Holder("own", of_class, "") if is_inherited and name == _GETTER else None

    def _methods_named(self, name: str, owner: str | None) -> list[CppFunction]:
        """Return the methods of a class and its bases by their name, or those of any class."""
        owners = None if owner is None else {*self.with_bases(owner)}
        methods = []
        for function in self._unit.functions_by_name.get(name, ()):
            of_class = function.class_name
            if of_class and (owners is None or of_class in owners):
                methods.append(function)
        return methods

    def _node_returned(self, getter: CppFunction, depth: int) -> NodeKey | None:
        """Return the node that a method returns, if its body is nothing but that."""
        statements = getter.body.code
        if len(statements) != 1 or statements[0].kind != "return_statement":
            return None
        returned = statements[0].first
        return self.find_node(returned, getter, depth + 1) if returned else None

    # --- What is given a node
    # ----------------------------------------------------------------------

    def find_uses(self, holder: Holder) -> Iterator[CppNode]:
        """Yield where the name of what holds a node is written, but in its declaration."""
        for use in self._unit.uses.get(holder.name, ()):
            self._budget.charge(1)
            function = self._unit.function_around(use)
            if not function or find_declaration(use):
                continue
            expression = use.parent if use.field == "field" else use
            if self.find_node(expression, function) == holder:
                yield use

    def holder_given(self, node: CppNode, function: CppFunction) -> Holder | None:
        """Return what holds the node afterwards that is an expression in a function.

        It is a parameter, a member or a variable; None where it is not known.
        """
        argument = node.parent if is_argument(node) else node
        while argument.parent.kind in _AROUND:
            argument = argument.parent
        given = argument.parent
        taker = argument.parent.parent
        if given.kind not in _LISTS:
            return self._holder_set(argument, function)
        if taker.kind == "call_expression" and short_name(called_name(taker)) in _SAME_FUNCTIONS:
            return self.holder_given(taker, function)
        return self._holder_of_argument(taker, given, argument, function)

    def _holder_set(self, value: CppNode, function: CppFunction) -> Holder | None:
        """Return the variable or member that is set to a node, or declared with it."""
        around = value.parent
        written = NO_NODE
        if around.kind == "assignment_expression" and value.field == "right":
            written = around.child("left")
        if around.kind == "init_declarator" and value.field == "value":
            written = name_in(around.child("declarator"))
        key = self.find_node(written, function) if written else None
        return key if isinstance(key, Holder) else None

    def _holder_of_argument(
        self, taker: CppNode, given: CppNode, argument: CppNode, function: CppFunction
    ) -> Holder | None:
        """Return the parameter, or the member, that gets an argument."""
        if taker.kind == "field_initializer":
            member = self._holder_of_member(function.class_name, taker.first.text)
            if member:
                return member
        arguments = given.code
        position = arguments.index(argument) if argument in arguments else -1
        parameters = []
        for candidate in self._called_by(taker, function):
            name = self._parameter_at(candidate, position, len(arguments))
            if name:
                parameters.append(Holder("local", candidate.node, name))
        return only_one(parameters)

    def _parameter_at(self, function: CppFunction, position: int, count: int) -> str:
        """Return the name of the parameter that gets a node; empty where none may."""
        parameters = function.parameters
        needed = [each for each in parameters if each.kind == "parameter_declaration"]
        if not 0 <= position < len(parameters) or not len(needed) <= count <= len(parameters):
            return ""
        kind, declarator = (parameters[position].child(role) for role in ("type", "declarator"))
        is_node = self.is_node_type(kind.text, function.inner_scopes)
        return name_in(declarator).text if is_node or function.is_template else ""

    def _called_by(self, taker: CppNode, function: CppFunction) -> Sequence[CppFunction]:
        """Return the functions and constructors that may get the arguments of something."""
        if taker.kind == "call_expression":
            return self._called_in(taker, function)
        owner = function.class_name
        if taker.kind == "field_initializer":
            return self._constructors(self._type_of_member(taker.first.text, owner), function)
        written = class_written(taker) or class_written(taker.parent)
        return self._constructors(written, function)

    def _called_in(self, call: CppNode, function: CppFunction) -> Sequence[CppFunction]:
        """Return the functions, methods and constructors that a call may mean."""
        name = called_name(call)
        owner = function.class_name
        scope, _, short = name.rpartition("::")
        types = template_arguments(call)
        if short in _MAKERS:
            return self._constructors(types[0] if types else scope, function)
        receiver = called_object(call)
        if receiver:
            return self._called_methods(receiver, short, function)
        methods = self._methods_named(short, owner) if owner and short == name else []
        free = [each for each in self._unit.functions_by_name.get(short, ()) if not each.class_name]
        return methods or (free + self._constructors(name, function))

    def _called_methods(
        self, receiver: CppNode, name: str, function: CppFunction
    ) -> Sequence[CppFunction]:
        """Return the methods of an object of a name, or what emplace() of a member constructs."""
        owner = function.class_name
        methods = self._methods_named(name, owner if receiver.kind == "this" else None)
        if name not in ("emplace", "emplace_back"):
            return methods
        kind = self._type_of_member(receiver.text, owner)
        inner = kind.partition("<")[2].rpartition(">")[0]
        return methods + self._constructors(inner, function)

    def _type_of_member(self, name: str, owner: str) -> str:
        """Return the type of a member of a class, as it is written, or the name of a base."""
        for each in self.with_bases(owner):
            variables = self._unit.variables.get(f"{each}::{name}", ())
            if variables:
                return variables[0].type
        return name

    def _constructors(self, written: str, function: CppFunction) -> list[CppFunction]:
        """Return the constructors of a class, which is written so in a function."""
        if not written:
            return []
        constructors = []
        for meaning in self._unit.meanings(plain(written), function.inner_scopes):
            short = short_name(meaning)
            for candidate in self._unit.functions_by_name.get(short, ()):
                if candidate.class_name == meaning:
                    constructors.append(candidate)
        return constructors
