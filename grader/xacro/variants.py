"""Small changes of the text of an expression, as in mistakes: a sign, an operator, a name, a half, a number."""

import re
from collections.abc import Iterator, Sequence
from itertools import combinations, islice

from grader.names import closest

EXPRESSION = re.compile(r"\$\{([^}]*)\}")
NAME = re.compile(r"(?<![\w.])[^\W\d]\w*(?![\w.(])")
_PLAIN = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*")
# -0.1 with its sign after a space or quote, or at the start; 2 without it in ${a-2}, where it may be an operator.
_NUMBER = re.compile(r"""(?:(?<![^\s'"])[-+]?|(?<![\w.]))(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])""")
TOKEN = re.compile(r"(?:\$\{[^}]*\}|\$\([^)]*\)|[^\s$]|\$)+")
ARGUMENT = re.compile(r"\$\(arg\s+([^\s()]+)\s*\)")
_LOOSE = re.compile(r"(?<!\$)\{(\w+)\}|\$\((\w+)\)|\$(?=\w)(\w+)")
_WORD = re.compile(r"(?<![\w${.(])[^\W\d]\w*(?![\w(])")
_MAX_VARIANTS = 80  # of one text
_MAX_PARTS = 4  # that are exchanged
# Kinds of changes, the most plausible first.
SPELLING, SIGN, NUMBER, OPERATOR, HALF, FACTOR, OTHER_NUMBER, OTHER_NAME = range(8)
_OPERATOR = r"(?<=[\w.)\s])(?<!\*){}(?![*/])"
_WITHOUT = r"\b{}\s*\*\s*"
# What is replaced by what in an expression; {} is each parameter of the macro around it.
_CHANGES = (
    (SIGN, r"\A\s*-\s*", ""),
    (SIGN, r"\A\s*\+?", "-"),
    (SIGN, r"\A(.*)\Z", r"-(\1)"),
    *((OPERATOR, _OPERATOR.format(re.escape(old)), new) for old, new in ("+-", "-+", "*/", "/*")),
    (OPERATOR, r"(?<!\w)\(([^()]*)\)", r"\1"),
    *((OPERATOR, r"(?<=[\w)])\s+(?=[\w(])", f" {sign} ") for sign in "+-*/"),
    (FACTOR, _WITHOUT, ""),
    (FACTOR, r"\A(.*)\Z", r"{}*(\1)"),
    (FACTOR, _WITHOUT.format("radians"), ""),
    (FACTOR, r"\A(.*)\Z", r"radians(\1)"),
    (HALF, r"\A(?!.*/\s*[\d.]+\Z).*\Z", r"\g<0>/2"),
    (HALF, r"\A(?!.*/\s*[\d.]+\Z)(.*)\Z", r"(\1)/2"),
    (HALF, r"\s*/\s*2(?![\w.])", ""),
    (HALF, r"\A(.*)\Z", r"2*(\1)"),
)


def numbers(text: str) -> list[re.Match[str]]:
    """Return the numbers in a text, those outside of expressions with their signs."""
    return list(_NUMBER.finditer(text))


def with_number(text: str, slot: re.Match[str], number: str) -> str:
    """Return a text with another number, in parentheses where its sign would follow another one."""
    before = text[: slot.start()].rstrip()[-1:]
    shown = f"({number})" if number.startswith("-") and before in ("-", "+", "*") else number
    return f"{text[: slot.start()]}{shown}{text[slot.end() :]}"


def variants(text: str, names: Sequence[str], own: Sequence[str]) -> Iterator[tuple[int, str]]:
    """Yield texts with one change of an expression, each with its rank: the smaller, the more plausible.

    `names` are known at this place; `own` are the parameters of the macro around it.
    """
    yield from ((SPELLING, other) for other in _respelt(text, own))
    parts = [*TOKEN.finditer(text)] if "$" in text else []
    for one, other in combinations(parts[:_MAX_PARTS], 2):  # x and z exchanged
        yield SIGN, text[: one.start()] + other[0] + text[one.end() : other.start()] + one[0] + text[other.end() :]
    for found in EXPRESSION.finditer(text):
        start, end = found.span(1)
        for rank, inner in islice(_of_expression(found[1].strip(), names, own), _MAX_VARIANTS):
            yield rank, f"{text[:start]}{inner}{text[end:]}"
    if _PLAIN.fullmatch(text):
        number = text.strip()
        for sign in own:
            for magnitude in (number.lstrip("+-"), number):
                yield FACTOR, f"${{{sign}*{magnitude}}}"


def _respelt(text: str, own: Sequence[str]) -> Iterator[str]:
    """Yield texts in which what may be meant as an expression is one."""
    if _LOOSE.search(text):  # {side}, $(side) and $side
        yield _LOOSE.sub(lambda found: f"${{{found[1] or found[2] or found[3]}}}", text)
    for found in re.finditer(r"(?<=[\w)])(?=\s|\Z)", text) if text.count("${") > text.count("}") else ():
        yield f"{text[: found.end()]}}}{text[found.end() :]}"
    for found in _WORD.finditer(text) if "${" not in text else ():  # the name of a parameter, not its value
        if found[0] in own:
            yield f"{text[: found.start()]}${{{found[0]}}}{text[found.end() :]}"


def _of_expression(text: str, names: Sequence[str], own: Sequence[str]) -> Iterator[tuple[int, str]]:
    for rank, pattern, new in _CHANGES:
        for factor in own if "{}" in pattern + new else [""]:
            for found in re.finditer(pattern.replace("{}", factor), text):
                other = text[: found.start()] + found.expand(new.replace("{}", factor)) + text[found.end() :]
                yield rank, re.sub(r"(?<!\w)\(([\w.]+)\)", r"\1", other)
    for found in NAME.finditer(text):
        for name in sorted(names, key=lambda name: name != closest(found[0], names)):
            if name != found[0]:
                yield OTHER_NAME, f"{text[: found.start()]}{name}{text[found.end() :]}"
