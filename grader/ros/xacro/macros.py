"""Macros of xacro: their parameters, and what a call binds to them."""

import re

from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.ros.python.budget import Budget
from grader.ros.python.values import Undetermined
from grader.ros.xacro.scopes import (
    ScopePlace,
    UnknownName,
    XacroDefinition,
    XacroFails,
    XacroScope,
)
from grader.ros.xacro.texts import Texts
from grader.ros.xacro.xacro_nodes import XacroNode

# A parameter with a default, by xacro's `re_macro_arg`. Possessive, to be linear: xacro also tries
# a later quote as the end of one, and `read_parameters` refuses the texts where that matters.
_WITH_DEFAULT = on_use(
    r"""
    \s*([^\s:=]+?)\s*:?=\s*                       # side:=, side=
    (\^\|?)?                           # ^, or ^| before a default: the caller's value comes first
    (
        \$\{.*?\} | \$\(.*?\)                     # ${2*pi}, $(arg side)
      | (?:'[^'\n]*'|\"[^\"\n]*\"|[^\s'\"]++)++   # 0.1, 'left wheel'
      |
    )
    (?:\s+|$)(.*)
    """,
    re.ASCII | re.VERBOSE,
)
_QUOTED = on_use(r"""\$\{[^}]*(?:\}|\Z)|'[^'\n]*'|"[^"\n]*\"""")


class MacroError(XacroFails):
    """A macro that is not defined, or a call that does not fit its parameters."""


class _MacroParameter(Named):
    """A parameter of a macro, with its default.

    `default` is its text, `is_forwarded` whether the caller's property of this name comes before
    it.
    """

    name: str
    default: str | None = None
    is_forwarded: bool = False

    @property
    def is_block(self) -> bool:
        """Return whether it takes an element."""
        return self.name.startswith("*")


class Macro(Named):
    """A macro: its element, whose children a call inserts."""

    name: str
    body: XacroNode
    parameters: tuple[_MacroParameter, ...]


def read_parameters(text: str, budget: Budget) -> tuple[_MacroParameter, ...]:
    """Return the parameters in the attribute params of a macro. Raises Undetermined."""
    if re.search("['\"]", _QUOTED.sub("", text)):
        raise Undetermined("a quote in the parameters of a macro is not closed")
    parameters = []
    defaults = {}  # the last of several counts
    while text:
        budget.charge(1, len(text))
        match = _WITH_DEFAULT.match(text)
        if not match:
            words = text.lstrip().split(None, 1)
            if not words:
                raise MacroError("the parameters of this macro end with a space")
            parameters.append(_MacroParameter(words[0]))
            text = words[1] if len(words) > 1 else ""
        else:
            name, forward, default, text = match.groups()
            defaults[name] = _MacroParameter(name, default or None, is_forwarded=bool(forward))
            parameters.append(defaults[name])
    return tuple(defaults.get(parameter.name, parameter) for parameter in parameters)


def bind_values(
    macro: Macro, call: XacroNode, caller: XacroScope, inner: XacroScope, texts: Texts
) -> list[_MacroParameter]:
    """Bind the parameters that a call gives values in attributes; return the others."""
    left = dict(enumerate(macro.parameters))
    first = {parameter.name: index for index, parameter in reversed(left.items())}
    for name, text in call.attributes.items():
        if name not in first:
            known = dict.fromkeys(first, (macro.body.place, "params"))
            message = (
                f"the macro {macro.name} has no parameter {name}; it has: "
                f"{', '.join(known) or 'none'}"
            )
            meant = _find_meant(name, macro, call)
            raise MacroError(message, UnknownName(name, known, "parameter", meant))
        del left[first[name]]
        texts.check_name(name, macro.body.place, "params")
        texts.bind(inner, name, text, caller, call.place, name)
    return list(left.values())


def _find_meant(name: str, macro: Macro, call: XacroNode) -> str | None:
    """Return the parameter that a name stands for: a near one, or the one that a call lacks."""
    absent = [other for other in macro.parameters if other.name not in call.attributes]
    meant = near(name, [parameter.name for parameter in absent])
    needed = [other.name for other in absent if other.default is None and not other.is_block]
    if meant is None and len(needed) == 1:
        return needed[0]
    return meant


def bind_blocks(
    macro: Macro, blocks: list[XacroNode], left: list[_MacroParameter], inner: XacroScope
) -> None:
    """Bind the parameters that are elements to the children of a call."""
    waiting = list(blocks)
    for parameter in left:
        if parameter.is_block:
            if not waiting:
                raise MacroError(
                    f"this call of the macro {macro.name} has no element for {parameter.name}"
                )
            definition = XacroDefinition(parameter.name, "", macro.body.place, "params", inner)
            inner.bind(parameter.name, waiting.pop(0), definition=definition)
    if waiting:
        raise MacroError(f"the macro {macro.name} takes no element <{waiting[0].tag}> here")


def bind_defaults(
    macro: Macro,
    left: list[_MacroParameter],
    caller: XacroScope,
    inner: XacroScope,
    texts: Texts,
    place: ScopePlace,
) -> None:
    """Bind the parameters that the call at a place does not give."""
    missing = []
    for parameter in left:
        if parameter.is_block:
            continue
        if parameter.is_forwarded and texts.is_bound(parameter.name, caller):
            holder = caller.holder(parameter.name)
            definition = holder.properties[parameter.name].definition if holder else None
            texts.check_name(parameter.name, macro.body.place, "params")
            inner.bind(parameter.name, texts.find(parameter.name, caller), definition=definition)
        elif parameter.default is not None:
            texts.check_name(parameter.name, macro.body.place, "params")
            texts.bind(inner, parameter.name, parameter.default, caller, macro.body.place, "params")
        else:
            missing.append(parameter.name)
    if missing:
        message = f"this call of the macro {macro.name} gives no value for {', '.join(missing)}"
        texts.refuse(inner, missing, MacroError(message), place)
