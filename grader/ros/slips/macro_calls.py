"""Calls of macros that do not fit the parameters, and calls that are copies of others."""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import chain

from grader.base.element_edits import with_attribute
from grader.base.grouping import StringsByName
from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips, make_slip
from grader.base.text import cut
from grader.ros.slips.nodes import find_place, list_all_values
from grader.ros.xacro.xacro_nodes import XacroNode, walk
from grader.ros.xml.urdf_format import TAGS

_MAX_SHOWN = 60  # characters of parameters
_EXPRESSION = on_use(r"\$\{([^{}]*)\}")
_NAME = on_use(r"[^\W\d]\w*")
_EQUALS = on_use(r"(?<!\s)\s*+:?=.*")
# a:1, a=:1 and a = : 1 for a:=1
_COLON = on_use(r"(?<![\w:])(?P<name>[^\W\d]\w*)(?:\s*=\s*:\s*|:(?![=\s]))")
# , or ; between parameters, which xacro takes for a part of the name or of the default before it
_SEPARATOR = on_use(r"\$\{[^{}]*\}|'[^']*'|(?P<separator>(?:(?<!\s)\s++)?[,;](?=\s|\Z|[*^\W\d]))")
_OTHER_SIDES = {
    "left": ("right",),
    "right": ("left",),
    "front": ("rear", "back"),
    "rear": ("front",),
    "back": ("front",),
}
_OWN = ("property", "include", "arg", "macro", "if", "unless", "insert_block")


def parameter_slips(nodes: Sequence[XacroNode], called: str) -> Slips:
    """Yield the ways in which the parameters of a macro fit its calls."""
    macros = []
    for node in nodes:
        is_called = node.attributes.get("name", "").removeprefix("xacro:") == called
        if node.tag == "xacro:macro" and is_called and "params" in node.attributes:
            macros.append(node)
    if len(macros) != 1:
        return
    params = macros[0].attributes["params"]
    calls = [node for node in nodes if node.tag == f"xacro:{called}"]
    reaction = f'params="{params}" of the macro {called} does not fit its calls'
    for way in dict.fromkeys((*_declared(macros[0], calls), *_starred(macros[0], calls))):
        edit = with_attribute(*find_place(macros[0]), "params", way)
        assumption = f'it is read as params="{cut(way, _MAX_SHOWN)}"'
        yield make_slip((edit,), reaction, assumption)


def _declared(macro: XacroNode, calls: Iterable[XacroNode]) -> Iterator[str]:
    """Yield the parameters with := for a colon, or with a name that calls give and it uses."""
    params = macro.attributes["params"]
    words = params.split()
    separated = _SEPARATOR.sub(lambda match: " " if match["separator"] else match[0], params)
    for way in (_COLON.sub(r"\g<name>:=", params), separated):
        if way.split() != words:
            yield " ".join(way.split())
    yield from _named_in_calls(macro, calls, words)


def _named_in_calls(
    macro: XacroNode, calls: Iterable[XacroNode], words: list[str]
) -> Iterator[str]:
    """Yield the parameters with the names that calls give and the macro uses."""
    names = [_EQUALS.sub("", word) for word in words]
    given = dict.fromkeys(chain.from_iterable(call.attributes for call in calls))
    used = _list_used(macro)
    absent = [name for name in given if name not in names]
    if absent and used.issuperset(absent):
        yield " ".join(words + absent)
        unused = [name for name in names if name not in {*given, *used}]
        if len(absent) == len(unused) == 1:
            yield _replace_word(words, words[names.index(unused[0])], absent[0])


def _list_used(macro: XacroNode) -> set[str]:
    """Return the names that expressions inside of a macro use."""
    names = set()
    for value in list_all_values(node for node in walk(macro) if node is not macro):
        for inner in _EXPRESSION.findall(value.text):
            names.update(_NAME.findall(inner))
    return names


def _replace_word(words: list[str], word: str, new: str) -> str:
    """Return parameters with a new word in place of the first that is the other one."""
    index = words.index(word)
    return " ".join((*words[:index], new, *words[index + 1 :]))


def _starred(macro: XacroNode, calls: Iterable[XacroNode]) -> Iterator[str]:
    """Yield the parameters with * or ** before the name of a block that the macro inserts."""
    inserted = dict.fromkeys(
        node.attributes.get("name", "") for node in walk(macro) if node.tag == "xacro:insert_block"
    )
    children = {child.tag for call in calls for child in call.elements}
    words = macro.attributes["params"].split()
    for name in inserted:
        stars = "**" if name in children - TAGS.keys() else "*"
        if name in words:
            yield _replace_word(words, name, f"{stars}{name}")
        elif children and {f"*{name}", f"**{name}"}.isdisjoint(words):
            yield " ".join((*words, f"{stars}{name}"))


def copied_call_choices(nodes: Sequence[XacroNode]) -> Iterator[tuple[Slip, ...]]:
    """Yield the later of two calls that give the same words, with the other side in one of them."""
    by_macro: dict[str, list[StringsByName]] = {}
    for node in nodes:
        if not node.tag.startswith("xacro:") or node.tag.removeprefix("xacro:") in _OWN:
            continue
        earlier = by_macro.setdefault(node.tag, [])
        given = node.attributes.items()
        words = {name: text for name, text in given if _NAME.search(text) and "$" not in text}
        if words and words in earlier:
            yield tuple(_on_other_side(node, words, earlier))
        earlier.append(words)


def _on_other_side(
    call: XacroNode, words: StringsByName, others: Collection[StringsByName]
) -> Slips:
    """Yield the call with the other side in one of its words, if no other call gives that."""
    source, start = find_place(call)
    for name, text in words.items():
        for side, others_of_side in _OTHER_SIDES.items():
            for other in others_of_side:
                new = re.sub(rf"(?<![^\W_]){side}(?![^\W_])", other, text)
                if new == text or {**words, name: new} in others:
                    continue
                edit = with_attribute(source, start, name, new)
                reaction = f'{name}="{text}" is given to two calls'
                assumption = f'the second {name}="{text}" is read as "{new}"'
                yield make_slip((edit,), reaction, assumption)
