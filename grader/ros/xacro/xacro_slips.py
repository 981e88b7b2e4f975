"""The slips of a xacro file that xacro expands all the same.

These are tags that lack their prefix, which it leaves and ROS 2 ignores.
"""

from collections.abc import Iterable, Mapping
from itertools import chain, islice
from typing import NamedTuple

from grader.base.element_edits import tag_edits
from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips
from grader.ros.xacro.expansion import ExpandedSource
from grader.ros.xacro.xacro_nodes import XacroNode, walk
from grader.ros.xml.urdf_format import CHILDREN

_MAX_NODES = 2000
_DEFAULT = on_use(r":?=.*")
# The attributes of xacro's own tags, by which a tag without the prefix is known.
_OWN_TAGS = {
    "include": {"filename"},
    "property": {"name", "value"},
    "arg": {"name", "default"},
    "macro": {"name", "params"},
    "if": {"value"},
    "unless": {"value"},
}


class _Call(NamedTuple):
    """What a call of a macro gives."""

    needed: frozenset[str]
    known: frozenset[str]
    blocks: int  # how many elements


def xacro_slips(source: ExpandedSource) -> Slips:
    """Yield the tags that surely are calls of macros, or xacro's own, in the order of the files.

    A tag is a call if it gives all parameters that a macro needs and no others, and if it stands
    where a call may stand.
    """
    roots = list(source.documents.values())
    calls = _calls(roots)
    for root in roots:
        waiting = [root]
        while waiting:
            node = waiting.pop()
            for child in node.elements:
                if ":" not in child.tag and _is_xacro(child, calls):
                    yield _with_prefix(child)
            waiting += [child for child in node.elements if child.tag.startswith("xacro:")]


def _calls(roots: Iterable[XacroNode]) -> Mapping[str, _Call]:
    """Return what the call of each macro gives."""
    calls = {}
    for node in chain.from_iterable(islice(walk(root), _MAX_NODES) for root in roots):
        if node.tag == "xacro:macro":
            words = node.attributes.get("params", "").split()
            values = [word for word in words if not word.startswith("*")]
            needed = frozenset(word for word in values if word.isidentifier())
            known = frozenset(_DEFAULT.sub("", word) for word in values)
            name = node.attributes.get("name", "").removeprefix("xacro:")
            calls[name] = _Call(needed, known, len(words) - len(values))
    return calls


def _is_xacro(node: XacroNode, calls: Mapping[str, _Call]) -> bool:
    """Return whether an element without a prefix is surely meant for xacro."""
    if node.tag in CHILDREN["robot"]:
        return False
    given = node.attributes.keys()
    if node.tag in _OWN_TAGS:
        return given == _OWN_TAGS[node.tag]
    call = calls.get(node.tag)
    if not call or len(list(node.elements)) != call.blocks:
        return False
    return call.needed <= given <= call.known


def _with_prefix(node: XacroNode) -> Slip:
    edits = tag_edits(*node.place.written, node.tag, f"xacro:{node.tag}")
    reaction = f"xacro leaves <{node.tag}>, which lacks its prefix, and ROS 2 ignores it"
    assumption = f"<{node.tag}> is read as <xacro:{node.tag}>"
    return Slip(edits, reaction, assumption, node.place.at())
