"""The text of code without what it does not do: its comments and texts."""

import posixpath
import re

from grader.base.patterns import on_use

_PYTHON = on_use(
    r'#[^\n]*|"""(?:[^"\\]|\\.|"(?!""))*+(?:"""|\Z)|"(?:[^"\\\n]|\\.)*+"?'
    r"|'''(?:[^'\\]|\\.|'(?!''))*+(?:'''|\Z)|'(?:[^'\\\n]|\\.)*+'?",
    re.DOTALL,
)
_CPP = on_use(  # a number comes before what may be a text: 10'000
    r"\b[0-9](?:'?[\w.])*+|"
    r'//[^\n]*|/\*(?:[^*]|\*(?!/))*+(?:\*/|\Z)|"(?:[^"\\\n]|\\.)*+"?|\'(?:[^\'\\\n]|\\.)*+\'?',
    re.DOTALL,
)
_FILLED = on_use(r"\{[^{}]*+\}|(\S)")


def code_alone(text: str, path: str) -> str:
    """Return code with blanks in place of its comments and texts, so that places stay the same.

    What a text of Python is filled with by its f"{name}" is code.
    """
    is_python = path.endswith(".py") or is_script(path)
    return (_PYTHON if is_python else _CPP).sub(_blank, text)


def is_script(path: str) -> bool:
    """Return whether a file of code is a program without an ending, which only Python has."""
    return "." not in posixpath.basename(path)


def _blank(match: re.Match[str]) -> str:
    written = match[0]
    start = match.start()
    if written[0].isdigit():
        return written
    if written[0] in "\"'" and "f" in match.string[max(start - 2, 0) : start].lower():
        return _FILLED.sub(lambda part: " " if part[1] else part[0], written)
    return re.sub(r"\S", " ", written)
