"""Paths that programs, launch files and xacro make of variables, which files may have."""

import posixpath
from collections.abc import Iterator

from grader.base.grouping import Strings
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Source
from grader.ros.python.made_texts import UNKNOWN, made_texts
from grader.ros.python.parse import Code, parse

_SUBSTITUTION = on_use(r"\$\((?:[^()]|\([^()]*\))*\)|\$\{[^{}]*\}|\$ENV\{\w+\}|\$\w+")
_WORD = on_use(r"[^\s\"'<>,;=()\[\]{}]+")
_END_IN_CPP = on_use(r"\"([_.-][\w.-]*)\"")
_CPP = (".cpp", ".hpp", ".cc", ".h")
_QUOTE = on_use("[\"']")


class MadePath(Named):
    """The end of a path that a text makes of variables: what is written, around unknown parts."""

    pieces: Strings

    def matches(self, path: str) -> bool:
        """Return whether a whole path may end so.

        The pieces stand in it one after the other, from the start of a name to the end.
        """
        first, *middle, last = self.pieces
        at = 0 if path.startswith(first) else path.find(f"/{first}") + 1
        if not path.startswith(first, at):
            return False
        at += len(first)
        for piece in middle:
            at = path.find(piece, at)
            if at < 0:
                return False
            at += len(piece)
        return path.endswith(last) and len(path) - len(last) >= at


def made_paths(source: Source) -> Iterator[MadePath]:
    """Yield the ends of the paths that a text makes of variables."""
    if source.path.endswith(".py"):
        code = parse(source.text.encode(), source.path)
        made = set(made_texts(code)) if isinstance(code, Code) else set()
    elif source.path.endswith(_CPP):
        made = {UNKNOWN + end for end in _END_IN_CPP.findall(source.text)}
    else:
        made = set(_made_in(_SUBSTITUTION.sub(UNKNOWN, source.text)))
    for path in sorted(made):
        end = _read_end(path)
        if UNKNOWN in end:
            yield MadePath(tuple(end.split(UNKNOWN)))


def _made_in(text: str) -> Iterator[str]:
    """Yield the words of a text that have an unknown part; what is before a colon is none of it."""
    for word in _WORD.findall(text):
        before, unknown, after = word.partition(UNKNOWN)
        if unknown:
            yield before.rpartition(":")[2] + unknown + after


def _read_end(path: str) -> str:
    """Return the last part of a path, with its folder where the part says little."""
    folder, name = posixpath.split(_QUOTE.sub("", path).strip())
    folder = posixpath.basename(folder)
    stem, _, _ = name.partition(".")
    if UNKNOWN not in name or (not stem.strip(UNKNOWN) and (not folder or UNKNOWN in folder)):
        return ""
    return name if stem.strip(UNKNOWN) else f"{folder}/{name}"
