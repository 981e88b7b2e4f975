"""The attributes of xacro's own tags that have another name, and values of calls without a name."""

from collections.abc import Iterator, Mapping

from grader.base import markup
from grader.base.names import near
from grader.base.slips import Slip
from grader.ros.slips.nodes import place_of
from grader.ros.xacro.xacro_nodes import XacroNode, walk

# The attributes that a tag of xacro has where it is written in full, and others that it may have.
_USUAL: Mapping[str, tuple[str, ...]] = {
    "xacro:property": ("name", "value"),
    "xacro:macro": ("name", "params"),
    "xacro:insert_block": ("name",),
    "xacro:if": ("value",),
    "xacro:unless": ("value",),
    "xacro:arg": ("name", "default"),
    "xacro:include": ("filename",),
    "xacro:attribute": ("name", "value"),
}
_OTHERS: Mapping[str, tuple[str, ...]] = {
    "xacro:property": ("default", "remove", "scope", "lazy_eval"),
    "xacro:include": ("ns", "optional"),
}


def attribute_slips(root: XacroNode) -> Iterator[Slip]:
    """Yield the attributes of xacro's tags that can only be another one: param= for params=.

    An attribute that xacro does not have is the one that the tag usually has and lacks.
    """
    for node in walk(root):
        usual = _USUAL.get(node.tag, ())
        known = (*usual, *_OTHERS.get(node.tag, ()))
        unknown = [name for name in node.attributes if name not in known and ":" not in name]
        lacking = [name for name in usual if name not in node.attributes]
        if "default" in node.attributes and node.tag == "xacro:property":
            lacking.remove("value")
        for name in unknown if usual else ():
            meant = near(name, lacking)
            if meant is None and len(unknown) == len(lacking) == 1:
                meant = lacking[0]
            if meant is not None:
                yield from _renamed(node, name, meant)


def _renamed(node: XacroNode, name: str, meant: str) -> Iterator[Slip]:
    source, start = place_of(node)
    written = markup.attribute(source.text, start, name)
    if written is None:
        return
    text = source.text[written.start + len(name) : written.end]
    edit = source.edit(written.start, written.end, f"{meant}{text}")
    reaction = f"<{node.tag}> has no attribute {name}"
    assumption = f"the attribute {name} of <{node.tag}> is read as {meant}"
    yield Slip((edit,), reaction, assumption, source.at(written.start))
