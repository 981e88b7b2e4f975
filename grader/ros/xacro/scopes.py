"""The names that xacro binds: properties, and macros, in nested scopes.

Properties are evaluated when they are first used.
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple

from grader.base.names import MAX_LENGTH
from grader.base.records import Named
from grader.base.source import Location, Source
from grader.ros.python.values import EvaluationFails, Namespace, Undetermined, Value

# What a scope needs to evaluate a text in it, and to report that xacro refuses one, or that it
# cannot be determined.
_Evaluate = Callable[[str, "XacroScope"], Value]
ReportFailure = Callable[[EvaluationFails | Undetermined, "ScopePlace", str], object]


_MAX_CALLS = 20  # that a location names
BOOLEANS = {"true": True, "True": True, "false": False, "False": False}


class ScopePlace(NamedTuple):
    """A start tag in a source file.

    Once expanded, it has its macro calls, outermost first, and the scope.
    """

    source: Source
    tag: int
    calls: "tuple[tuple[str, ScopePlace], ...] | None" = None
    scope: "XacroScope | None" = None

    @property
    def written(self) -> tuple[Source, int]:
        """The text with the tag, and the offset of the tag in it."""
        return self.source.element(self.tag)

    def at(self, attribute: str | None = None) -> Location:
        """Return the location of the tag, or of an attribute if it has it, with the macro calls."""
        location = self.source.tag(self.tag, attribute)
        if not self.calls:
            return location
        return location._replace(
            calls=tuple((macro, place.at()) for macro, place in self.calls[:_MAX_CALLS])
        )


# Where a definition whose text is in an attribute has its name; a macro call has it in no value.
_NAMED_IN = {"name": "name", "value": "name", "default": "name", "params": "params"}
Key = tuple[str, int, str, str]


class XacroDefinition(Named):
    """Where a name got its value.

    This is the text in an attribute, and the scope in which it is evaluated.
    """

    name: str
    text: str
    place: ScopePlace
    attribute: str
    scope: "XacroScope"

    @property
    def key(self) -> Key:
        """What identifies the text in the source, however often it is evaluated."""
        return self.place.source.path, self.place.tag, self.attribute, self.name


# Names that are defined, each with the tag and attribute that define it where they are known.
_Known = Mapping[str, tuple[ScopePlace, str] | None]


class UnknownName(Named):
    """A name that is not defined, and those that are.

    `meant` is the one that it surely stands for, if there is one.

    `kind` is property where the name is in an expression, else what it names: a macro, block,
    parameter, attribute or file.
    """

    name: str
    known: _Known
    kind: str = ""
    meant: str | None = None


class XacroFails(EvaluationFails):
    """Something that xacro refuses; the reason may be a name that it does not know."""

    def __init__(self, message: str, unknown: UnknownName | None = None) -> None:
        super().__init__(message)
        self.unknown = unknown


class Reported(EvaluationFails):
    """Something that xacro refuses, which is already listed as a problem."""


class _Property:
    """A value, or the text whose value is determined at the first use.

    `failure` is why it has none.
    """

    __slots__ = ("definition", "failure", "is_lazy", "is_open", "value")

    def __init__(self, value: Value, *, is_lazy: bool, definition: XacroDefinition | None) -> None:
        value = _literal(value)
        self.value = value
        self.is_lazy = is_lazy and isinstance(value, str)
        self.definition = definition
        self.is_open = False  # whether it is being evaluated
        self.failure: EvaluationFails | Undetermined | None = None


class IncludedNames(Namespace):
    """The properties of an included file with a namespace."""

    __slots__ = ("scope",)

    def __init__(self, name: str, find: Callable[[str], Value], scope: "XacroScope") -> None:
        super().__init__(name, find)
        self.scope = scope


class XacroScope:
    """The names of one macro call or the whole document."""

    def __init__(self, parent: "XacroScope | None" = None, *, is_namespace: bool = False) -> None:
        """`is_namespace`: whether they are those of an included file with a namespace."""
        self.parent = parent
        self.is_namespace = is_namespace
        self.properties: dict[str, _Property] = {}

    @property
    def caller(self) -> "XacroScope | None":
        """The scope that the scope parent means.

        Around a macro, the namespace that it is defined in does not count.
        """
        scope = self.parent
        while not self.is_namespace and scope and scope.is_namespace:
            scope = scope.parent
        return scope

    def bound(self, name: str) -> Value | None:
        """Return what a name stands for without evaluating it; None if nothing binds it."""
        holder = self.holder(name)
        if holder:
            return holder.properties[name].value
        return None

    @property
    def top(self) -> "XacroScope":
        """The scope of the whole document."""
        scope = self
        while scope.parent:
            scope = scope.parent
        return scope

    def holder(self, name: str) -> "XacroScope | None":
        """Return the nearest scope that binds a name."""
        scope: XacroScope | None = self
        while scope and name not in scope.properties:
            scope = scope.parent
        return scope

    def definitions(self) -> dict[str, tuple[ScopePlace, str] | None]:
        """Return the names that are known here, each with what defines it.

        This is a tag and attribute, where there is one.
        """
        visible = self.parent.definitions() if self.parent else {}
        for name, definition in (
            (name, bound.definition) for name, bound in self.properties.items()
        ):
            if len(name) <= MAX_LENGTH and name.isidentifier():  # else it is not compared
                attribute = _NAMED_IN.get(definition.attribute) if definition else None
                visible[name] = (definition.place, attribute) if definition and attribute else None
        return visible

    def blocks(self) -> dict[str, tuple[ScopePlace, str] | None]:
        """Return the names of the blocks of this macro, with its own tag."""
        bound = {
            name.lstrip("*"): block_property.definition
            for name, block_property in self.properties.items()
            if name.startswith("*")
        }
        return {
            name: (block.place, block.attribute) if block else None for name, block in bound.items()
        }

    def bind(
        self,
        name: str,
        value: Value,
        *,
        is_lazy: bool = False,
        definition: XacroDefinition | None = None,
    ) -> None:
        """Give a name a value, or a text that is evaluated lazily."""
        self.properties[name] = _Property(value, is_lazy=is_lazy, definition=definition)

    def remove(self, name: str) -> None:
        """Remove a name from this scope and those around it."""
        scope: XacroScope | None = self
        while scope:
            scope.properties.pop(name, None)
            scope = scope.parent

    def value(self, name: str, evaluate: _Evaluate, report: ReportFailure) -> Value:
        """Return the value of a name that this scope binds itself."""
        binding = self.properties[name]
        if binding.failure:
            raise binding.failure.with_traceback(None)
        if not binding.is_lazy:
            return binding.value
        if binding.is_open:
            raise EvaluationFails(f"the property {name} is defined by itself")
        binding.is_open = True
        try:
            binding.value = _literal(evaluate(binding.value, self))
            binding.is_lazy = False
        except EvaluationFails as error:
            if binding.definition and not isinstance(error, Reported):
                report(error, binding.definition.place, "value")
            binding.failure = Reported(str(error))
            raise binding.failure from None
        except Undetermined as error:
            binding.failure = error
            raise
        finally:
            binding.is_open = False
        return binding.value


def _literal(value: Value) -> Value:
    """Return the number or boolean that a text is for xacro, else the text.

    The text is without single quotes around it.
    """
    if not isinstance(value, str):
        return value
    if len(value) >= 2 and value[0] == "'" == value[-1]:
        return value[1:-1]
    if "_" in value:
        return value
    for kind in (int, float):
        try:
            return kind(value)
        except ValueError:
            pass
    return BOOLEANS.get(value, value)
