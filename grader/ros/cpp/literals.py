"""The values of literals of C++: texts, numbers, booleans and durations."""

import re
from collections.abc import Mapping

from grader.base.patterns import on_use
from grader.ros.cpp.syntax import CppNode

TEXTS = ("string_literal", "raw_string_literal")
NUMBERS = ("number_literal", "true", "false")
_RAW = on_use(r'(?:u8|[uUL])?R"([^()\\\s]{0,16})\((.*)\)\1"', re.DOTALL)
_ESCAPE = on_use(
    rb"\\(?:\r?\n|([0-7]{1,3})|x([0-9A-Fa-f]+)|u([0-9A-Fa-f]{4})|U([0-9A-Fa-f]{8})|(.))", re.DOTALL
)
_PLAIN = {b"n": b"\n", b"t": b"\t", b"r": b"\r", b"a": b"\a", b"b": b"\b", b"f": b"\f", b"v": b"\v"}
_INTEGER = on_use(r"(0[xX][0-9A-Fa-f]+|0[bB][01]+|[0-9]+)(?:[uU]?(?:ll|LL|[lLzZ])?[uU]?)")
_FLOATING = on_use(
    r"((?:[0-9]+\.[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?|[0-9]+[eE][+-]?[0-9]+)[fFlL]?"
)
# Seconds in a unit of std::chrono, by the endings of its literals.
SECONDS: Mapping[str, float] = {
    "ns": 1e-9,
    "us": 1e-6,
    "ms": 1e-3,
    "s": 1.0,
    "min": 60.0,
    "h": 3600.0,
}
_MAX_DIGITS = 40


def text_of_literal(node: CppNode) -> str | None:
    """Return the text of a string literal; None where it is broken."""
    written = node.text
    raw = _RAW.fullmatch(written)
    if raw:
        return raw[2].replace("\r\n", "\n")
    start = written.find('"')
    end = len(written) - 1
    if start < 0 or end <= start or written[end] != '"':
        return None
    inside = written[start + 1 : end].encode("utf-8", "replace")
    return _ESCAPE.sub(_unescaped, inside).decode("utf-8", "replace")


def _unescaped(match: re.Match[bytes]) -> bytes:
    octal, byte, short, long, plain = match.groups()
    if octal is not None:
        return bytes([int(octal, 8) % 256])
    if byte is not None:
        return bytes([int(byte[-2:], 16)])
    code = short or long
    if code is not None:
        number = int(code, 16)
        is_character = number < 0x110000 and not 0xD800 <= number < 0xE000
        return chr(number).encode() if is_character else b"?"
    if plain is not None:
        return _PLAIN.get(plain, plain)
    return b""  # the end of a line


def number_of_literal(text: str) -> int | float | bool | None:
    """Return the value of a number, `true` or `false`; None for one that is not known."""
    if text in ("true", "false"):
        return text == "true"
    digits = text.replace("'", "")
    if digits.startswith("-"):
        number = number_of_literal(digits[1:])
        return -number if isinstance(number, int | float) else None
    if len(digits) > _MAX_DIGITS:
        return None
    whole = _INTEGER.fullmatch(digits)
    if whole:
        written = whole[1]
        is_octal = len(written) > 1 and written.isdigit() and written.startswith("0")
        try:
            return int(written, 8) if is_octal else int(written, 0)
        except ValueError:
            return None
    floating = _FLOATING.fullmatch(digits)
    return float(floating[1]) if floating else None
