"""What holds a node in C++ code: a variable, a parameter or a member that is given one.

A helper that is given a node declares and opens for it. So the facts of a holder are those of each
node that reaches it.
"""

import re
from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import Literal, NamedTuple

from grader.ros.cpp.declarations import (
    CppFunction,
    CppVariable,
    declared_in,
    find_declaration,
    is_argument,
    name_in,
    plain,
)
from grader.ros.cpp.objects import class_written, made_in
from grader.ros.cpp.syntax import CppNode
from grader.ros.cpp.unit import CppUnit, called_name, list_arguments, template_arguments
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
        self._unit, self._classes, self._budget = unit, node_classes, budget
        self._node_made = node_made
        self._declared: dict[tuple[CppNode, str], list[CppNode]] = {}
        self._types: dict[tuple[str, tuple[str, ...]], bool] = {}

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
        if inner and plain(outer).rpartition("::")[2] in ("shared_ptr", "weak_ptr", "unique_ptr"):
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
            parameters = each.node.parent.child("parameters") if each.node.parent else None
            for parameter in parameters.children if parameters is not None else ():
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
            owner = self._unit.find_owner(function)
            is_own = owner in self._classes and owner not in cpp_table().nodes
            return owner if is_own else None
        if node.kind in _NAMES:
            return self._node_named(node, function, depth)
        if node.kind == "field_expression":
            return self._node_of_member(node, function)
        if node.kind in _SAME and node.children:
            inner = node.child("argument") or node.children[0]
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
        return self._holder_of_member(self._unit.find_owner(function), name)

    def _declared_in(self, function: CppFunction, name: str) -> list[CppNode]:
        """Return the names in the declarations of a local variable or parameter of a function."""
        key = (function.node, name)
        if key not in self._declared:
            uses = self._uses_in(function, name)
            self._declared[key] = [use for use in uses if find_declaration(use) is not None]
        return self._declared[key]

    def _uses_in(self, function: CppFunction, name: str) -> list[CppNode]:
        inside, uses = function.node, self._unit.uses.get(name, ())
        self._budget.charge(1 + len(uses))
        in_file = [use for use in uses if use.file is inside.file]
        return [use for use in in_file if inside.start <= use.start < inside.end]

    def _is_assigned(self, function: CppFunction, name: str) -> bool:
        """Return whether a local variable gets another value than that of its declaration."""
        for use in self._uses_in(function, name):
            around = use.parent
            if (
                around is not None
                and around.kind == "assignment_expression"
                and use.field == "left"
            ):
                return True
        return False

    def _node_of_local(self, name: CppNode, function: CppFunction, depth: int) -> NodeKey | None:
        """Return the node of a local variable: the one that it is made with, or what holds it."""
        declaration = find_declaration(name)
        assert declaration is not None
        kind, is_parameter = declaration.child("type"), declaration.kind in _PARAMETERS
        is_node = kind is not None and self.is_node_type(
            kind.text, self._unit.list_scopes(function)
        )
        if is_parameter:
            is_given = function.is_template
        else:
            made = self._node_made(made_in(name.parent)) if name.parent is not None else None
            if made is not None and not self._is_assigned(function, name.text):
                return made
            value = dict(declared_in(declaration)).get(name)
            is_given = value is not None and self.find_node(value, function, depth + 1) is not None
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
        pending, seen = [name], set[str]()
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
        owner, field = node.child("argument"), node.child("field")
        if owner is None or field is None:
            return None
        if owner.kind == "this":
            return self._holder_of_member(self._unit.find_owner(function), field.text)
        classes = self._members.get(field.text, set())
        return Holder("member", next(iter(classes)), field.text) if len(classes) == 1 else None

    def _node_of_call(self, call: CppNode, function: CppFunction, depth: int) -> NodeKey | None:
        """Return the node that a call returns: what it is given, or a member of its object."""
        name, called = _short_name(call), call.child("function")
        is_method = called is not None and called.kind == "field_expression"
        owner = called.child("argument") if called is not None and is_method else None
        same = owner if name in _SAME_METHODS else None
        if name in _SAME_FUNCTIONS:
            same = next(iter(list_arguments(call)), None)
        if same is not None:
            return self.find_node(same, function, depth + 1)
        of_class = self._unit.find_owner(function)
        if name in _SAME_METHODS:
            return of_class if of_class in self._classes else None
        is_own = owner is None or owner.kind == "this"
        getters = self._methods_named(name, of_class if is_own else None)
        if len(getters) == 1:
            return self._node_returned(getters[0], depth)
        is_inherited = is_own and not getters and self.has_other_base(of_class)
        return Holder("own", of_class, "") if is_inherited and name == _GETTER else None

    def _methods_named(self, name: str, owner: str | None) -> list[CppFunction]:
        """Return the methods of a class and its bases by their name, or those of any class."""
        owners = None if owner is None else {*self.with_bases(owner)}
        methods = []
        for function in self._functions.get(name, ()):
            of_class = self._unit.find_owner(function)
            if of_class and (owners is None or of_class in owners):
                methods.append(function)
        return methods

    @cached_property
    def _functions(self) -> dict[str, list[CppFunction]]:
        functions: dict[str, list[CppFunction]] = {}
        for function in self._unit.functions:
            functions.setdefault(function.name, []).append(function)
        return functions

    def _node_returned(self, getter: CppFunction, depth: int) -> NodeKey | None:
        """Return the node that a method returns, if its body is nothing but that."""
        body = getter.body
        statements = [child for child in body.children if child.kind != "comment"] if body else []
        if len(statements) != 1 or statements[0].kind != "return_statement":
            return None
        returned = statements[0].children
        return self.find_node(returned[0], getter, depth + 1) if returned else None

    # --- What is given a node
    # ----------------------------------------------------------------------

    def find_uses(self, holder: Holder) -> Iterator[CppNode]:
        """Yield where the name of what holds a node is written, but in its declaration."""
        for use in self._unit.uses.get(holder.name, ()):
            self._budget.charge(1)
            function = self._unit.function_around(use)
            if function is None or find_declaration(use) is not None:
                continue
            expression = use.parent if use.field == "field" and use.parent is not None else use
            if self.find_node(expression, function) == holder:
                yield use

    def holder_given(self, node: CppNode, function: CppFunction) -> Holder | None:
        """Return what holds the node afterwards that is an expression in a function.

        It is a parameter, a member or a variable; None where it is not known.
        """
        argument = node
        if is_argument(node) and node.parent is not None:
            argument = node.parent
        while argument.parent is not None and argument.parent.kind in _AROUND:
            argument = argument.parent
        given = argument.parent
        if given is None or given.kind not in _LISTS:
            return self._holder_set(argument, function)
        taker = given.parent
        if taker is None:
            return None
        if taker.kind == "call_expression" and _short_name(taker) in _SAME_FUNCTIONS:
            return self.holder_given(taker, function)
        return self._holder_of_argument(taker, given, argument, function)

    def _holder_set(self, value: CppNode, function: CppFunction) -> Holder | None:
        """Return the variable or member that is set to a node, or declared with it."""
        around, written = value.parent, None
        if around is not None and around.kind == "assignment_expression" and value.field == "right":
            written = around.child("left")
        if around is not None and around.kind == "init_declarator" and value.field == "value":
            declarator = around.child("declarator")
            written = name_in(declarator) if declarator is not None else None
        key = self.find_node(written, function) if written is not None else None
        return key if isinstance(key, Holder) else None

    def _holder_of_argument(
        self, taker: CppNode, given: CppNode, argument: CppNode, function: CppFunction
    ) -> Holder | None:
        """Return the parameter, or the member, that gets an argument."""
        if taker.kind == "field_initializer":
            member = self._holder_of_member(self._unit.find_owner(function), taker.children[0].text)
            if member is not None:
                return member
        arguments = [child for child in given.children if child.kind != "comment"]
        position = arguments.index(argument) if argument in arguments else -1
        parameters = []
        for candidate in self._called_by(taker, function):
            name = self._parameter_at(candidate, position, len(arguments))
            if name is not None:
                parameters.append(Holder("local", candidate.node, name))
        return parameters[0] if len(parameters) == 1 else None

    def _parameter_at(self, function: CppFunction, position: int, count: int) -> str | None:
        """Return the name of the parameter that gets a node; None where none may."""
        parameters = function.parameters
        needed = [each for each in parameters if each.kind == "parameter_declaration"]
        if not 0 <= position < len(parameters) or not len(needed) <= count <= len(parameters):
            return None
        kind, declarator = (parameters[position].child(role) for role in ("type", "declarator"))
        name = name_in(declarator) if declarator is not None else None
        scopes = self._unit.list_scopes(function)
        is_node = kind is not None and self.is_node_type(kind.text, scopes)
        return name.text if name is not None and (is_node or function.is_template) else None

    def _called_by(self, taker: CppNode, function: CppFunction) -> Sequence[CppFunction]:
        """Return the functions and constructors that may get the arguments of something."""
        if taker.kind == "call_expression":
            return self._called_in(taker, function)
        owner = self._unit.find_owner(function)
        if taker.kind == "field_initializer":
            return self._constructors(self._type_of_member(taker.children[0].text, owner), function)
        written = class_written(taker)
        if not written and taker.parent is not None:
            written = class_written(taker.parent)
        return self._constructors(written, function)

    def _called_in(self, call: CppNode, function: CppFunction) -> Sequence[CppFunction]:
        """Return the functions, methods and constructors that a call may mean."""
        name, owner, called = (
            called_name(call),
            self._unit.find_owner(function),
            call.child("function"),
        )
        scope, _, short = name.rpartition("::")
        types = template_arguments(call)
        if short in _MAKERS:
            return self._constructors(types[0] if types else scope, function)
        if called is not None and called.kind == "field_expression":
            return self._called_methods(called, short, function)
        methods = self._methods_named(short, owner) if owner and short == name else []
        free = [each for each in self._functions.get(short, ()) if not self._unit.find_owner(each)]
        return methods or [*free, *self._constructors(name, function)]

    def _called_methods(
        self, called: CppNode, name: str, function: CppFunction
    ) -> Sequence[CppFunction]:
        """Return the methods of an object of a name, or what emplace() of a member constructs."""
        owner, receiver = self._unit.find_owner(function), called.child("argument")
        is_own = receiver is not None and receiver.kind == "this"
        methods = self._methods_named(name, owner if is_own else None)
        member = receiver.text if receiver is not None else ""
        return [*methods, *self._constructors_of_pointer(member, name, owner, function)]

    def _constructors_of_pointer(
        self, member: str, method: str, owner: str, function: CppFunction
    ) -> Sequence[CppFunction]:
        """Return the constructors that emplace() or reset() of a member calls."""
        if method not in ("emplace", "emplace_back"):
            return ()
        kind = self._type_of_member(member, owner)
        return self._constructors(kind.partition("<")[2].rpartition(">")[0], function)

    def _type_of_member(self, name: str, owner: str) -> str:
        """Return the type of a member of a class, as it is written, or the name of a base."""
        for each in self.with_bases(owner):
            variables: Sequence[CppVariable] = self._unit.variables.get(f"{each}::{name}", ())
            if variables:
                return variables[0].type
        return name

    def _constructors(self, written: str, function: CppFunction) -> list[CppFunction]:
        """Return the constructors of a class, which is written so in a function."""
        if not written:
            return []
        constructors = []
        for meaning in self._unit.meanings(plain(written), self._unit.list_scopes(function)):
            short = meaning.rpartition("::")[2]
            for candidate in self._functions.get(short, ()):
                if self._unit.find_owner(candidate) == meaning:
                    constructors.append(candidate)
        return constructors


def _short_name(call: CppNode) -> str:
    return called_name(call).rpartition("::")[2]
