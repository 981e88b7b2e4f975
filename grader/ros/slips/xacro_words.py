"""The attributes of xacro's own tags that have another name, and values of calls without a name."""

from collections.abc import Collection, Mapping

from grader.base import markup
from grader.base.element_edits import attributes_text, renamed_attribute
from grader.base.grouping import StringsByName
from grader.base.names import near
from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips, make_slip
from grader.base.source import Source
from grader.base.text import cut
from grader.ros.slips.nodes import find_place
from grader.ros.xacro.xacro_nodes import XacroNode, walk

# The attributes that a tag of xacro has where it is written in full, and others that it may have.
_USUAL = {
    "xacro:property": ("name", "value"),
    "xacro:macro": ("name", "params"),
    "xacro:insert_block": ("name",),
    "xacro:if": ("value",),
    "xacro:unless": ("value",),
    "xacro:arg": ("name", "default"),
    "xacro:include": ("filename",),
    "xacro:attribute": ("name", "value"),
}
_MAX_SHOWN = 60  # characters of a text
_CALL = on_use(r"<xacro:(?P<name>[\w.-]++)(?P<rest>[^<>]*+)>")
_VALUE = on_use(
    r"""(?:(?<![\w.:-])(?P<name>[\w.:-]++)[\s=:]*+|=\s*+)?(?P<quoted>"[^"]*"|'[^']*')"""
)
_OTHERS = {
    "xacro:property": ("default", "remove", "scope", "lazy_eval"),
    "xacro:include": ("ns", "optional"),
}


def attribute_slips(root: XacroNode) -> Slips:
    """Yield the attributes of xacro's tags that can only be another one: param= for params=.

    An attribute that xacro does not have is the one that the tag usually has and lacks.
    """
    for node in walk(root):
        usual = _USUAL.get(node.tag, ())
        known = usual + _OTHERS.get(node.tag, ())
        unknown = [name for name in node.attributes if name not in known and ":" not in name]
        lacking = [name for name in usual if name not in node.attributes]
        if "default" in node.attributes and node.tag == "xacro:property":
            lacking.remove("value")
        text = node.text
        if text and len(lacking) == 1 and not unknown and not node.elements:
            yield _with_attributes(node, {lacking[0]: text})
        for name in unknown if usual else ():
            meant = near(name, lacking)
            if meant is None and len(unknown) == len(lacking) == 1:
                meant = lacking[0]
            if meant is not None:
                yield _renamed(node, name, meant)


def _with_attributes(node: XacroNode, values: StringsByName) -> Slip:
    """Return the slip of a tag that has attributes as its text or as its children."""
    source, start = find_place(node)
    head = markup.head_end(source.text, start)[0]
    end = markup.element_end(source.text, start)
    given = attributes_text(values)
    edit = source.edit(start, end, f"{source.text[start : head - 1]}{given}/>")
    reaction = f"<{node.tag}> has no attribute {next(iter(values))}"
    assumption = f"what is inside of <{node.tag}> is read as{cut(given, _MAX_SHOWN)}"
    return make_slip((edit,), reaction, assumption)


def _renamed(node: XacroNode, name: str, meant: str) -> Slip:
    source, start = find_place(node)
    edits = renamed_attribute(source, start, name, meant)
    reaction = f"<{node.tag}> has no attribute {name}"
    assumption = f"the attribute {name} of <{node.tag}> is read as {meant}"
    return Slip(edits, reaction, assumption, node.place.at(name))


def nameless_slips(source: Source, macros: Mapping[str, Collection[str]]) -> Slips:
    """Yield the values without a name in calls that lack one parameter of a macro.

    `macros` has the parameters of each that have no default.
    """
    for call in _CALL.finditer(source.text):
        needed = macros.get(call["name"], ())
        given = [match["name"] for match in _VALUE.finditer(call["rest"])]
        lacking = [name for name in needed if name not in given]
        nameless = [match for match in _VALUE.finditer(call["rest"]) if not match["name"]]
        if len(nameless) == len(lacking) == 1:
            [value] = nameless
            start, end = (call.start("rest") + offset for offset in value.span())
            new = f"{lacking[0]}={value['quoted']}"
            reaction = f"a value of <xacro:{call['name']}> has no name"
            assumption = f"{value['quoted']} is read as {new}"
            edit = source.edit(start, end, new)
            yield make_slip((edit,), reaction, assumption, is_refused=True)


def child_slips(root: XacroNode, macros: Mapping[str, Collection[str]]) -> Slips:
    """Yield the calls that have parameters of a macro as elements: <y>0.1</y> for y="0.1"."""
    for node in walk(root):
        needed = macros.get(node.tag.removeprefix("xacro:"), ())
        values = _texts_of_children(node, needed) if node.tag.startswith("xacro:") else {}
        if not values or len(values) != len(node.elements):
            continue
        if node.attributes.keys().isdisjoint(values):
            yield _with_attributes(node, values)


def _texts_of_children(node: XacroNode, names: Collection[str]) -> dict[str, str]:
    """Return the texts of children with these tags that have nothing else."""
    texts = {}
    for child in node.elements:
        text = "".join(part for part in child.children if isinstance(part, str)).strip()
        if child.tag in names and text and not (child.attributes or child.elements):
            texts[child.tag] = text
    return texts


def list_macros(root: XacroNode) -> dict[str, list[str]]:
    """Return the parameters without a default of each macro in a file."""
    macros = {}
    for node in walk(root):
        if node.tag == "xacro:macro":
            words = node.attributes.get("params", "").split()
            plain = [word for word in words if word.isidentifier()]
            macros[node.attributes.get("name", "").removeprefix("xacro:")] = plain
    return macros
