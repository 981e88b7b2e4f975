"""Calls of rclpy and tf2_ros whose arguments Python cannot bind, or that are exchanged or refused.

Signatures by release are rows of `known/packages/rclpy.toml` and `tf2_ros.toml`. Of a release that
was not read, only missing and exchanged arguments are wrong: it may have more parameters.
"""

import ast
from collections.abc import Callable, Sequence
from functools import cache
from itertools import combinations
from typing import Literal

from grader.base.grouping import Span, Strings, StringsByName
from grader.base.names import near
from grader.base.problems import Fix, Fixes
from grader.base.records import Named
from grader.base.source import Edit, Edits, Source
from grader.base.text import counted, cut, last_part
from grader.ros.known.package_tables import call_signatures
from grader.ros.known.releases import RELEASES, Release, Releases
from grader.ros.python.constants import dotted

ArgumentKind = Literal["text", "number", "function", "type", "node class"]
# What is given to parameters of these names, where an argument surely is of a kind. A depth may
# stand for a profile of quality of service.
_KINDS = {
    "timer_period_sec": "number",
    "callback": "function",
    "execute_callback": "function",
    "topic": "text",
    "srv_name": "text",
    "action_name": "text",
    "name": "text",
    "node_name": "text",
    "target_frame": "text",
    "source_frame": "text",
    "msg_type": "type",
    "srv_type": "type",
    "action_type": "type",
}
_NEVER = {"qos_profile": ("text", "function", "type")}
# What certainly raises an error where it is given, and what is expected instead: rclpy/node.py,
# publisher.py, client.py, type_support.py and action/client.py of ros2/rclpy, Humble to Rolling.
_NO_MESSAGE = ("text", "number", "function", "type", "node class")
_NO_NAME = ("number", "function", "type", "node class")
_NO_TYPE = ("text", "number", "function")
_REFUSED = {
    "msg": (_NO_MESSAGE, "a message"),
    "request": (_NO_MESSAGE, "a request"),
    "goal": (_NO_MESSAGE, "a goal"),
    "node": (("text", "type", "function", "node class"), "a node"),
    "qos_profile": (("text", "function", "type"), "a number or a QoSProfile"),
    "topic": (_NO_NAME, "a name"),
    "srv_name": (_NO_NAME, "a name"),
    "action_name": (_NO_NAME, "a name"),
    "node_name": (_NO_NAME, "a name"),
    "msg_type": (_NO_TYPE, "a type of messages"),
    "srv_type": (_NO_TYPE, "a type of services"),
    "action_type": (_NO_TYPE, "a type of actions"),
    "callback": (("text", "number"), "a function"),
    "execute_callback": (("text", "number"), "a function"),
}
_KIND_WORDS = {
    "text": "a text",
    "number": "a number",
    "function": "a function",
    "type": "a class",
    "node class": "a class",
}
_INSTANCES = ("msg", "request", "goal", "node")  # what an instance of a class is given to
_SECTIONS = {"request": "Request", "goal": "Goal"}  # of a type, whose instance is given
_PARTS = ("Request", "Response", "Goal", "Result", "Feedback")
_MAX_SHOWN = 40  # characters of an argument
_FILLED = {"qos_profile": "10"}  # what is assumed where an argument is missing
_ANYTHING = "..."
_READ = ("humble", "iron", "jazzy")  # those that were read, and between them


class WrongCall(Named):
    """What is wrong with the arguments of a call, and the edits that write what is assumed.

    Without edits, nothing is assumed.
    """

    reaction: str
    assumption: str
    edits: Edits

    @property
    def fixes(self) -> Fixes:
        """The fix that writes what is assumed; it is not certain where a value is not known."""
        is_known = all(_ANYTHING not in edit.new for edit in self.edits)
        fix = Fix(self.edits, self.assumption, is_known)
        return Fixes(lambda: [fix] if fix.edits else [])


class Written(Named):
    """A call as it is written."""

    call: ast.Call
    source: Source
    span_of: Callable[[ast.expr | ast.keyword], Span]  # the offsets of a part
    kind_of: Callable[[ast.expr], ArgumentKind | None]  # None: of any kind
    filled: StringsByName  # what is given to parameters where it is missing

    @property
    def _arguments(self) -> list[ast.expr | ast.keyword]:
        return self.call.args + self.call.keywords

    def added(self, place: int, text: str) -> Edit:
        """Return the edit that adds an argument before the one at a place."""
        if place < len(self._arguments):
            start, _ = self.span_of(self._arguments[place])
            return self.source.edit(start, start, f"{text}, ")
        end = self.span_of(self._arguments[-1] if self._arguments else self.call.func)[1]
        if self._arguments:
            return self.source.edit(end, end, f", {text}")
        end = self.source.text.index("(", end) + 1
        return self.source.edit(end, end, text)

    def without(self, arguments: Sequence[ast.expr | ast.keyword]) -> Edits:
        """Return the edits that remove arguments."""
        edits = []
        for argument in arguments:
            at = self._arguments.index(argument)
            start, end = self.span_of(argument)
            if at > 0:
                start = self.span_of(self._arguments[at - 1])[1]
            elif len(self._arguments) > len(arguments):
                end = self.span_of(self._arguments[1])[0]
            edits.append(self.source.edit(start, end, ""))
        return tuple(edits)

    def replaced(self, part: ast.expr, by: ast.expr) -> Edit:
        """Return the edit that writes another part in the place of a part."""
        text = self.source.text[slice(*self.span_of(by))]
        return self.source.edit(*self.span_of(part), text)


class _Signature(Named):
    """The parameters of a function, in order, and those of them that must be given."""

    positional: Strings
    required: frozenset[str]
    by_name: frozenset[str]  # only
    takes_more: bool  # positional or named ones

    @property
    def names(self) -> frozenset[str]:
        """All names that may be given."""
        return self.by_name.union(self.positional)


def wrong_call(written: Written, function: str, releases: Sequence[Release]) -> WrongCall | None:
    """Return what is wrong with the arguments of a call in each of some releases.

    `function` is a key of the table of calls. The result is None where nothing is wrong, or where
    arguments are unpacked.
    """
    call = written.call
    is_unpacked = any(isinstance(argument, ast.Starred) for argument in call.args)
    if is_unpacked or any(keyword.arg is None for keyword in call.keywords):
        return None
    signatures = _signatures(function, tuple(releases))
    wrong = [_unbound(written, _shown(call), signature) for signature in signatures]
    return wrong[-1] if wrong and all(wrong) else None


def _shown(call: ast.Call) -> str:
    name = dotted(call.func)
    if getattr(call.func, "attr", "") == "__init__":
        name = "super().__init__"
    elif not name.startswith("rclpy."):
        name = last_part(name)
    return f"{name}()"


@cache
def _signatures(function: str, releases: Releases) -> tuple[_Signature, ...]:
    """Return the signatures of a function in some releases, each once."""
    rows = call_signatures().get(function, {})
    signatures = {}
    for release in releases if rows else ():
        earlier = [row for row in rows if RELEASES.index(row) <= RELEASES.index(release)]
        words = rows[earlier[-1] if earlier else next(iter(rows))]
        is_read = release in _READ
        signatures[words, is_read] = _parsed(words, takes_more=not is_read)
    return tuple(signatures.values())


def _parsed(signature: str, *, takes_more: bool) -> _Signature:
    words = signature.split()
    stars = [index for index, word in enumerate(words) if word.startswith("*")]
    end = stars[0] if stars else len(words)
    by_name = [word for word in words[end:] if not word.startswith("*")]
    return _Signature(
        tuple(word.removesuffix("=") for word in words[:end]),
        frozenset(word for word in words[:end] + by_name if not word.endswith("=")),
        frozenset(word.removesuffix("=") for word in by_name),
        takes_more or any(words[index].strip("*") for index in stars),
    )


def _unbound(written: Written, shown: str, signature: _Signature) -> WrongCall | None:
    """Return the first thing that is wrong with the arguments of a call."""
    return (
        _unknown_keyword(written, shown, signature)
        or _too_many(written, shown, signature)
        or _exchanged(written, shown, signature)
        or _missing(written, shown, signature)
        or _refused(written, shown, signature)
    )


def _unknown_keyword(written: Written, shown: str, signature: _Signature) -> WrongCall | None:
    keywords = written.call.keywords
    for keyword in keywords if not signature.takes_more else ():
        name = keyword.arg or ""
        if name in signature.names:
            continue
        meant = near(name, signature.names - {other.arg or "" for other in keywords})
        reaction = f"{shown} has no argument {name}"
        if meant is not None:
            start = written.span_of(keyword)[0]
            end = written.span_of(keyword)[0] + len(name)
            edit = written.source.edit(start, end, meant)
            return WrongCall(reaction, f"{name} is read as {meant}", (edit,))
        return WrongCall(reaction, f"{name} is ignored", written.without([keyword]))
    return None


def _too_many(written: Written, shown: str, signature: _Signature) -> WrongCall | None:
    arguments = written.call.args
    most = len(signature.positional)
    for keyword in written.call.keywords:
        if keyword.arg in signature.positional[: len(arguments)]:
            reaction = f"{shown} gets {keyword.arg} twice"
            return WrongCall(reaction, "the second one is ignored", written.without([keyword]))
    if len(arguments) <= most or signature.takes_more:
        return None
    taken = counted(most, "argument") if most else "no argument"
    reaction = f"{shown} takes {taken} without a name, and gets {len(arguments)}"
    return WrongCall(reaction, "the others are ignored", written.without(arguments[most:]))


class _Given(Named):
    """An argument, the parameter that it is given to, and its kind."""

    name: str
    argument: ast.expr
    kind: ArgumentKind | None


def _exchanged(written: Written, shown: str, signature: _Signature) -> WrongCall | None:
    """Return that two arguments surely stand in each other's place."""
    given = [
        _Given(name, argument, written.kind_of(argument))
        for name, argument in zip(signature.positional, written.call.args, strict=False)
    ]
    for one, other in combinations(given, 2):
        if _are_exchanged(one, other):
            edits = (
                written.replaced(one.argument, other.argument),
                written.replaced(other.argument, one.argument),
            )
            reaction = f"{shown} gets {one.name} and {other.name} in the wrong order"
            return WrongCall(reaction, "they are exchanged", edits)
    return None


def _are_exchanged(one: _Given, other: _Given) -> bool:
    if one.kind is None or other.kind is None:
        return False
    is_right = _fits(one.name, one.kind) and _fits(other.name, other.kind)
    return not is_right and _fits(one.name, other.kind) and _fits(other.name, one.kind)


def _missing(written: Written, shown: str, signature: _Signature) -> WrongCall | None:
    """Return the first argument that is missing; all that are missing are added."""
    arguments = written.call.args
    given = {keyword.arg or "" for keyword in written.call.keywords}
    behind = (*signature.positional[len(arguments) :], *sorted(signature.by_name))
    missing = [name for name in behind if name in signature.required - given]
    if not missing:
        return None
    place = len(arguments)
    if len(missing) == 1:
        kinds = [written.kind_of(argument) for argument in arguments]
        place = _place_of_missing(signature.positional[: place + 1], kinds)
    name = signature.positional[place] if place < len(arguments) else missing[0]
    value = written.filled.get(name) or _FILLED.get(name, _ANYTHING)
    added = [value if place < len(arguments) or len(missing) == 1 else f"{name}={value}"]
    added += [f"{other}={_FILLED.get(other, _ANYTHING)}" for other in missing[1:]]
    if len(missing) == 1 and place == len(arguments) and given:
        added = [f"{name}={value}"]
        place += len(given)
    assumption = f"`{value}` is added" if value != _ANYTHING else "it is assumed"
    edit = written.added(place, ", ".join(added))
    return WrongCall(f"{shown} lacks its argument {name}", assumption, (edit,))


def _refused(written: Written, shown: str, signature: _Signature) -> WrongCall | None:
    """Return the first argument that surely is of a kind that its parameter never takes."""
    given = list(zip(signature.positional, written.call.args, strict=False))
    given += [(keyword.arg or "", keyword.value) for keyword in written.call.keywords]
    for name, argument in given:
        kinds, expected = _REFUSED.get(name, ((), ""))
        kind = written.kind_of(argument)
        if kind in kinds and kind is not None:
            start, end = written.span_of(argument)
            full = written.source.text[start:end]
            text = cut(full, _MAX_SHOWN)
            reaction = f"{shown} gets {_KIND_WORDS[kind]}, {text}, in place of {expected}"
            section = _SECTIONS.get(name, "")
            is_part = last_part(full) in _PARTS
            is_other = is_part and not full.endswith(f".{section}")
            is_other = is_other or last_part(full)[:1].islower()  # a variable, made elsewhere
            if kind not in ("type", "node class") or name not in _INSTANCES or is_other:
                return WrongCall(reaction, "", ())
            made = "()" if not section or is_part else f".{section}()"
            reaction += f"; write {text}{made}"
            edit = written.source.edit(end, end, made)
            return WrongCall(reaction, f"`{text}{made}` is assumed", (edit,))
    return None


def _place_of_missing(names: Sequence[str], kinds: Sequence[ArgumentKind | None]) -> int:
    """Return the last place of a missing argument with which the kinds of the others fit."""
    for place in range(len(kinds), -1, -1):
        others = [name for index, name in enumerate(names) if index != place]
        if all(map(_fits, others, kinds)):
            return place
    return len(kinds)


def _fits(name: str, kind: ArgumentKind | None) -> bool:
    """Return whether an argument of a kind, None for any, may be given to a parameter."""
    if kind is None:
        return True
    return kind not in _NEVER.get(name, ()) and kind == _KINDS.get(name, kind)
