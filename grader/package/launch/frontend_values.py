"""Values in XML and YAML launch files: texts with substitutions, by launch's grammar, and texts that are numbers."""

import re
import shlex
from dataclasses import dataclass
from typing import Any

import yaml

from grader.names import closest
from grader.package.launch.api import front_end
from grader.python.parse import Position
from grader.python.values import Call, EvaluationFails, Undetermined, Value

_MAX_DEPTH = 40
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_-]*")
_BEFORE_NEXT = {"": " '\"()", "'": " '()", '"': ' "()'}  # what ends a value, in no quotes and in each kind of quotes
# The names of the arguments of each substitution that is evaluated; those in brackets may be missing.
_ARGUMENTS = {
    "var": "variable_name [default]",
    "env": "name [default_value]",
    "command": "command [on_stderr]",
    "find-pkg-share": "package",
    "find-exec": "name",
    "eval": "expression [python_modules]",
    "dirname": "",
}
_ON_STDERR = (["fail"], ["ignore"], ["warn"], ["capture"])


def parse_value(text: str, at: Position) -> list[Value]:
    """Return a value as a list of strings and substitutions. Raises EvaluationFails."""
    parser = _ValueParser(text, at)
    found = parser.template("", 0)
    return found or [""]


@dataclass(slots=True)
class _ValueParser:
    """Parses a value from its beginning to its end."""

    text: str
    at: Position
    position: int = 0

    @property
    def next(self) -> str:
        return self.text[self.position : self.position + 1]

    def template(self, quote: str, depth: int) -> list[Value]:
        """Return strings and substitutions, up to the closing quote or the end."""
        found: list[Value] = []
        while self.position < len(self.text) and (not quote or self.next != quote):
            found.append(self.part(quote, quote, depth))
        if quote and self.position >= len(self.text):
            raise EvaluationFails(f"a quote is not closed in {self.text[:60]!r}", self.at)
        self.position += len(quote)
        return found

    def part(self, ends: str, quote: str, depth: int) -> Value:
        """Return a substitution, or a string up to the next one or an end."""
        if self.text.startswith("$(", self.position):
            self.position += 2
            return self.substitution(quote, depth + 1)
        start = self.position
        while (
            self.position < len(self.text) and not self.text.startswith("$(", self.position) and self.next not in ends
        ):
            is_escape = self.next == "\\" and self.text[self.position + 1 : self.position + 2] not in ("", " ", "\n")
            self.position += 2 if is_escape else 1
        return re.sub(r"\\(.)", r"\1", self.text[start : self.position])

    def substitution(self, quote: str, depth: int) -> Call:
        """Return the substitution in brackets: a name, and values separated by one space each."""
        name = _NAME.match(self.text, self.position)
        if name is None or depth > _MAX_DEPTH:
            raise EvaluationFails(f"there is no name of a substitution after $( in {self.text[:60]!r}", self.at)
        self.position, values = name.end(), list[list[Value]]()
        while self.next == " ":
            self.position += 1
            values.append(self.value(quote, depth))
        if self.next != ")":
            what = "is not closed" if not self.next else f"has {self.next!r} in an argument without quotes"
            raise EvaluationFails(f"the bracket of $({name[0][:40]} {what}", self.at)
        self.position += 1
        return self.call(name[0], values)

    def value(self, quote: str, depth: int) -> list[Value]:
        if not quote and self.next in ("'", '"'):
            own = self.next
            self.position += 1
            return self.template(own, depth)
        found: list[Value] = []
        while self.next and self.next not in _BEFORE_NEXT[quote]:
            found.append(self.part(_BEFORE_NEXT[quote], quote, depth))
        if not found:
            raise EvaluationFails(
                f"an argument is missing in {self.text[:60]!r}: write one space between arguments", self.at
            )
        return found

    def call(self, name: str, values: list[list[Value]]) -> Call:
        """Return a substitution as the call that it is in Python. Raises EvaluationFails."""
        if name == "command" and len(values) > 1 and values[1] not in _ON_STDERR:
            raise EvaluationFails("$(command ...) needs quotes around its command: $(command 'xacro ...')", self.at)
        if name not in _ARGUMENTS:
            if name in front_end("substitution"):
                raise Undetermined(f"the substitution $({name} ...) is not evaluated", self.at)
            similar = closest(name, _ARGUMENTS)
            raise EvaluationFails(
                f"there is no substitution $({name} ...){f'; did you mean $({similar} ...)?' if similar else ''}",
                self.at,
            )
        names = _ARGUMENTS[name].split()
        if not len([it for it in names if it[0] != "["]) <= len(values) <= len(names):
            raise EvaluationFails(
                f"$({name} ...) takes {len(names) or 'no'} argument{'s' * (len(names) != 1)}", self.at
            )
        plain = ("".join(value) if all(isinstance(it, str) for it in value) else value for value in values)
        kwargs: dict[str, Value] = dict(zip((it.strip("[]") for it in names), plain, strict=False))
        return Call(front_end("substitution")[name], [], kwargs, self.at)


def command_line(text: str, at: Position) -> list[list[Value]]:
    """Return the words of a line as launch splits it: strings are split, the values of substitutions are not."""
    words: list[list[Value]] = [[]]
    for piece in parse_value(text, at):
        if not isinstance(piece, str):
            words[-1].append(piece)
            continue
        try:
            found = shlex.split(piece)
        except ValueError:
            raise EvaluationFails(
                "quotes cannot enclose a substitution in a line of arguments: remove them", at
            ) from None
        if piece[:1].isspace() or not found:
            words.append([])
        words[-1] += found[:1]
        words += [[word] for word in found[1:]]
        if piece[-1:].isspace():
            words.append([])
    return [word for word in words if word]


def typed_text(text: str, kind: type | None, at: Position) -> Any:
    """Return the value of a text in XML as a type, by default any scalar; a text that is none of it stays a text."""
    if kind is float:
        try:
            return float(text)
        except ValueError:
            return text
    text = {"1": "true", "0": "false"}.get(text, text) if kind is bool else text
    try:
        found = yaml.safe_load(text) if text else text
    except (yaml.YAMLError, ValueError, RecursionError):
        return text
    if not is_typed(found, kind, at):
        raise EvaluationFails(f"{text[:40]!r} is of no type that is accepted here: put quotes in it", at)
    return found


def is_typed(value: Any, kind: type | None, at: Position) -> bool:
    """Return whether a value is a text or of a type; with None, whether it is a scalar. Raises Undetermined."""
    if isinstance(value, list) and kind is None:
        raise Undetermined("a list in this place is not evaluated", at)
    return isinstance(value, str | (kind or float) | (kind or int))


def parse_if_text(value: Any, at: Position) -> Any:
    """Return a value; a text is parsed. Raises EvaluationFails."""
    parts = parse_value(value, at) if isinstance(value, str) else [value]
    return parts[0] if len(parts) == 1 and not isinstance(parts[0], Call) else parts
