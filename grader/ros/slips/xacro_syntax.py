"""The expressions of xacro whose syntax can be read in one way only."""

import re
from collections.abc import Iterator

from grader.base import markup
from grader.base.markup import WORD_OF_VALUE
from grader.base.slips import Slip
from grader.base.source import Source
from grader.base.text import cut
from grader.ros.slips.nodes import find_place
from grader.ros.xacro.xacro_nodes import XacroNode, walk
from grader.ros.xml.urdf_format import PARTS

_MAX_LENGTH = 500  # characters of a value
_MAX_PLACES = 8  # where a brace may be missing
_MAX_SHOWN = 60
_EXPRESSION = re.compile(r"\$\{([^}$]*)\}")
_COMMANDS = r"(?:find|arg|env|optenv|eval|dirname|cwd|anon)\b"
# $(a / 4) with an operator, and $[a / 4]: what is in them is no substitution.
_IN_PARENTHESES = re.compile(rf"\$\((?!\s*{_COMMANDS})((?:[^()$]|\([^()$]*\))*)\)")
_IN_BRACKETS = re.compile(r"\$\[([^\[\]$]*)\]")
# ${{a}} and ${a}}, and {a / 4} or $ {a / 4} with a name that is known.
_MIXED = re.compile(r"\$\(((?:[^()${}]|\([^()${}]*\))*)\}")  # $(a / 4}
_BARE = re.compile(r"(?:\$(?!\())?\s*+((?=[^*/+-]*+[*/+-])[\w\s.+*/()-]++)")  # a / 4, $a / 4
_IN_BRACES = re.compile(r"\$\{\{?([^{}$]*)\}\}")
_WITHOUT_DOLLAR = re.compile(r"(?<![${])(?:\$\s+)?\{([^{}$]*)\}")
_OPERATOR = re.compile(r"[-+*/%<>=]|\b(?:and|or|not|if)\b")
_WORDS = re.compile(r"\b[^\W\d]\w*")
_TEXT_IN_QUOTES = re.compile(r"('[^']*'|\"[^\"]*\")")
_SINGLE_EQUALS = re.compile(r"(?<![=!<>])=(?!=)")
_TIMES = re.compile(
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
        source, start = find_place(node)
        for attribute in markup.attributes(source.text, start):
            text = source.text[slice(*attribute.value)]
            if len(text) > _MAX_LENGTH:
                continue
            ways: list[str] = []
            bare = _BARE.fullmatch(text)
            if "$" in text or "{" in text:
                is_condition = node.tag in ("xacro:if", "xacro:unless")
                ways += _read_text(text, names, attribute.name, is_condition=is_condition)
            if bare is not None and not ways and _is_number(node, attribute.name):
                ways += [f"${{{bare[1]}}}"] if names.issuperset(_WORDS.findall(bare[1])) else []
            slips = tuple(_slip(source, attribute, text, new) for new in dict.fromkeys(ways))
            if slips:
                yield slips


def _slip(source: Source, attribute: markup.Attribute, text: str, new: str) -> Slip:
    start, end = attribute.start, attribute.end
    head = source.text[start : attribute.value_start]
    tail = source.text[attribute.value_end : end]
    edit = source.edit(start, end, f"{head}{new}{tail}")
    reaction = f"xacro cannot read {cut(text, _MAX_SHOWN)}"
    assumption = f"{cut(text, _MAX_SHOWN)} is read as {cut(new, _MAX_SHOWN)}"
    return Slip((edit,), reaction, assumption, source.at(start))


def list_names(root: XacroNode) -> set[str]:
    """Return the names of properties and of parameters that a file has."""
    names: set[str] = set()
    for node in walk(root):
        if node.tag == "xacro:property":
            names.add(node.attributes.get("name", ""))
        elif node.tag == "xacro:macro":
            names.update(_WORDS.findall(node.attributes.get("params", "")))
    return names


def _read_text(text: str, names: set[str], attribute: str, *, is_condition: bool) -> Iterator[str]:
    """Yield the ways to read a value whose expressions xacro cannot read."""
    if "${" in _EXPRESSION.sub("", text):  # an expression has no } at its end
        yield from _with_brace(text, attribute, names)
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


def _with_brace(text: str, attribute: str, names: set[str]) -> Iterator[str]:
    """Yield a text with the } that an expression lacks in each place where it can be.

    With it, an attribute has as many numbers as its format says, if any place is such. A ) or ]
    without its opening one stands for it.
    """
    start = _EXPRESSION.sub(lambda match: " " * len(match[0]), text).index("${")
    end = text.find("$", start + 2)
    end = end if end >= 0 else len(text)
    count = len(PARTS.get(attribute, ()))
    ways: list[str] = []
    counted: list[str] = []
    for place in re.finditer(r"(?<=\S)(?=\s|\Z)|(?=[)\]_/.])", text[start:end]):
        at = start + place.end()
        inner = text[start + 2 : at]
        rest = text[at:]
        if rest[:1] in ("_", "/", ".") and inner not in names:
            continue
        if not inner.strip() or inner.count("(") != inner.count(")"):
            continue
        if rest[:1] in (")", "]"):
            rest = rest[1:]
        new = f"{text[:at]}}}{rest}"
        ways.append(new)
        if len(WORD_OF_VALUE.findall(new)) == count:
            counted.append(new)
    yield from (counted or ways)[-_MAX_PLACES:]


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
