"""The values of parameters in C++ code, by the places where a function or constructor is called."""

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property

from grader.base.grouping import are_texts
from grader.ros.cpp.cpp_evaluation import CppEvaluation
from grader.ros.cpp.cpp_values import CppCall, CppName, CppSum, CppValue
from grader.ros.cpp.declarations import CppFunction, name_in, plain, short_name
from grader.ros.cpp.objects import class_written
from grader.ros.cpp.syntax import CppNode, CppNodes, CppNodesByName
from grader.ros.cpp.unit import CppUnit, called_name, list_arguments
from grader.ros.python.budget import Budget

_MAX_SITES = 20  # of one function
_MAX_DEPTH = 3  # of functions that give others their own parameters
_LISTS = ("argument_list", "initializer_list", "parameter_list")


class CallSites:
    """Where functions and constructors are called in files that are compiled together."""

    def __init__(self, unit: CppUnit, evaluation: CppEvaluation, budget: Budget) -> None:
        self._unit = unit
        self._evaluation = evaluation
        self._budget = budget

    def alternatives(self, value: CppValue, depth: int = 0) -> Sequence[CppValue]:
        """Return a value for each place that calls the function whose parameters it has.

        It is the value itself, where it has none, or where its function may be called elsewhere.
        """
        functions = {self._find_function(name) for name in _names_in(value)} - {None}
        if len(functions) != 1 or depth > _MAX_DEPTH:
            return [value]
        [function] = functions
        assert function
        sites = self._find_sites(function)
        if not 0 < len(sites) <= _MAX_SITES:
            return [value]
        values: list[CppValue] = []
        for site in sites:
            given = self._given_at(function, site)
            if given is None:
                return [value]
            values += self.alternatives(_replaced(value, given), depth + 1)
        return values

    def is_of_constructor(self, value: CppValue, classes: Mapping[str, object]) -> bool:
        """Return whether a value has a parameter of the constructor of one of some classes."""
        for name in _names_in(value):
            function = self._find_function(name)
            owner = function.class_name if function else ""
            is_constructor = function is not None and short_name(owner) == function.name
            if is_constructor and owner in classes:
                return True
        return False

    def _find_function(self, name: CppName) -> CppFunction | None:
        """Return the function that has a parameter; None for another name."""
        function = self._unit.function_around(name.node)
        if not function:
            return None
        is_parameter = any(node is name.node for node in self._parameters(function))
        return function if is_parameter else None

    def _parameters(self, function: CppFunction) -> CppNodes:
        """Return the names of the parameters of a function."""
        return [name_in(parameter.child("declarator")) for parameter in function.parameters]

    def _find_sites(self, function: CppFunction) -> CppNodes:
        """Return where a function is called, if no other one has its name and its parameters."""
        count = len(function.parameters)
        same = self._unit.functions_by_name[function.name]
        self._budget.charge(1 + len(same))
        if any(each is not function and len(each.parameters) == count for each in same):
            return []
        sites = self._sites.get(function.name, ())
        needed = len([each for each in function.parameters if not each.child("default_value")])
        return [site for site in sites if needed <= len(_arguments(site)) <= count]

    def _given_at(self, function: CppFunction, site: CppNode) -> "dict[CppNode, CppValue] | None":
        """Return the values of the parameters of a function at a place that calls it."""
        arguments = _arguments(site)
        given = {}
        for position, name in enumerate(self._parameters(function)):
            if not name:
                return None
            default = function.parameters[position].child("default_value")
            argument = arguments[position] if position < len(arguments) else default
            given[name] = self._evaluation.evaluate_node(argument)
        return given

    @cached_property
    def _sites(self) -> Mapping[str, CppNodes]:
        """The calls by the last names of what they call: a function, or the class of an object."""
        sites: CppNodesByName = {}
        for file in self._unit.files:
            self._budget.charge(1 + len(file.calls))
            for node in file.calls:
                name = class_written(node)
                if not name and node.kind == "call_expression":
                    name = called_name(node)
                if name and node.kind != "init_declarator":
                    sites.setdefault(short_name(plain(name)), []).append(node)
            for node in file.of_kind("field_initializer"):
                name = self._class_initialized(node)
                sites.setdefault(short_name(plain(name)), []).append(node)
        return sites

    def _class_initialized(self, initializer: CppNode) -> str:
        """Return the base class, or the type of the member, that an initializer makes."""
        name = initializer.first.text
        scopes = self._unit.scopes_at(initializer)
        variables = self._unit.variables_named(name, scopes)
        return variables[0].type if variables else name


def _arguments(site: CppNode) -> CppNodes:
    if site.kind != "declaration":
        return list_arguments(site)
    for node in site.walk():
        if node.kind in _LISTS:
            return node.code
    return []


def _names_in(value: CppValue) -> Iterator[CppName]:
    """Yield the names without a value in what is evaluated."""
    match value:
        case CppName():
            yield value
        case CppCall():
            yield from _names_in(value.owner)
            for argument in value.args:
                yield from _names_in(argument)
        case CppSum():
            for part in value.parts:
                yield from _names_in(part)


def _replaced(value: CppValue, given: Mapping[CppNode, CppValue]) -> CppValue:
    """Return a value with others in place of names."""
    match value:
        case CppName():
            return given.get(value.node, value)
        case CppCall():
            arguments = [_replaced(argument, given) for argument in value.args]
            owner = _replaced(value.owner, given)
            return CppCall(value.name, arguments, value.node, value.types, owner)
        case CppSum():
            parts = [_replaced(part, given) for part in value.parts]
            is_text = are_texts(parts)
            return "".join(parts) if is_text else CppSum(parts)
    return value
