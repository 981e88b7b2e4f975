"""Walks the elements of a xacro file and writes the expanded ones, in the order of xacro."""

from collections.abc import Callable, Mapping
from itertools import chain

from grader.base.grouping import Strings
from grader.base.problems import NO_FIXES, Fixes, Kind, Problem
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.python.budget import CHARACTERS, Budget, OutOfBudget
from grader.ros.python.values import EvaluationFails, Undetermined, Value
from grader.ros.xacro import xacro_problems
from grader.ros.xacro.corrections import Refusal, find_correction
from grader.ros.xacro.functions import document_functions, read_yaml_values
from grader.ros.xacro.macros import MacroError
from grader.ros.xacro.scopes import Reported, ScopePlace, XacroFails, XacroScope
from grader.ros.xacro.texts import Texts
from grader.ros.xacro.xacro_files import FileFails, Files, XmlFails
from grader.ros.xacro.xacro_nodes import XacroNode, walk

_MAX_DOCUMENT = 1024 * 1024  # characters of the values and texts in the expanded document
_OF_ELEMENT, _OF_ATTRIBUTE = 10, 2  # what expanding one is charged
_COMPARED = 16  # names that are compared for one part
_MAX_LISTED = 100
_MAX_CORRECTED = 20
_TOO_DEEP = "elements and macros are nested too deeply"
STOPS = "xacro fails here, so ROS 2 loads no robot"


class TagFails(XacroFails):
    """A xacro tag with a missing or wrong attribute."""


class UndeterminedUse(Named):
    """Something that cannot be determined statically, and where it is used."""

    reason: str
    location: Location


class Scopes(Named):
    """The macros and properties that are known at a place."""

    macros: XacroScope
    symbols: XacroScope


# Expands one xacro tag: its element, the expanded element that the result goes into, and the
# scopes.
Handler = Callable[["Expander", XacroNode, XacroNode, Scopes], None]
_KINDS: Mapping[type[EvaluationFails], Kind] = {
    MacroError: xacro_problems.XACRO_MACRO,
    FileFails: xacro_problems.XACRO_FILE,
    XmlFails: xacro_problems.XACRO_NOT_XML,
    TagFails: xacro_problems.XACRO_TAG,
}


# The attributes that xacro knows of each tag; of others it warns.
_ATTRIBUTES: Mapping[str, Strings] = {
    "xacro:property": ("name", "value", "default", "remove", "scope", "lazy_eval"),
    "xacro:macro": ("name", "params"),
    "xacro:insert_block": ("name",),
    "xacro:if": ("value",),
    "xacro:unless": ("value",),
    "xacro:arg": ("name", "default"),
    "xacro:include": ("filename", "ns", "optional"),
}


class Expander:
    """The state of one expansion. `calls` are the macro calls around the current place."""

    def __init__(
        self,
        files: Files,
        arguments: Mapping[str, str | None],
        budget: Budget,
        handlers: Mapping[str, Handler],
        other: Handler,
    ) -> None:
        """`handlers` expand xacro's own tags, and `other` the calls of macros.

        A call of a macro is every other tag that begins with xacro.
        """
        self.files = files
        self.budget = budget
        # `texts` is set below, so that the lambda is needed.
        functions = document_functions(
            self._load_yaml,
            lambda name: self.texts.argument(name),  # noqa: PLW0108
            lambda name: self.texts.note(name),  # noqa: PLW0108
        )
        self.texts = Texts(
            dict(arguments), self.budget, self.report, functions, files.require_package
        )
        self.own_tags = [tag.removeprefix("xacro:") for tag in handlers]
        self.problems: list[Problem] = []
        self.warnings: list[Problem] = []  # what xacro writes to stderr, and notes
        self.undetermined: list[UndeterminedUse] = []
        self.refused: list[Refusal] = []  # what hints may correct, and where
        self.calls: tuple[tuple[str, ScopePlace], ...] = ()
        self._listed: set[tuple[str, str, int, str | None]] = set()
        self._is_expanded = False
        self._length = 0  # of the expanded document
        self._stopped: ScopePlace | None = None  # where the budget was spent
        self._handlers = handlers
        self._other = other

    def root(self, source: XacroNode) -> XacroNode:
        """Return the expanded root element of a document."""
        scopes = Scopes(XacroScope(), XacroScope())
        out = XacroNode(source.tag, source.place)
        try:
            out = self.start(source, scopes)
            self.content(source, out, scopes)
        except OutOfBudget as error:
            out.open = self.report(error, self._stopped or source.place)
        self._is_expanded = True
        self._warn_of_names()
        return out

    def content(self, source: XacroNode, out: XacroNode, scopes: Scopes) -> None:
        """Expand the children of an element into another.

        It omits what is refused or cannot be determined.
        """
        out.open = out.open or source.open
        for child in source.children:
            place = child.place if isinstance(child, XacroNode) else source.place
            try:
                if isinstance(child, XacroNode):
                    self._element(child, out, scopes)
                else:
                    text = self.texts.text(child, scopes.symbols)
                    self._grow(text)
                    out.children.append(text)
            except (
                OutOfBudget,
                RecursionError,
            ) as error:  # every element around may have more content
                stop = error if isinstance(error, OutOfBudget) else OutOfBudget(_TOO_DEEP)
                self._stopped = self._stopped or place
                out.open = out.open or str(stop)
                raise stop from None
            except (EvaluationFails, Undetermined) as error:
                reason = self.report(error, place)
                out.open = out.open or reason

    def insert(self, source: XacroNode, out: XacroNode, scopes: Scopes) -> None:
        """Expand the children of an element, but not itself, such as <xacro:if>.

        Attributes set on it are lost.
        """
        inside = XacroNode(source.tag, source.place)
        try:
            self.content(source, inside, scopes)
        finally:
            out.children += inside.children
            out.open = out.open or inside.open

    def start(self, source: XacroNode, scopes: Scopes) -> XacroNode:
        """Return an element with its attributes expanded, without its children."""
        out = XacroNode(source.tag, self._place(source.place, scopes.symbols))
        out.unresolved = dict(source.unresolved)
        for name, text in source.attributes.items():
            is_plain = "$" not in text or name in out.unresolved
            value = text if is_plain else self._attribute(out, name, text, scopes)
            if not name.startswith("xacro:"):
                self.set(out, name, value)
        return out

    def set(self, out: XacroNode, name: str, value: str) -> None:
        """Set an attribute of an expanded element.

        Raises OutOfBudget: each is compared with all others.
        """
        self._grow(value, len(out.attributes) // _COMPARED + len(name) // CHARACTERS)
        out.attributes[name] = value

    def _grow(self, text: str, parts: int = 0) -> None:
        """Charge a text that the expanded document contains, and other parts.

        Raises OutOfBudget.
        """
        self.budget.charge(_OF_ATTRIBUTE + parts, len(text))
        self._length += len(text)
        if self._length > _MAX_DOCUMENT:
            raise OutOfBudget("the expanded document is larger than a URDF may be")

    def report(
        self,
        error: EvaluationFails | Undetermined | OutOfBudget,
        place: ScopePlace,
        attribute: str | None = None,
    ) -> str:
        """List a problem, or what cannot be determined.

        Returns why it cannot, nothing for what xacro refuses.
        """
        message = str(error)
        if isinstance(error, Reported) or not self._is_new(message, place, attribute):
            return "" if isinstance(error, EvaluationFails) else message
        location = self._place(place).at(attribute)
        if not isinstance(error, EvaluationFails):
            self.undetermined.append(UndeterminedUse(message, location))
            return message
        refusal = Refusal(error, place, attribute)
        correction = None
        if len(self.refused) < _MAX_CORRECTED:
            correction = find_correction(refusal, self.files)
        fixes = NO_FIXES
        if correction:
            message = correction.problem or message
            fix = correction.fix
            fixes = Fixes(lambda: [fix])
        self.refused.append(refusal._replace(correction=correction))
        joint = " " if message.endswith("?") else "; "
        kind = _KINDS.get(type(error), xacro_problems.XACRO_EXPRESSION)
        problem = Problem(kind, f"{message}{joint}{STOPS}", location, fixes=fixes)
        self.problems.append(problem)
        return ""

    def warn(
        self, kind: Kind, message: str, place: ScopePlace, attribute: str | None = None
    ) -> None:
        """List something that xacro expands, and warns of."""
        if self._is_new(message, place, attribute):
            self.warnings.append(Problem(kind, message, self._place(place).at(attribute)))

    def _warn_of_names(self) -> None:
        """List functions that wrote to stderr, names of xacro with other values, each use of ^."""
        for name, place, attribute in self.texts.redefined.values():
            message = (
                f"{quoted(name)} is a built-in name of xacro, which warns if it is redefined: "
                "choose another name"
            )
            self.warn(xacro_problems.XACRO_REDEFINED, message, place, attribute)
        for name, expression in self.texts.noted:
            at = self._where(expression)
            if name == "^":
                kind = xacro_problems.XACRO_CARET
                message = "^ is exclusive or in Python; power is **"
            elif name.startswith("xacro."):
                kind = xacro_problems.XACRO_MESSAGE
                message = f"{name}() writes a message to stderr"
            else:
                full = f"{'python' if name in ('sorted', 'range') else 'xacro'}.{name}"
                kind = xacro_problems.XACRO_DEPRECATED
                message = f"xacro warns of {name}(): write {full}()"
            self.warn(kind, message, *at)

    def _where(self, expression: str) -> tuple[ScopePlace, str | None]:
        """Return the first element that has an expression, and the attribute that it is in."""
        for node in chain.from_iterable(map(walk, self.files.documents.values())):
            for attribute, text in node.attributes.items():
                if expression in text:
                    return node.place, attribute
            if any(isinstance(child, str) and expression in child for child in node.children):
                return node.place, None
        return next(iter(self.files.documents.values())).place, None

    def _is_new(self, message: str, place: ScopePlace, attribute: str | None) -> bool:
        """Return whether something is to be listed.

        It is once for each place in the source, for all calls of a macro.
        """
        known = len(self._listed)
        if known < _MAX_LISTED:
            self._listed.add((message, place.source.path, place.tag, attribute))
        return len(self._listed) > known

    def _place(self, place: ScopePlace, scope: XacroScope | None = None) -> ScopePlace:
        if place.calls is not None:
            return place
        return ScopePlace(place.source, place.tag, self.calls, scope)

    def _element(self, node: XacroNode, out: XacroNode, scopes: Scopes) -> None:
        self.budget.charge(_OF_ELEMENT, len(node.tag))
        if node.tag.startswith("xacro:"):
            self.budget.charge(len(node.attributes), sum(map(len, node.attributes.values())))
            unknown = node.attributes.keys() - _ATTRIBUTES.get(node.tag, node.attributes.keys())
            self._handlers.get(node.tag, self._other)(self, node, out, scopes)
            if unknown:
                named = enumerated([quoted(name) for name in node.attributes if name in unknown], 3)
                message = f"<{node.tag}> has no attribute {named}; xacro warns of it"
                self.warn(xacro_problems.XACRO_ATTRIBUTE, message, node.place, min(unknown))
        else:
            new = self.start(node, scopes)
            out.children.append(new)
            self.content(node, new, scopes)

    def _attribute(self, out: XacroNode, name: str, text: str, scopes: Scopes) -> str:
        """Return the value of an attribute; its text as it is written where it has none."""
        try:
            return self.texts.text(text, scopes.symbols)
        except (EvaluationFails, Undetermined) as error:
            out.unresolved[name] = self.report(error, out.place, name)
        return text

    def _load_yaml(self, name: Value) -> Value:
        if self._is_expanded:
            raise Undetermined("a YAML file is not read again for each edit")
        data = self.files.read(self.files.path(self.texts.written(name)))
        return read_yaml_values(data, lambda name: self.texts.find(name, XacroScope()), self.budget)
