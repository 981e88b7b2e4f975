"""Names of xacro that are written as other tools and languages write them, or in comments."""

import re
from collections.abc import Collection, Iterable, Sequence

from grader.base.element_edits import with_attribute
from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.slips import Slips, make_slip
from grader.base.source import Edit, Source
from grader.base.text import cut, enumerated
from grader.ros.slips.nodes import find_place, list_all_values
from grader.ros.xacro.xacro_nodes import XacroNode

_MAX_SHOWN = 60  # characters of a text
_EXPRESSION = on_use(r"\$\{([^{}]*)\}")
# What xacro has, by the names that C, numpy, JavaScript and Arduino give it.
_OF_OTHERS = {
    "M_PI_2": "(pi / 2)",
    "M_PI": "pi",
    "PI": "pi",
    "π": "pi",
    "deg2rad": "radians",
}
_WORD = on_use(r"(?:(?:np|numpy|[Mm]ath|std|cmath)(?:\.|::))?(?P<name>[^\W\d]\w*)")
_IN_BRACES = on_use(r"\$?[{(]\s*(?P<inner>[^\W\d]\w*)\s*[})]|\$(?P<bare>[^\W\d]\w*)")
_DEFINING = ("xacro:property", "xacro:arg", "xacro:macro")
# The commands of launch files that xacro has by another name.
_OF_LAUNCH = {"find-pkg-share": "find", "var": "arg"}
_COMMAND = on_use(r"\$\(\s*+(?P<command>[\w-]++)\s++(?P<rest>[^()$]*+)\)")
_COMMANDS = ("find", "arg", "env", "optenv", "eval", "dirname", "cwd", "anon")
_DISABLED = on_use(r"<!--\s*(?P<tag><xacro:(?:include|property|arg)\s[^<>]*/>)\s*-->")


def foreign_name_slips(nodes: Iterable[XacroNode], defined: Collection[str]) -> Slips:
    """Yield the one slip of all names in expressions that other libraries have: np.pi, M_PI.

    Those that are `defined` are the student's own.
    """
    edits = []
    words: dict[str, None] = {}

    def read(match: re.Match[str]) -> str:
        name = match["name"]
        meant = name if name in defined else _OF_OTHERS.get(name, name)
        if meant != match[0]:
            words[match[0]] = None
        return meant

    for value in list_all_values(nodes):
        new = _EXPRESSION.sub(lambda match: _WORD.sub(read, match[0]), value.text)
        if new != value.text:
            edits.append(value.edit(new))
    if edits:
        named = enumerated(words)
        shown = cut(edits[0].old, _MAX_SHOWN)
        assumption = f"{shown} is read as {cut(edits[0].new, _MAX_SHOWN)}"
        yield make_slip(edits, f"xacro has no {named}", assumption)


def name_in_braces_slips(nodes: Iterable[XacroNode]) -> Slips:
    """Yield the definitions whose name is in ${}, which xacro evaluates."""
    for node in nodes:
        name = node.attributes.get("name", "")
        match = _IN_BRACES.fullmatch(name)
        if node.tag in _DEFINING and match:
            meant = match["inner"] or match["bare"]
            edit = with_attribute(*find_place(node), "name", meant)
            reaction = f"<{node.tag}> gives the name {name}, which is evaluated"
            yield make_slip([edit], reaction, f"the name {name} is read as {meant}")


def _meant_word(word: str, name: str, arguments: Sequence[str]) -> tuple[str, str | None]:
    """Return the word of a command with a name that is wrong, and the one that is meant."""
    if word not in _COMMANDS:
        return word, _OF_LAUNCH.get(word) or near(word, ("find", "arg"))
    return name, near(name, arguments) if word == "arg" and name not in arguments else None


def command_slips(nodes: Sequence[XacroNode]) -> Slips:
    """Yield the commands and arguments in $() that can only be others: $(find-pkg-share x)."""
    arguments = [node.attributes.get("name", "") for node in nodes if node.tag == "xacro:arg"]
    by_words: dict[tuple[str, str], list[Edit]] = {}
    for value in list_all_values(nodes):
        for match in _COMMAND.finditer(value.text):
            name = match["rest"].strip()
            word, meant = _meant_word(match["command"], name, arguments)
            if meant is not None:
                start, end = match.span()
                changed = match[0].replace(word, meant, 1)
                edit = value.edit(f"{value.text[:start]}{changed}{value.text[end:]}")
                by_words.setdefault((word, meant), []).append(edit)
    for (word, meant), edits in by_words.items():
        yield make_slip(edits, f"xacro has no {word}", f"{word} is read as {meant}")


def commented_slips(sources: Iterable[Source], name: str) -> Slips:
    """Yield the includes, properties and arguments in comments that may define a name."""
    for source in sources:
        for comment in _DISABLED.finditer(source.text):
            edit = source.edit(*comment.span(), comment["tag"])
            shown = cut(comment["tag"], _MAX_SHOWN)
            yield make_slip(
                [edit], f"{name} is not known", f"{shown} is read, which is in a comment"
            )
