"""What robots have under other arguments of xacro than those under which they are expanded."""

import re
from collections.abc import Iterator
from functools import lru_cache

from grader.ros.workspace.workspace import Workspace

_TAG = re.compile(
    r"<(?P<end>/?)xacro:(?:if|unless)\b|<(?P<tag>command_interface|joint|link)\b[^>]*?"
    r"\bname\s*=\s*(?P<quote>[\"'])(?P<name>.*?)(?P=quote)",
    re.DOTALL,
)


def may_be_offered(workspace: Workspace, interface: str) -> bool:
    """Return whether joints may have a command interface under other arguments: one whose name is
    computed, or that stands under a condition.
    """
    names = _chosen(workspace, "command_interface")
    return interface in names or any("$" in name for name in names)


@lru_cache(maxsize=8)
def _chosen(workspace: Workspace, tag: str) -> frozenset[str]:
    """Return the names in elements with a tag that are computed, or stand under a condition."""
    names: set[str] = set()
    for source in workspace.xacro_sources:
        names |= {name for found, name in _chosen_in(source.text) if found == tag}
    return frozenset(names)


def _chosen_in(text: str) -> Iterator[tuple[str, str]]:
    depth = 0
    for match in _TAG.finditer(text):
        if match["tag"] is None:
            depth += -1 if match["end"] else 1
        elif depth or "$" in match["name"]:
            yield match["tag"], match["name"]
