"""The values of expressions in C++: of literals, and of what is set once and then only read."""

from collections.abc import Callable, Mapping, Sequence
from typing import Literal, NamedTuple

from grader.base.grouping import are_texts
from grader.ros.cpp.cpp_values import CppCall, CppName, CppSum, CppValue, as_scalar, not_known
from grader.ros.cpp.declarations import (
    CppFunction,
    CppVariable,
    declared_in,
    find_declaration,
    is_constant,
    plain_name,
    short_name,
)
from grader.ros.cpp.literals import (
    NUMBERS,
    SECONDS,
    TEXTS,
    number_of_literal,
    text_of_literal,
)
from grader.ros.cpp.syntax import NO_NODE, CppNode, CppNodes, parse_cpp
from grader.ros.cpp.unit import (
    CppUnit,
    called_name,
    called_object,
    is_conditional,
    list_arguments,
    template_arguments,
)
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.values import Unknown

_MAX_DEPTH = 25
_MAX_MACRO = 300  # characters
_MAX_TEXT, _MAX_PARTS = 2_000, 200  # characters of a joined text, and its parts
_OF_USE = 5  # parts of a place where a name is written
# Functions that only read what they are given.
_READING = frozenset(
    {
        *("make_shared", "make_unique", "string", "vector", "move", "forward", "to_string"),
        *("QoS", "KeepLast", "seconds", "milliseconds", "microseconds", "duration", "from_seconds"),
        *("static_cast", "min", "max", "abs", "c_str", "find", "compare", "push_back"),
    }
)
_READING_METHODS = frozenset(
    {"c_str", "data", "empty", "size", "length", "find", "compare", "substr", "str", "count"}
)
_READING_PARENTS = frozenset(
    {
        *("binary_expression", "return_statement", "conditional_expression", "initializer_list"),
        *("case_statement", "condition_clause", "subscript_argument_list", "unary_expression"),
        *("parenthesized_expression", "expression_statement", "static_assert_declaration"),
    }
)
_TEXT_TYPES = ("std::string", "std::string_view", "string", "string_view", "std::move")
_PLAIN_TYPES = ("string", "char", "int", "double", "float", "bool", "size_t", "auto")
_SAME_TEXT = ("c_str", "data", "str")
_CALLS = ("call_expression", "compound_literal_expression", "new_expression")


class LibraryCalls(NamedTuple):
    """What is known of the functions of libraries."""

    reading: frozenset[str]  # that only read what they are given
    setting: Mapping[str, int]  # that set one of their arguments, by its position


class _Write(NamedTuple):
    """Where a variable gets a value."""

    kind: Literal["declared", "set"]
    node: CppNode
    value: CppValue


_Writes = list[_Write] | Unknown


class _LocalVariable:
    """A local variable of a function: where it is declared and written, and what changes it."""

    def __init__(self, declared: CppNodes, uses: CppNodes) -> None:
        self.declared = declared
        self.uses = uses
        self.effects: list[tuple[CppNode, _Writes]] | None = None


class CppEvaluation:
    """Evaluates expressions of files that are compiled together. All work is charged."""

    def __init__(self, unit: CppUnit, interface: LibraryCalls, budget: Budget) -> None:
        self.unit = unit
        self._interface = interface
        self._budget = budget
        self._active: set[CppNode] = set()
        self._macros: dict[str, CppValue] = {}
        self._declared: dict[CppNode, CppValue] = {}
        self._members: dict[CppNode, _Writes] = {}
        self._locals: dict[tuple[str, CppNode], _LocalVariable | None] = {}
        self._depth = 0

    def evaluate_node(self, node: CppNode) -> CppValue:
        """Return the value of an expression; None without one. It never raises."""
        if not node:
            return None
        if self._depth >= _MAX_DEPTH or node in self._active:
            return not_known("it is nested too deeply")
        self._depth += 1
        self._active.add(node)
        try:
            self._budget.charge(1, node.end - node.start)
            return self._value(node)
        except OutOfBudget:
            return not_known("the files are too long to evaluate")
        finally:
            self._depth -= 1
            self._active.discard(node)

    def _value(self, node: CppNode) -> CppValue:
        if node.kind in _EVALUATED:
            return _EVALUATED[node.kind](self, node)
        return not_known(f"a {node.kind.replace('_', ' ')} is not evaluated")

    def text(self, node: CppNode) -> CppValue:
        """Return the text of a literal."""
        text = text_of_literal(node)
        return text if text is not None else not_known("the text is broken")

    def joined_texts(self, node: CppNode) -> CppValue:
        """Return the text of literals that stand side by side."""
        return _joined([self.evaluate_node(child) for child in node.children])

    def number(self, node: CppNode) -> CppValue:
        """Return the value of a number or a boolean."""
        number = number_of_literal(node.text)
        return number if number is not None else not_known("the number is not evaluated")

    def this(self, node: CppNode) -> CppValue:
        """Return the object itself."""
        return CppName("this", node)

    def inner(self, node: CppNode) -> CppValue:
        """Return the value of what is in parentheses, or is pointed to."""
        return self.evaluate_node(node.child("argument") or node.first)

    def items(self, node: CppNode) -> CppValue:
        """Return the list of what is in braces."""
        return [self.evaluate_node(child) for child in node.children]

    def with_suffix(self, node: CppNode) -> CppValue:
        """Return the value of a literal with an ending of its own, such as a duration."""
        suffix = node.of_kind("literal_suffix")
        value = self.evaluate_node(node.first)
        ending = suffix[0].text if suffix else ""
        if isinstance(value, str) and ending in ("s", "sv"):
            return value
        if isinstance(value, int | float) and ending in SECONDS:
            return CppCall(f"std::chrono::{ending}", (value,), node)
        return not_known("the literal is not evaluated")

    def operator(self, node: CppNode) -> CppValue:
        """Return the value of a sign or of texts that are joined; others are not evaluated."""
        sign = node.child("operator").text
        if node.kind == "unary_expression":
            value = self.evaluate_node(node.child("argument"))
            is_number = isinstance(value, int | float) and not isinstance(value, bool)
            return -value if sign == "-" and is_number else not_known("it is computed")
        left = self.evaluate_node(node.child("left"))
        right = self.evaluate_node(node.child("right"))
        if sign == "+" and (_is_textual(left) or _is_textual(right)):
            return _joined([left, right])
        return not_known("it is computed")

    def call(self, node: CppNode) -> CppValue:
        """Return a call of a function or method that is recorded."""
        arguments = [self.evaluate_node(argument) for argument in list_arguments(node)]
        owner = self.evaluate_node(called_object(node))
        name = called_name(node)
        if _is_textual(owner) and name in _SAME_TEXT:
            return owner
        is_text = _is_textual(owner) or isinstance(owner, CppCall)
        if is_text and name == "append" and len(arguments) == 1 and _is_textual(arguments[0]):
            return _joined([owner, arguments[0]])
        return _constructed(CppCall(name, arguments, node, template_arguments(node), owner))

    def made(self, node: CppNode) -> CppValue:
        """Return what makes an object, `new Type(...)` or `Type{...}`, as a call of its type."""
        arguments = [self.evaluate_node(argument) for argument in list_arguments(node)]
        kind = node.child("type")
        return _constructed(CppCall(plain_name(kind), arguments, node, template_arguments(kind)))

    # --- Names
    # ----------------------------------------------------------------------

    def name(self, node: CppNode) -> CppValue:
        """Return the value of a local variable, a member, a constant or a macro."""
        name = node.text
        function = self.unit.function_around(node)
        if function:
            local = self._local_variable(name, function)
            if local:
                return self._value_of_local(node, local)
        if name in self.unit.macros and not self._variables_at(node, name):
            return self._value_of_macro(name)
        return self._value_of_shared(node, name, name)

    def qualified(self, node: CppNode) -> CppValue:
        """Return the value of a constant by a name with its scopes."""
        name = plain_name(node)
        return self._value_of_shared(node, name, name)

    def member(self, node: CppNode) -> CppValue:
        """Return the value of a member of the object itself: `this->name`."""
        field = node.child("field")
        if node.child("argument").kind != "this":
            return CppName(node.text, node)
        return self._value_of_shared(node, field.text, node.text)

    def _value_of_shared(self, node: CppNode, name: str, written: str) -> CppValue:
        """Return the value of the variable of a namespace or class that a name means at a place.

        Returns the name as it is written, where none has it.
        """
        variables = self._variables_at(node, name)
        return self._value_of_variable(variables, node) if variables else CppName(written, node)

    def _variables_at(self, node: CppNode, name: str) -> Sequence[CppVariable]:
        """Return the variables of namespaces and classes that a name may mean at a place."""
        scopes = self.unit.scopes_at(node)
        return self.unit.variables_named(name, scopes)

    def _local_variable(self, name: str, function: CppFunction) -> "_LocalVariable | None":
        """Return the local variable or parameter of a function that has a name; None without."""
        key = (name, function.node)
        if key not in self._locals:
            node = function.node
            uses = [use for use in self.unit.uses.get(name, ()) if use.file is node.file]
            inside = [use for use in uses if node.start <= use.start < node.end]
            self._budget.charge(1 + len(uses) + _OF_USE * len(inside))
            declared = [use for use in inside if find_declaration(use)]
            self._locals[key] = _LocalVariable(declared, inside) if declared else None
        return self._locals[key]

    def find_uses(self, name: CppNode) -> CppNodes | None:
        """Return where the variable is written that a name means at a place.

        Returns None where that is not known.
        """
        function = self.unit.function_around(name)
        local = self._local_variable(name.text, function) if function else None
        if local:
            self._budget.charge(1 + len(local.uses))
            return local.uses if len(local.declared) == 1 else None
        variables = self._variables_at(name, name.text)
        if len(variables) != 1:
            return None
        uses = self.unit.uses.get(name.text, ())
        self._budget.charge(_OF_USE * len(uses))
        return [use for use in uses if not self._is_of_another(use, variables[0])]

    def _value_of_local(self, node: CppNode, local: "_LocalVariable") -> CppValue:
        if len(local.declared) > 1:
            return not_known("the name is declared twice")
        name = local.declared[0]
        declaration = find_declaration(name)
        if declaration.kind in ("parameter_declaration", "optional_parameter_declaration"):
            return CppName(node.text, name)
        value = dict(declared_in(declaration)).get(name, NO_NODE)
        if is_constant(declaration):
            return self._value_once(name, declaration, value)
        writes = []
        if value:
            writes.append(_Write("declared", name, self._value_once(name, declaration, value)))
        effects = self._effects_on(local, name, declaration)
        self._budget.charge(1 + len(effects))
        for use, effect in effects:
            if use.start < node.start:
                if isinstance(effect, Unknown):
                    return effect
                writes += effect
        return _as_declared(_last(writes), declaration)

    def _effects_on(
        self, local: "_LocalVariable", name: CppNode, declaration: CppNode
    ) -> "list[tuple[CppNode, list[_Write] | Unknown]]":
        """Return what changes a local variable, and where; it is computed once."""
        if local.effects is None:
            local.effects = [(name, not_known("it depends on itself"))]
            effects = []
            for use in local.uses:
                effect = self._find_effect(use, declaration) if use is not name else []
                if effect != []:
                    effects.append((use, effect))
            local.effects = effects
        return local.effects

    def _value_once(self, name: CppNode, declaration: CppNode, value: CppNode) -> CppValue:
        """Return the value that a variable is declared with, which is evaluated once."""
        if name not in self._declared:
            self._declared[name] = not_known("it depends on itself")
            evaluated = self._value_declared(declaration, value)
            self._declared[name] = _as_declared(evaluated, declaration)
        return self._declared[name]

    def _value_declared(self, declaration: CppNode, value: CppNode) -> CppValue:
        """Return the value that a declaration gives its variable, maybe in parentheses."""
        if not value:
            return not_known("it has no value")
        kind = declaration.child("type")
        name = plain_name(kind)
        if value.kind in ("argument_list", "initializer_list", "parameter_list"):
            arguments = [self.evaluate_node(argument) for argument in value.children]
            if value.kind == "initializer_list" and short_name(name) in _PLAIN_TYPES:
                return arguments[0] if len(arguments) == 1 else not_known("it has no value")
            return _constructed(CppCall(name, arguments, value, template_arguments(kind)))
        return self.evaluate_node(value)

    def _value_of_variable(self, variables: Sequence[CppVariable], node: CppNode) -> CppValue:
        """Return the value of a variable of a namespace or class at a place where it is read."""
        if len(variables) > 1 or variables[0].is_conditional:
            return not_known("the name is declared twice")
        [variable] = variables
        declaration = variable.declarator
        for around in variable.declarator.ancestors():
            if around.kind in ("declaration", "field_declaration"):
                declaration = around
                break
        if variable.is_constant:
            return self._value_once(variable.declarator, declaration, variable.value)
        if variable.declarator not in self._members:
            self._members[variable.declarator] = not_known("it depends on itself")
            self._members[variable.declarator] = self._list_writes(variable, declaration)
        writes = self._members[variable.declarator]
        if isinstance(writes, Unknown):
            return writes
        return _as_declared(self._value_written(writes, node), declaration)

    def _list_writes(self, variable: CppVariable, declaration: CppNode) -> _Writes:
        """Return the values that a variable of a namespace or class gets."""
        writes = []
        if variable.value:
            value = self._value_once(variable.declarator, declaration, variable.value)
            writes.append(_Write("declared", variable.declarator, value))
        for use in self.unit.uses.get(variable.declarator.text, ()):
            self._budget.charge(_OF_USE)
            if use is variable.declarator or self._is_of_another(use, variable):
                continue
            more = self._find_effect(use, NO_NODE)
            if isinstance(more, Unknown):
                return more
            writes += more
        return writes

    def _is_of_another(self, use: CppNode, variable: CppVariable) -> bool:
        """Return whether a name certainly is another variable's: of another class, or a local."""
        if use.parent.kind == "field_declaration":
            return True
        function = self.unit.function_around(use)
        if not function:
            return False
        is_local = self._local_variable(use.text, function) is not None
        if use.kind == "identifier" and is_local:
            return True
        is_of_this = use.kind == "identifier" or is_member_of_this(use)
        scopes = function.inner_scopes
        variables = self.unit.variables_named(use.text, scopes)
        return is_of_this and bool(variables) and variables[0] is not variable

    def _value_written(self, writes: Sequence[_Write], node: CppNode) -> CppValue:
        """Return the value of a member at a place, if it is set once, before that."""
        settings = [write for write in writes if write.kind == "set"]
        if len(settings) > 1:
            return not_known("it is set twice")
        if not settings:
            return _last(writes)
        [setting] = settings
        where = self.unit.function_around(setting.node)
        here = self.unit.function_around(node)
        if not where or (where is here and node.start < setting.node.start):
            return not_known("it is set later")
        is_constructor = where.name == short_name(where.owner)
        if len(writes) > 1 and not is_constructor:
            return not_known("it is set twice")
        return setting.value

    # --- What is done with a variable
    # ----------------------------------------------------------------------

    def _find_effect(self, use: CppNode, declaration: CppNode) -> _Writes:
        """Return the values that a variable gets where its name is written.

        Returns Unknown where that is not known. `declaration` is that of a local one, whose methods
        may change it.
        """
        node = use.parent if is_member_of_this(use) else use
        parent = node.parent
        match parent.kind, node.field:
            case (("argument_list" | "template_argument_list"), _):
                return self._effect_of_argument(node, parent)
            case "field_initializer", _:
                values = [self.evaluate_node(argument) for argument in list_arguments(parent)]
                return [_Write("set", node, values[0] if values else not_known("it has no value"))]
            case "assignment_expression", "left":
                return self._effect_of_assignment(node, parent)
            case "field_expression", "argument":
                return self._effect_of_method(node, parent, declaration)
        return [] if _is_read(node, parent) else not_known("it may change")

    def _effect_of_argument(self, node: CppNode, given: CppNode) -> _Writes:
        call = given.parent
        if call.kind not in _CALLS:
            is_read = call.kind in ("field_initializer", "init_declarator")
            return [] if is_read else not_known("it may change")
        name = short_name(called_name(call))
        position = self._interface.setting.get(name)
        arguments = list_arguments(call)
        if position is not None and node in arguments[position : position + 1]:
            if not _is_statement(call):
                return not_known("it may be set")
            return [_Write("set", node, self._as_result(call, name))]
        is_logged = name.isupper()
        if is_logged or name in _READING or name in self._interface.reading or position is not None:
            return []
        return not_known(f"{name} may change it")

    def _as_result(self, call: CppNode, name: str) -> CppCall:
        """Return the value that a function sets its argument to, as if it returned it."""
        arguments = list_arguments(call)
        return CppCall(name, [self.evaluate_node(arguments[0])], call, template_arguments(call))

    def _effect_of_assignment(self, node: CppNode, parent: CppNode) -> _Writes:
        if parent.child("operator").text != "=" or not _is_statement(parent):
            return not_known("it is computed")
        return [_Write("set", node, self.evaluate_node(parent.child("right")))]

    def _effect_of_method(self, node: CppNode, parent: CppNode, declaration: CppNode) -> _Writes:
        """Return the effect of a method on a variable.

        A method that is called in a statement after the declaration is part of its value.
        """
        call = parent.parent
        name = parent.child("field").text
        is_called = call.kind == "call_expression"
        if is_called and name in _READING_METHODS:
            return []
        is_local = declaration and call.parent.parent is declaration.parent
        if not is_called or not is_local or not _is_statement(call):
            return not_known("a method may change it")
        arguments = [self.evaluate_node(argument) for argument in list_arguments(call)]
        return [_Write("set", node, CppCall(name, arguments, call, (), _BEFORE))]

    def _value_of_macro(self, name: str) -> CppValue:
        """Return the value of a macro that stands for a literal."""
        if name not in self._macros:
            self._macros[name] = not_known("the macro stands for itself")
            macros = self.unit.macros[name]
            texts = {macro.text for macro in macros}
            is_known = len(texts) == 1 and not any(macro.is_conditional for macro in macros)
            text = texts.pop()
            if is_known and len(text) <= _MAX_MACRO:
                self._macros[name] = self._value_of_text(text)
            else:
                self._macros[name] = not_known("the macro is defined twice")
        return self._macros[name]

    def _value_of_text(self, text: str) -> CppValue:
        syntax = parse_cpp(f"auto value = {text};".encode(), "", self._budget)
        for node in syntax.nodes:
            if node.kind == "init_declarator":
                value = node.child("value")
                kinds = (*TEXTS, *NUMBERS, "concatenated_string")
                is_read = not syntax.error and not syntax.broken
                if value.kind in kinds and is_read:
                    return self.evaluate_node(value)
        return not_known("the macro is not evaluated")


_EVALUATED: Mapping[str, Callable[[CppEvaluation, CppNode], CppValue]] = {
    **dict.fromkeys(TEXTS, CppEvaluation.text),
    **dict.fromkeys(NUMBERS, CppEvaluation.number),
    "call_expression": CppEvaluation.call,
    "compound_literal_expression": CppEvaluation.made,
    "new_expression": CppEvaluation.made,
    "concatenated_string": CppEvaluation.joined_texts,
    "user_defined_literal": CppEvaluation.with_suffix,
    "identifier": CppEvaluation.name,
    "type_identifier": CppEvaluation.name,
    "parameter_declaration": CppEvaluation.inner,
    "field_identifier": CppEvaluation.name,
    "qualified_identifier": CppEvaluation.qualified,
    "this": CppEvaluation.this,
    "parenthesized_expression": CppEvaluation.inner,
    "pointer_expression": CppEvaluation.inner,
    "unary_expression": CppEvaluation.operator,
    "binary_expression": CppEvaluation.operator,
    "field_expression": CppEvaluation.member,
    "initializer_list": CppEvaluation.items,
}


# Stands for the value that an object has before one of its methods is called.
_BEFORE = not_known("the value before")


def _last(writes: Sequence[_Write]) -> CppValue:
    """Return the value after all writes: methods that are called are methods of the one before."""
    value: CppValue = None
    is_set = False
    for write in writes:
        if isinstance(write.value, CppCall) and write.value.owner is _BEFORE:
            call = write.value
            value = CppCall(call.name, call.args, call.node, call.types, value)
        elif is_set or (write.kind == "set" and not _is_unconditional(write.node)):
            return not_known("it is set twice")
        else:
            value = write.value
            is_set = write.kind == "set"
    return value if writes else not_known("it has no value")


def _is_unconditional(node: CppNode) -> bool:
    """Return whether a statement is one of the body of its function itself."""
    for around in node.ancestors():
        if around.kind == "compound_statement":
            return around.parent.kind in ("function_definition", "lambda_expression")
    return True


def _is_statement(node: CppNode) -> bool:
    """Return whether an expression is an always executed statement of its function's body."""
    statement = node.parent
    above = statement.parent.parent
    if statement.kind != "expression_statement" or above.kind != "function_definition":
        return False
    return not is_conditional(node, above)


def is_member_of_this(use: CppNode) -> bool:
    """Return whether a name is that of a member in `this->name`."""
    parent = use.parent
    is_member = parent.kind == "field_expression" and use.field == "field"
    return is_member and parent.child("argument").kind == "this"


def _is_read(node: CppNode, parent: CppNode) -> bool:
    """Return whether an expression is only read where it is written."""
    if parent.kind == "init_declarator":
        return node.field == "value" and not parent.of_kind("reference_declarator")
    if parent.kind == "lambda_capture_specifier":
        return "&" not in parent.text
    is_source = parent.kind == "assignment_expression" and node.field == "right"
    return is_source or parent.kind in _READING_PARENTS


def _as_declared(value: CppValue, declaration: CppNode) -> CppValue:
    """Return the number in a variable as the type of its declaration has it."""
    return as_scalar(value, plain_name(declaration.child("type")))


def _is_textual(value: CppValue) -> bool:
    return isinstance(value, str | CppSum)


def _joined(values: Sequence[CppValue]) -> CppValue:
    """Return texts that are joined."""
    parts: list[CppValue] = []
    for value in values:
        parts += value.parts if isinstance(value, CppSum) else [value]
    size = sum(len(part) for part in parts if isinstance(part, str))
    if size > _MAX_TEXT or len(parts) > _MAX_PARTS:
        return not_known("the text is too long")
    if are_texts(parts):
        return "".join(parts)
    return CppSum(parts)


def _constructed(call: CppCall) -> CppValue:
    """Return a call; the text itself where one is only copied."""
    if call.name in _TEXT_TYPES and len(call.args) == 1 and call.owner is None:
        value = call.args[0]
        return value if _is_textual(value) or isinstance(value, CppCall) else call
    return call
