"""What robots may have under other arguments of xacro than those under which they are expanded."""

import posixpath
import re
from collections.abc import Iterator
from functools import lru_cache

from grader.base.patterns import on_use
from grader.base.source import Source
from grader.ros.package.made_paths import made_paths
from grader.workspace.model.workspace import Workspace

_TAG = on_use(
    r"<(?P<end>/?)xacro:(?:if|unless)\b|<(?P<tag>(?:command|state)_interface|joint|link)\b[^<>]*?"
    r"\bname\s*=\s*(?P<quote>[\"'])(?P<name>.*?)(?P=quote)|\bfilename\s*=\s*[\"'](?P<file>[^\"']*)",
    re.DOTALL,
)
_XACRO_TAG = on_use(r"<xacro:(\w+)\b([^<>]*)>")  # a call of a macro, or a property
_ATTRIBUTE = on_use(r"(?<![\w.-])([\w.-]++)\s*+=\s*(?:\"([^\"]*)\"|'([^']*)')")
_COMPUTED = on_use(r"\$\([^()]*\)|\$\{[^{}]*\}")
_WORD = on_use(r"[A-Za-z_]\w*")
_MAX_STEPS = 5  # from an argument by way of properties and parameters of macros


def may_be_offered(workspace: Workspace, interface: str, tag: str = "command_interface") -> bool:
    """Return whether joints may have an interface of a tag under other arguments."""
    names = names_under_arguments(workspace, tag)
    return interface in names or "*" in names


@lru_cache(maxsize=4)
def may_vary(workspace: Workspace, *tags: str) -> bool:
    """Return whether joints, or elements of some tags, may be others under other arguments."""
    sources = workspace.robots.xacro_sources
    if not any("$(arg" in source.text for source in sources):
        return False
    if names_under_arguments(workspace, "joint"):
        return True
    dependent = _dependent(sources)
    element = re.compile(rf"<(?:{'|'.join(tags)})\b[^<>]*>")
    for source in sources:
        for tag in element.finditer(source.text):
            if not dependent.isdisjoint(_computing_words(tag[0])):
                return True
    return False


@lru_cache(maxsize=4)
def names_under_arguments(workspace: Workspace, tag: str) -> frozenset[str]:
    """Return the names in elements of xacro that depend on arguments.

    They stand under a condition, stand in a file that an argument chooses, or have arguments as a
    part; with * for what is computed.
    """
    sources = workspace.robots.xacro_sources
    if not any("$(arg" in source.text for source in sources):
        return frozenset()
    dependent = _dependent(sources)
    chosen = _chosen_files(sources, workspace.robots.files)
    names = set()
    for source in sources:
        is_chosen = source.path in chosen
        for match, depth in _matches(source.text):
            name = match["name"] or ""
            is_computed = not dependent.isdisjoint(_computing_words(name))
            if match["tag"] == tag and (depth or is_chosen or is_computed):
                names.add(_COMPUTED.sub("*", name))
    return frozenset(names)


def _matches(text: str) -> Iterator[tuple[re.Match[str], int]]:
    """Yield names of elements and of files, each with the number of conditions around it."""
    depth = 0
    for match in _TAG.finditer(text):
        if match["tag"] is not None or match["file"] is not None:
            yield match, depth
        else:
            depth += -1 if match["end"] else 1


def _computing_words(text: str) -> frozenset[str]:
    """Return the words in the expressions of a text, among which are the names that it needs."""
    return frozenset(_WORD.findall(" ".join(_COMPUTED.findall(text))))


def _dependent(sources: tuple[Source, ...]) -> frozenset[str]:
    """Return the properties and parameters of macros that arguments may give a value.

    The name `arg` stands for the arguments themselves.
    """
    given = []  # names, with the words of their values
    for source in sources:
        for tag, attributes in _XACRO_TAG.findall(source.text):
            values = {
                name: first or second for name, first, second in _ATTRIBUTE.findall(attributes)
            }
            if tag == "property":
                values = {values.get("name", ""): values.get("value", "")}
            for name, value in values.items():
                given.append((name, _computing_words(value)))
    names = {"arg"}
    for _ in range(_MAX_STEPS):
        names |= {name for name, words in given if not names.isdisjoint(words)}
    return frozenset(names)


def _chosen_files(sources: tuple[Source, ...], robot_files: frozenset[str]) -> set[str]:
    """Return the files that an include under a condition names, or one whose path is computed."""
    named = set()
    made = set()
    for source in sources:
        made |= {*made_paths(source)}
        named |= {
            posixpath.basename(match["file"])
            for match, depth in _matches(source.text)
            if depth and match["file"]
        }
    chosen = set()
    for path in {source.path for source in sources} - robot_files:
        is_named = posixpath.basename(path) in named
        if is_named or any(end.matches(path) for end in made):
            chosen.add(path)
    return chosen
