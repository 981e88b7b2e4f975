"""Paths that programs, launch files and xacro make of variables, as patterns that files match."""

import posixpath
import re
from collections.abc import Iterator

from grader.base.source import Source
from grader.ros.python.made_texts import UNKNOWN, made_texts
from grader.ros.python.parse import Code, parse

_SUBSTITUTION = re.compile(r"\$\((?:[^()]|\([^()]*\))*\)|\$\{[^{}]*\}|\$ENV\{\w+\}|\$\w+")
_MADE = re.compile(r"[^\s\"'<>,;:=()\[\]{}]*\0[^\s\"'<>,;=()\[\]{}]*")
_END_IN_CPP = re.compile(r"\"([_.-][\w.-]*)\"")
_CPP = (".cpp", ".hpp", ".cc", ".h")
_QUOTE = re.compile("[\"']")


def made_paths(source: Source) -> Iterator[re.Pattern[str]]:
    """Yield patterns for the ends of the paths that a text makes of variables, which are matched
    with whole paths.
    """
    if source.path.endswith(".py"):
        code = parse(source.text.encode(), source.path)
        made = set(made_texts(code)) if isinstance(code, Code) else set()
    elif source.path.endswith(_CPP):
        made = {UNKNOWN + end for end in _END_IN_CPP.findall(source.text)}
    else:
        made = set(_MADE.findall(_SUBSTITUTION.sub(UNKNOWN, source.text)))
    for path in sorted(made):
        pattern = _pattern(path)
        if pattern:
            yield re.compile(rf"(?:.*/)?{pattern}")


def _pattern(path: str) -> str:
    """Return the last part of a path as a pattern, with its folder where the part says little."""
    folder, name = posixpath.split(_QUOTE.sub("", path).strip())
    folder = posixpath.basename(folder)
    stem, _, _ = name.partition(".")
    if UNKNOWN not in name or (not stem.strip(UNKNOWN) and (not folder or UNKNOWN in folder)):
        return ""
    written = name if stem.strip(UNKNOWN) else f"{folder}/{name}"
    return ".*".join(re.escape(part) for part in written.split(UNKNOWN))
