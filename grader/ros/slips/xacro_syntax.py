"""The expressions of xacro whose syntax can be read in one way only."""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence
from functools import partial

from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips, make_slip
from grader.base.source import Edit, Source
from grader.base.text import blanked, cut
from grader.ros.slips.nodes import WrittenValue, find_place, list_all_values, list_values
from grader.ros.xacro.xacro_nodes import XacroNode, walk
from grader.ros.xml.urdf_format import PARTS

_MAX_PLACES = 8  # where a brace may be missing
_MAX_SHOWN = 60
_DECIMAL_COMMA = on_use(r"\s*[-+]?\d+,\d+\s*")
_EXPRESSION = on_use(r"\$\{([^}$]*)\}")
_COMMANDS = r"(?:find|arg|env|optenv|eval|dirname|cwd|anon)\b"
# $(a / 4) with an operator, and $[a / 4]: what is in them is no substitution.
_IN_PARENTHESES = on_use(rf"\$\((?!\s*{_COMMANDS})((?:[^()$]|\([^()$]*\))*)\)")
_IN_BRACKETS = on_use(r"\$\[([^\[\]$]*)\]")
# ${{a}} and ${a}}, and {a / 4} or $ {a / 4} with a name that is known.
_MIXED = on_use(r"\$\(((?:[^()${}]|\([^()${}]*\))*)\}")  # $(a / 4}
_BARE = on_use(r"(?:\$(?!\())?\s*+((?=[^*/+-]*+[*/+-])[\w\s.+*/()-]++)")  # a / 4, $a / 4
_IN_BRACES = on_use(r"\$\{\{?([^{}$]*)\}\}")
_WITHOUT_DOLLAR = on_use(r"(?<![${])(?:\$\s+)?\{([^{}$]*)\}")
# {side}, $ {side}, $(side), $side
_UNMARKED = on_use(
    r"\$\{+[^{}]*+\}+|(?:\$\s*+)?\{\s*+(?P<brace>[^\W\d]\w*)\s*\}"
    r"|\$\(\s*(?P<paren>[^\W\d]\w*)\s*\)|\$(?P<bare>[^\W\d]\w*)"
)
_OPERATOR = on_use(r"[-+*/%<>=]|\b(?:and|or|not|if)\b")
_WORDS = on_use(r"\b[^\W\d]\w*")
_TEXT_IN_QUOTES = on_use(r"('[^']*'|\"[^\"]*\")")
_SINGLE_EQUALS = on_use(r"(?<![=!<>])=(?!=)")
_TIMES = on_use(
    r"(?<=[\w.)])\s+[xX]\s+(?=[\w.(])|(?<=\d)\s*[xX]\s*(?=[\d.(])|(?:(?<!\s)\s++)?[×·∙]\s*"
)
# Signs that stand for those of Python in an expression.
_SIGNS = {
    "−": "-",
    "–": "-",
    "÷": "/",
    "===": "==",
    "=>": ">=",
    "||": " or ",
    "²": " ** 2",
    "³": " ** 3",
    "\\": "/",
    "&amp;&amp;": " and ",
}


def expression_slips(root: XacroNode, names: set[str]) -> Iterator[tuple[Slip, ...]]:
    """Yield the values of attributes with an expression that xacro cannot read.

    Of each, yield all ways to read it. `names` are those of properties and parameters.
    """
    for node in walk(root):
        for value in list_values(*find_place(node)):
            ways = dict.fromkeys(_list_ways(node, value, names))
            if ways:
                yield tuple(_slip(value, new) for new in ways)


def _list_ways(node: XacroNode, value: WrittenValue, names: set[str]) -> list[str]:
    """Return the ways to read a value with an expression."""
    text = value.text
    name = value.attribute.name
    ways: list[str] = []
    if "$" in text or "{" in text:
        is_condition = node.tag in ("xacro:if", "xacro:unless")
        ways += _read_text(text, names, is_condition=is_condition)
    bare = _BARE.fullmatch(text)
    if bare and not ways and _is_number(node, name):
        ways += [f"${{{bare[1]}}}"] if names.issuperset(_WORDS.findall(bare[1])) else []
    return ways


def refused_expression_slips(source: Source, start: int, attribute: str | None, name: str) -> Slips:
    """Yield the ways to read an expression that xacro refuses: ** for ^, and a text in quotes.

    A `name` that is not known may be such a text where it is compared: ${side == left}.
    """
    word = re.escape(name)
    compared = re.compile(rf"([=!]=\s*+){word}(?![\w.(\[])|(?<![\w.])\b{word}(?=\s*+[=!]=)")
    for value in list_values(source, start):
        if attribute not in (None, value.attribute.name) or "${" not in value.text:
            continue
        quote = "'" if source.text[value.attribute.value_end] == '"' else '"'
        if name:
            new = compared.sub(rf"\g<1>{quote}{name}{quote}", value.text)
        elif _TEXT_IN_QUOTES.search(value.text):
            continue
        else:
            new = _EXPRESSION.sub(lambda match: match[0].replace("^", "**"), value.text)
        if new != value.text:
            yield _slip(value, new)


def unmarked_slips(nodes: Iterable[XacroNode], names: Collection[str]) -> Slips:
    """Yield the one slip of all known names that have another form than ${side}.

    Such a form is {side}, $ {side}, $(side) or $side.
    """
    edits = []
    for value in list_all_values(nodes):
        new = _UNMARKED.sub(partial(_mark, names), value.text)
        if new != value.text and value.attribute.name != "params":
            edits.append(value.edit(new))
    yield from _slip_of_all(edits, is_refused=False)


def decimal_comma_slips(nodes: Iterable[XacroNode]) -> Slips:
    """Yield the one slip of all numbers with a decimal comma that properties and calls give."""
    edits = []
    for value in list_all_values(node for node in nodes if node.tag.startswith("xacro:")):
        if _DECIMAL_COMMA.fullmatch(value.text):
            edits.append(value.edit(value.text.replace(",", ".")))
    yield from _slip_of_all(edits, is_refused=True)


def _slip_of_all(edits: Sequence[Edit], *, is_refused: bool) -> Slips:
    """Yield the one slip of all values that are written in the same wrong way."""
    if edits:
        old, new = (cut(text, _MAX_SHOWN) for text in (edits[0].old, edits[0].new))
        reaction = f"xacro cannot read {old}"
        yield make_slip(edits, reaction, f"{old} is read as {new}", is_refused=is_refused)


def _mark(names: Collection[str], match: re.Match[str]) -> str:
    """Return a known name in ${}, or what is written; of side_x, what is known is before _."""
    name = match["brace"] or match["paren"] or match["bare"] or ""
    if match["bare"]:
        while name not in names and "_" in name:
            name = name.rpartition("_")[0]
    if not name or name not in names:
        return match[0]
    rest = match["bare"][len(name) :] if match["bare"] else ""
    return f"${{{name}}}{rest}"


def _slip(value: WrittenValue, new: str) -> Slip:
    shown = cut(value.text, _MAX_SHOWN)
    reaction = f"xacro cannot read {shown}"
    assumption = f"{shown} is read as {cut(new, _MAX_SHOWN)}"
    return make_slip([value.edit(new)], reaction, assumption)


def list_names(root: XacroNode) -> set[str]:
    """Return the names of properties and of parameters that a file has."""
    names = set()
    for node in walk(root):
        if node.tag == "xacro:property":
            names.add(node.attributes.get("name", ""))
        elif node.tag == "xacro:macro":
            names.update(_WORDS.findall(node.attributes.get("params", "")))
    return names


def _read_text(text: str, names: set[str], *, is_condition: bool) -> Iterator[str]:
    """Yield the ways to read a value whose expressions xacro cannot read."""
    if "${" in _EXPRESSION.sub("", text):  # an expression has no } at its end
        yield from _with_brace(text, names)
        return
    new = _MIXED.sub(r"${\1}", text)
    new = _IN_BRACES.sub(r"${\1}", _IN_BRACKETS.sub(r"${\1}", new))
    new = _WITHOUT_DOLLAR.sub(
        lambda match: (
            match[0] if names.isdisjoint(_WORDS.findall(match[1])) else f"${{{match[1]}}}"
        ),
        new,
    )
    new = _IN_PARENTHESES.sub(
        lambda match: f"${{{match[1]}}}" if _OPERATOR.search(match[1]) else match[0], new
    )
    new = _EXPRESSION.sub(
        lambda match: f"${{{_with_signs(match[1], names, is_condition=is_condition)}}}", new
    )
    if new != text:
        yield new


def _is_number(node: XacroNode, attribute: str) -> bool:
    """Return whether an attribute may have the value of an expression with numbers."""
    if node.tag.startswith("xacro:"):
        return attribute not in ("name", "params", "filename")
    return len(PARTS.get(attribute, ())) == 1


def _with_brace(text: str, names: set[str]) -> Iterator[str]:
    """Yield a text with the } that an expression lacks in each place where it can be.

    A ) or ] without its opening one stands for it.
    """
    start = _EXPRESSION.sub(blanked, text).index("${")
    end = text.find("$", start + 2)
    ways = []
    searched = text[start : end if end >= 0 else None]
    for place in re.finditer(r"(?<=\S)(?=\s|\Z)|(?=[)\]_/.])", searched):
        at = start + place.end()
        inner = text[start + 2 : at]
        rest = text[at:]
        if rest[:1] in ("_", "/", ".") and inner not in names:
            continue
        if not inner.strip() or inner.count("(") != inner.count(")"):
            continue
        if rest[:1] in (")", "]"):
            rest = rest[1:]
        ways.append(f"{text[:at]}}}{rest}")
    yield from ways[-_MAX_PLACES:]


def _with_signs(expression: str, names: set[str], *, is_condition: bool) -> str:
    """Return an expression with the signs that Python has, outside of texts in quotes."""
    pieces = _TEXT_IN_QUOTES.split(expression)
    for index in range(0, len(pieces), 2):
        piece = pieces[index]
        for sign, meant in _SIGNS.items():
            piece = piece.replace(sign, meant)
        if is_condition:
            piece = _SINGLE_EQUALS.sub("==", piece)
        if names.isdisjoint(("x", "X")):
            piece = _TIMES.sub(" * ", piece)
        pieces[index] = piece
    return "".join(pieces)
