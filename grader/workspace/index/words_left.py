"""Words in files that may be a name, although no reader says what they are.

A rename asks whether a file keeps the old word: then it is not certain that every use is known.
"""

import re
from collections.abc import Collection, Iterable, Iterator
from fnmatch import fnmatchcase
from typing import NamedTuple

from grader.base.patterns import on_use
from grader.base.source import Location, SourceOf
from grader.workspace.index.written_names import WrittenName
from grader.workspace.model.text_files import CODE_ENDINGS
from grader.workspace.model.workspace import Workspace

_STRING = r"\"(?:[^\"\\\n]|\\.)*+\"|'(?:[^'\\\n]|\\.)*+'"
# What a text of Python or C++ surely is no link, joint, topic or node by.
_KEYWORD = r"\b(?:package|plugin|executable|exec|pkg|output|prefix|type|help|description)\s*+=\s*+"
_PYTHON = on_use(
    rf"#[^\n]*+|(?s:\"\"\".*?\"\"\"|'''.*?''')|{_KEYWORD}[^\n]|(?P<text>{_STRING})", re.DOTALL
)
_CPP = on_use(rf"//[^\n]*+|(?s:/\*.*?(?:\*/|\Z))|#include[^\n]*+|(?P<text>{_STRING})")
_YAML = on_use(
    rf"(?<!\S)#[^\n]*+|(?P<text>{_STRING}|[^\s,\[\]{{}}\"'#:][^\s,\[\]{{}}\"':]*+)(?P<colon>\s*+:(?=\s))?"
)
_ATTRIBUTES = "link|joint|reference|link1|link2|(?:parent|child|base|tip)_link|from|to|topic|value"
_XML = on_use(
    rf"(?s:<!--.*?(?:-->|\Z))|\s(?:{_ATTRIBUTES})\s*+=\s*+(?P<text>{_STRING})|>\s*+(?P<content>[^\s<>][^<>]*+)(?=<)"
)
_LANGUAGES = {
    (".py",): _PYTHON,
    (".cpp", ".cc", ".cxx", ".hpp", ".hh", ".h"): _CPP,
    (".yaml", ".yml", ".rviz"): _YAML,
    (".urdf", ".xacro", ".srdf", ".sdf", ".world", ".launch", ".xml"): _XML,
}
_WITHOUT_NAMES = ("setup.py", "package.xml", "plugins.xml")
_INSERTED = on_use(r"\{[^{}]*+\}")
_NAME = on_use(rf"(?:[\w~/.-]++|{_INSERTED.pattern})++")
_MIN_LETTERS = 3  # of a name that an f-string makes
_KEYS = ("controller", "node", "parameter")  # kinds that may be a key of YAML
_EVERY_NODE = "/**"  # a section of a parameter file
_MAX_YAML = 512 * 1024  # bytes


class _WrittenText(NamedTuple):
    """A text in a file, from one offset to another."""

    start: int
    text: str
    is_key: bool = False


def words_left(
    paths: Iterable[str],
    source_of: SourceOf,
    named: WrittenName,
) -> Iterator[Location]:
    """Yield where files have a name as a whole text, or as a part of one with slashes."""
    name = named.name
    for path in paths:
        if path.endswith(_WITHOUT_NAMES):
            continue
        for endings, pattern in _LANGUAGES.items():
            source = source_of(path) if path.endswith(endings) else None
            if not source or (name not in source.text and "{" not in source.text):
                continue
            for word in _words(pattern, source.text):
                if word.is_key and named.kind not in _KEYS:
                    continue
                at = _place_in(word.text, name)
                if at >= 0:
                    yield source.at(word.start + at)


def files_for_parameters(workspace: Workspace, packages: Collection[str]) -> Iterator[str]:
    """Yield the files that may name a parameter of the nodes of some packages.

    These are the code of the packages, and parameter files with a section for every node.
    """
    for package in workspace.packages:
        for path in package.tree.files:
            if path.endswith(CODE_ENDINGS) and path not in package.launch_files:
                if package.name in packages:
                    yield package.path(path)
            elif path.endswith((".yaml", ".yml")):
                data = package.tree.read(path, _MAX_YAML)
                if data is not None and _EVERY_NODE.encode() in data:
                    yield package.path(path)


def _words(pattern: re.Pattern[str], text: str) -> Iterator[_WrittenText]:
    for match in pattern.finditer(text):
        groups = match.groupdict()
        written = groups["text"]
        if written is not None:
            quotes = int(written[0] in "\"'")
            inner = written[quotes : len(written) - quotes]
            yield _WrittenText(match.start("text") + quotes, inner, bool(groups.get("colon")))
        elif groups.get("content"):
            yield _WrittenText(match.start("content"), groups["content"].rstrip())


def _place_in(text: str, name: str) -> int:
    """Return where a text has a name between slashes; -1 where it has it nowhere."""
    if not _NAME.fullmatch(text):
        return -1
    start = 0
    for part in text.split("/"):
        if part == name or ("{" in part and _may_make(part, name)):
            return start
        start += len(part) + 1
    return -1


def _may_make(part: str, name: str) -> bool:
    """Return whether a part of an f-string may make a name: one that says something of it."""
    pattern = _INSERTED.sub("*", part)
    if len(pattern.replace("*", "")) < _MIN_LETTERS:
        return False
    return fnmatchcase(name, pattern)
