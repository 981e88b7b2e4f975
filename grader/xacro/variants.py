"""Small changes of the text of an expression, as in mistakes: a sign, an operator, a name, a half, a number."""

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.names import closest

EXPRESSION = re.compile(r"\$\{([^}]*)\}")
NAME = re.compile(r"(?<![\w.])[^\W\d]\w*(?![\w.(])")
_PLAIN = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*")
_NUMBER = re.compile(r"(?<![\w.])(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")
_OPERATOR = re.compile(r"(?<=[\w.)\s])(?<!\*)[-+*/](?![*/])")
_OTHER = {"+": "-", "-": "+", "*": "/", "/": "*"}
_DIVIDED = re.compile(r"/\s*[\d.]+\Z")
_TERM = re.compile(r"[\w.]+")
TOKEN = re.compile(r"(?:\$\{[^}]*\}|\$\([^)]*\)|[^\s$]|\$)+")
SINGLE = re.compile(r"\s*\$(?:\{\s*(?:[^\W\d]\w*)\s*\}|\(arg\s+[^\s()]+\s*\))\s*")
ARGUMENT = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_LOOSE = re.compile(r"(?<!\$)\{(\w+)\}|\$\((\w+)\)|\$(?=\w)(\w+)")
_WORD = re.compile(r"(?<![\w${.(])[^\W\d]\w*(?![\w(])")
_MAX_VARIANTS = 80  # of one text
SPELLING, SIGN, NUMBER, OPERATOR, HALF, FACTOR, OTHER_NUMBER, OTHER_NAME = range(
    8
)  # kinds of changes, the most plausible first


class Slot(NamedTuple):
    """A number in a text: its offsets, and its value."""

    start: int
    end: int
    value: float


def numbers(text: str) -> list[Slot]:
    """Return the numbers in the expressions of a text; the text itself, if it is one."""
    plain = _PLAIN.fullmatch(text)
    if plain is not None:
        return [Slot(plain.start(1), plain.end(1), float(plain[1]))]
    inside = ((found.start(1), found.end(1)) for found in EXPRESSION.finditer(text))
    slots = (number for start, end in inside for number in _NUMBER.finditer(text, start, end))
    return [Slot(number.start(), number.end(), float(number[0])) for number in slots]


def with_number(text: str, slot: Slot, number: str) -> str:
    """Return a text with another number, in parentheses where its sign would follow another one."""
    before = text[: slot.start].rstrip()[-1:]
    shown = f"({number})" if number.startswith("-") and before in ("-", "+", "*") else number
    return f"{text[: slot.start]}{shown}{text[slot.end :]}"


def variants(text: str, names: Sequence[str], own: Sequence[str]) -> Iterator[tuple[int, str]]:
    """Yield texts with one change of an expression, each with its rank: the smaller, the more plausible.

    `names` are known at this place; `own` are the parameters of the macro around it.
    """
    if _LOOSE.search(text):  # {side}, $(side) and $side
        yield SPELLING, _LOOSE.sub(lambda found: f"${{{found[1] or found[2] or found[3]}}}", text)
    if text.count("${") > text.count("}"):
        yield from (
            (SPELLING, f"{text[:end]}}}{text[end:]}")
            for end in (found.end() for found in re.finditer(r"[\w)](?=\s|\Z)", text))
        )
    for found in _WORD.finditer(text) if "${" not in text else ():  # the name of a parameter, not its value
        yield from (
            (SPELLING, f"{text[: found.start()]}${{{name}}}{text[found.end() :]}") for name in own if name == found[0]
        )
    for found in EXPRESSION.finditer(text):
        start, end = found.span(1)
        for _, (rank, inner) in zip(range(_MAX_VARIANTS), _of_expression(found[1], names, own), strict=False):
            yield rank, f"{text[:start]}{inner}{text[end:]}"
    if _PLAIN.fullmatch(text):
        number = text.strip()
        for sign in own:
            for magnitude in (number.lstrip("+-"), number):
                yield FACTOR, f"${{{sign}*{magnitude}}}"


def _of_expression(text: str, names: Sequence[str], own: Sequence[str]) -> Iterator[tuple[int, str]]:
    stripped = text.strip()
    whole = stripped if _TERM.fullmatch(stripped) else f"({stripped})"
    if stripped.startswith("-"):
        yield SIGN, stripped[1:].lstrip()
    yield SIGN, f"-{stripped.removeprefix('+')}"
    yield SIGN, f"-{whole}"
    for found in _OPERATOR.finditer(text):
        yield OPERATOR, f"{text[: found.start()]}{_OTHER[found[0]]}{text[found.end() :]}"
    for inner in re.finditer(r"(?<!\w)\(([^()]*)\)", text):
        yield OPERATOR, f"{text[: inner.start()]}{inner[1]}{text[inner.end() :]}"
    for gap in re.finditer(r"(?<=[\w)])\s+(?=[\w(])", text):
        yield from ((OPERATOR, f"{text[: gap.start()]} {sign} {text[gap.end() :]}") for sign in "+-*/")
    for factor in (*own, "radians"):
        yield from ((FACTOR, without) for without in _without(rf"\b{factor}\s*\*\s*", text))
        yield FACTOR, f"radians({stripped})" if factor == "radians" else f"{factor}*{whole}"
    if not _DIVIDED.search(stripped):
        yield HALF, f"{stripped}/2"
        yield HALF, f"{whole}/2"
    yield from ((HALF, without) for without in _without(r"\s*/\s*2(?![\w.])", text))
    yield HALF, f"2*{whole}"
    for found in NAME.finditer(text):
        for name in sorted(names, key=lambda name: name != closest(found[0], names)):
            if name != found[0]:
                yield OTHER_NAME, f"{text[: found.start()]}{name}{text[found.end() :]}"


def _without(pattern: str, text: str) -> Iterator[str]:
    """Yield a text without each of the parts that match."""
    for found in re.finditer(pattern, text):
        yield text[: found.start()] + text[found.end() :]
