"""The values of xacro texts: ${expressions}, $(substitutions) and escapes, in a scope."""

import re
from collections.abc import Callable, Iterable
from contextlib import suppress
from keyword import iskeyword
from typing import Literal

from grader.base.grouping import Strings
from grader.base.names import did_you_mean, near
from grader.base.patterns import on_use
from grader.base.text import ILLEGAL
from grader.ros.python.budget import Budget
from grader.ros.python.expressions import evaluate
from grader.ros.python.values import (
    MAX_TEXT,
    EvaluationFails,
    Undetermined,
    Value,
    charge_str,
    too_large,
)
from grader.ros.xacro.functions import GLOBALS
from grader.ros.xacro.scopes import (
    Reported,
    ReportFailure,
    ScopePlace,
    UnknownName,
    XacroDefinition,
    XacroFails,
    XacroScope,
)

# The tokens of xacro's lexer (`eval_text`), where ${'}'} ends at the first brace, too.
PIECE = on_use(
    r"""
      (?P<escape>\$\$+[{(])               # $${, $$(: not evaluated
    | \$\{(?P<expression>[^}]*)\}
    | \$\((?P<substitution>[^)]*)\)       # $(find my_robot), $(arg side)
    | (?P<text>[^$]+|\$[^{($]+|\$\Z)      # wheel, $5, and a $ at the end
    """,
    re.VERBOSE,
)
_TRUTH = {"true": True, "false": False}
TEXT_IN_QUOTES = on_use(r"'[^']*'|\"[^\"]*\"")
_NESTED_FIND = on_use(r"\$\(find +([^\s()$]+) *\)")
_OF_PIECE, _OF_NAME = (
    2,
    20,
)  # what a part of a text, and comparing a name with another one, are charged
_MAX_SHOWN = 60  # characters of a name
# where the packages are for $(find package): in a folder that no workspace has
INSTALLED = "/install"


# What is known of arguments that are not given: the file's defaults count, or a launch file may
# give them, or certainly nothing gives one that has no default.
OtherArguments = Literal["default", "unknown", "none"]


def _check_substitution(text: str, command: str, args: list[str]) -> None:
    """Raise for $(...) that is neither $(find PACKAGE) nor $(arg NAME).

    Raises Undetermined for what xacro accepts, else EvaluationFails.
    """
    if command in ("env", "optenv") and args:
        raise Undetermined(f"the environment variable {args[0]} is known only at run time")
    if text == "cwd":
        raise Undetermined("the folder in which xacro runs is known only at run time")
    if "$" in text or "(" in text:
        raise EvaluationFails(f"$({text}): no $ and no ( can be inside of $(...)")
    if command not in ("find", "arg") or len(args) != 1:
        raise EvaluationFails(f"$({text}): expected $(find PACKAGE) or $(arg NAME)")


class Texts:
    """Evaluates texts.

    `arguments` are those of $(arg): given ones, then the file's defaults; None if unknown.
    """

    def __init__(
        self,
        arguments: dict[str, str | None],
        budget: Budget,
        report: ReportFailure,
        functions: dict[str, Value],
        require_package: Callable[[str], None],
    ) -> None:
        """`own` are functions that need the document, such as load_yaml.

        `require_package` raises Undetermined for a package that is not in the workspace.
        """
        self.arguments = arguments
        self.other_arguments: OtherArguments = "default"
        self.defaults: dict[str, XacroDefinition] = {}  # of arguments that have no other value
        # why a name may be bound that is not known
        self.names_open: EvaluationFails | Undetermined | None = None
        self._budget = budget
        self._require_package = require_package
        self._report = report
        self._globals = {**GLOBALS, **functions}
        self.noted: dict[
            tuple[str, str], None
        ] = {}  # functions that write to stderr, and ^, each with the expression
        self.redefined: dict[
            object, tuple[str, ScopePlace, str]
        ] = {}  # names of xacro's own that get another value
        self._expression = ""  # that is evaluated
        # What is said of a name, and the name that it stands for, by this name and those that are
        # known.
        self._similar: dict[Strings, tuple[str, str | None]] = {}

    def evaluate(self, text: str, scope: XacroScope) -> Value:
        """Return the value of a text.

        It is that of its expression, if it is a single one, else a text.
        """
        if "$" not in text:
            return text
        self._budget.charge(1, len(text))
        values = []
        position = 0
        while position < len(text):
            self._budget.charge(_OF_PIECE)
            piece = PIECE.match(text, position)
            if not piece:
                raise EvaluationFails(f"invalid expression: {text[position : position + 60]}")
            values.append(self._piece(piece, scope))
            position = piece.end()
        return self._charge(values[0] if len(values) == 1 else _joined(map(self.written, values)))

    def _charge(self, value: Value) -> Value:
        """Return a value once its text is charged: it is searched, and read as a number."""
        self._budget.charge(1, len(value) if isinstance(value, str) else 0)
        return value

    def written(self, value: Value) -> str:
        """Return the text of a value. Raises Undetermined, OutOfBudget."""
        if isinstance(value, str):
            return value
        return charge_str(self._budget.checked(value))

    def text(self, text: str, scope: XacroScope) -> str:
        """Return the value of a text as it is written into the expanded file."""
        if "$" not in text:
            return text
        return _for_xml(self.written(self.evaluate(text, scope)))

    def find(self, name: str, scope: XacroScope) -> Value:
        """Return the value of a name: a property, else one of xacro's own."""
        holder = scope.holder(name)
        if holder:
            return self._charge(holder.value(name, self.evaluate, self._report))
        if name in self._globals:
            return self._globals[name]
        if self.names_open:
            raise self.names_open.with_traceback(None)
        raise XacroFails(*self.unknown("property", name, scope, self._globals))

    def unknown(
        self, kind: str, name: str, scope: XacroScope, nearer: Iterable[str] = ()
    ) -> tuple[str, UnknownName]:
        """Return that a name is undefined, and the known ones.

        Raises OutOfBudget: finding a similar one takes long.
        """
        known = {**dict.fromkeys(nearer), **scope.definitions()}
        self._budget.charge(len(known))
        key = (name, *known)
        if key not in self._similar:
            self._budget.charge(_OF_NAME * len(known))
            values = [
                candidate
                for candidate in known
                if isinstance(self._globals.get(candidate, 0), int | float)
            ]  # no functions
            self._similar[key] = did_you_mean(name, known), near(name, values)
        guess, meant = self._similar[key]
        return f"there is no {kind} {name[:_MAX_SHOWN]} at this place{guess}", UnknownName(
            name, known, kind, meant
        )

    def note(self, name: str) -> None:
        """Note that the expression that is evaluated calls a function that writes to stderr."""
        self.noted[name, self._expression] = None

    def check_name(self, name: str, place: ScopePlace, attribute: str = "name") -> None:
        """Note that a name gets a value, of which xacro warns if it has one of its own."""
        if name in self._globals:
            self.redefined[name, place.source.path, place.tag] = name, place, attribute

    def is_bound(self, name: str, scope: XacroScope) -> bool:
        """Return whether a name has a value in a scope."""
        return scope.holder(name) is not None or name in self._globals

    def bind(
        self,
        target: XacroScope,
        name: str,
        text: str,
        scope: XacroScope,
        place: ScopePlace,
        attribute: str,
    ) -> None:
        """Bind a name to the value that the text of an attribute has in a scope.

        Where the text has no value, the name is bound to the reason.
        """
        failure: EvaluationFails | Undetermined | None = None
        value: Value = ""
        self._budget.charge(1, len(text))
        try:
            value = self.evaluate(text, scope)
        except Reported as error:
            failure = error
        except EvaluationFails as error:
            self._report(error, place, attribute)
            failure = Reported(str(error))
        except Undetermined as error:  # xacro evaluates it even if nothing uses it
            self._report(error, place, attribute)
            failure = error
        target.bind(name, value, definition=XacroDefinition(name, text, place, attribute, scope))
        target.properties[name].failure = failure

    def refuse(
        self, target: XacroScope, names: Iterable[str], error: XacroFails, place: ScopePlace
    ) -> None:
        """Bind names to the reason why xacro fails at a place: they have no value."""
        self._report(error, place, "")
        for name in names:
            target.bind(name, "", definition=XacroDefinition(name, "", place, "", target))
            target.properties[name].failure = Reported(str(error))

    def _piece(self, piece: re.Match[str], scope: XacroScope) -> Value:
        if piece["text"] is not None:
            return piece["text"]
        if piece["escape"] is not None:
            return piece["escape"][1:]
        if piece["substitution"] is not None:
            return self._substitution(self.text(piece["substitution"], scope))
        expression = self.text(piece["expression"], scope).strip()
        if (
            expression.isidentifier()
            and not iskeyword(expression)
            and not expression.startswith("__")
        ):
            return self.find(expression, scope)
        around = self._expression
        self._expression = expression
        try:
            value = evaluate(expression, lambda name: self.find(name, scope), self._budget)
        finally:
            self._expression = around
        if "^" in expression and "^" in TEXT_IN_QUOTES.sub("", expression):
            self.noted["^", expression] = None
        return value

    def _substitution(self, text: str) -> str:
        """Return what $(...) gives."""
        command, *args = [word for word in text.split(" ") if word] or [""]
        if not text:
            return "$()"
        if text.startswith("eval "):
            return self._evaluated(text.removeprefix("eval "))
        _check_substitution(text, command, args)
        given = self.share(args[0]) if command == "find" else self.argument(args[0])
        result: str = self._charge(given)
        if "$(" in result:
            return _NESTED_FIND.sub(lambda nested: self.share(nested[1]), result)
        return result

    def _evaluated(self, expression: str) -> str:
        """Return what $(eval ...) gives, which knows arguments and no properties."""
        if "__" in expression:
            raise XacroFails("$(eval ...) must not contain two underscores")
        return self.written(evaluate(expression, self._find_argument, self._budget))

    def _find_argument(self, name: str) -> Value:
        """Return what a name stands for in $(eval ...): a number, a truth value or a text."""
        from grader.ros.known.python_names import python_names  # late: few files use it

        if name in _TRUTH:
            return _TRUTH[name]
        if isinstance(GLOBALS.get(name), float):
            return GLOBALS[name]
        is_known = name in self.arguments or self.other_arguments == "unknown"
        if not is_known and name in (*GLOBALS, *python_names("builtins")):
            raise Undetermined(f"{name} in $(eval ...) is not supported")
        if not is_known:
            raise XacroFails(f"no argument has the name {name}, and $(eval ...) knows no others")
        text = self.argument(name)
        for convert in (float if "." in text else int, _TRUTH.__getitem__):
            with suppress(ValueError, KeyError):
                return convert(text.lower())
        return text

    def share(self, package: str) -> str:
        """Return the text that $(find package) gives."""
        self._require_package(package)
        return f"{INSTALLED}/{package}/share/{package}"

    def argument(self, name: str) -> str:
        """Return the value of an argument."""
        if name not in self.arguments and self.other_arguments == "none":
            default = f'<xacro:arg name="{name}" default="..."/>'
            message = (
                f"nothing gives the argument {name} a value: give it a default ({default}), or "
                "pass it"
            )
            raise XacroFails(f"{message} in the launch file")
        if name not in self.arguments:
            raise Undetermined(f"the argument {name} has no default, and no --arg gives it a value")
        value = self.arguments[name]
        if value is None and self.other_arguments == "unknown":
            raise Undetermined(
                f"the launch file may give the argument {name} a value, and is not evaluated"
            )
        if value is None:
            raise Undetermined(
                f"the launch file gives the argument {name} a value that is known only at run time"
            )
        return value


def _for_xml(value: str) -> str:
    """Return a text that is written into XML.

    Raises EvaluationFails for characters that XML cannot hold.
    """
    if not value.isprintable() and ILLEGAL.search(value):
        raise EvaluationFails("the value has a character that XML cannot hold")
    return value


def _joined(pieces: Iterable[str]) -> str:
    """Return one text of pieces; raise Undetermined as soon as it is too long."""
    kept = []
    length = 0
    for piece in pieces:
        length += len(piece)
        if length > MAX_TEXT:
            too_large("text")
        kept.append(piece)
    return "".join(kept)
