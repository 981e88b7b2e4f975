"""The transforms that the nodes of own code look up."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Literal, NamedTuple

from grader.base.patterns import on_use
from grader.base.source import Location
from grader.ros.nodes.node_facts import NodeFrame
from grader.workspace.graph.code_ends import list_frames
from grader.workspace.model.code_text import code_alone
from grader.workspace.model.text_files import CODE_ENDINGS, CPP_ENDINGS
from grader.workspace.model.workspace import Workspace

# What looks up transforms by other calls than those that are read.
_OTHER_LOOKUPS = (
    *(".transform(", "wait_for_transform"),
    *("lookup_transform)", "lookup_transform\n", "lookup_transform,"),
)
_LOOKUPS = (
    *("lookup_transform", "lookupTransform", "can_transform", "canTransform"),
    *_OTHER_LOOKUPS,
)

# What inverts a transform, a matrix or a rotation: functions of numpy, tf_transformations, tf2,
# Eigen, KDL, scipy and others, and attributes. Others whose names say so may do it.
_INVERTING = on_use(
    r"(?:[a-z]++_)?[Ii]nver(?:se|t)"
    r"(?:Times|_?(?:[Mm]atrix|[Tt]ransform(?:ation)?|[Pp]ose|[Qq]uaternion))?"
    r"|(?:[a-z]++_)?q?(?:inverse|conjugate)|transpose|p?inv|invXform"
)
_CALLED = on_use(r"\b(\w++)\s*+\(")
_DEFINED = on_use(r"\bdef\s++(?!__)\w++")
_INVERTED = on_use(
    r"(?<!self)\.(?:inverse|conjugate|transpose|T)\b(?!\s*+=[^=])|\binverse\s*+=\s*+True\b"
)
# A name of an inverse or of what solves for one, the inverse of a matrix, a power of -1, and ~pose.
_MAY_INVERT = on_use(
    r"\b\w*?(?:[Ii]nver(?:se|t)(?!_?(?:[Kk]in|[Dd]yn))|[Tt]rans_?[Ii]nv|trinv)"
    r"|\b(?:p?inv|conj|solve)\b|\.I\b|\*\*\s*+-\s*+1\b|(?:[=(,@*]|\breturn\b)\s*+~\w"
)
# A rotation of coordinates without a library: what a sine and a cosine are multiplied with or
# assigned to. Half an angle is a quaternion's.
_ROTATES = {
    name: re.compile(rf"[*=,\[+-]\s*+(?:[a-z]++(?:\.|::))?{name}\(([^()\n]*+)\)")
    for name in ("sin", "cos")
}
_FACTOR = {name: re.compile(rf"\b{name}\(([^()\n]*+)\)\s*+\*") for name in ("sin", "cos")}
# The conjugate of a quaternion, a cross product or a matrix, without a library.
_CONJUGATES = on_use(
    r"[=(,\[]\s*+-[\w.]*\.[xyz]\b|\b(?:cross|complex)\(|\.([xyz])\s*+\*\s*+\w++\.(?!\1)[xyzw]\b"
)
_HALF = on_use(r"/\s*+2|0\.5|half")
_Inverting = Literal["no", "perhaps", "yes"]


class _LookedUp(NamedTuple):
    """The frames of a transform that a node looks up; None for one that is not known."""

    target: str | None
    source: str | None
    node: str
    location: Location
    inverts: _Inverting = "no"  # whether the code around inverts a transform


def looked_up_transforms(workspace: Workspace) -> tuple[Sequence[_LookedUp], bool]:
    """Return the transforms that nodes look up, and whether code may look up others.

    Nodes that launch files start, or may start, come first.
    """
    lookups = list(_read_lookups(workspace))
    texts = _texts_with_lookups(workspace) if lookups else {}
    inverting = {path: _inverts(code_alone(text, path)) for path, text in texts.items()}
    # A file may leave the inversion to a function of another one.
    others: _Inverting = "perhaps" if "yes" in inverting.values() else "no"
    known = []
    for lookup in lookups:
        inverts = inverting.get(lookup.location.path, "no")
        known.append(lookup._replace(inverts=others if inverts == "no" else inverts))
    return known, _may_look_up_others(workspace, lookups)


def _texts_with_lookups(workspace: Workspace) -> Mapping[str, str]:
    """Return the texts of code by the paths of the files."""
    sources = workspace.texts.every_source(CODE_ENDINGS)
    return {source.path: source.text for source in sources}


def _inverts(code: str) -> _Inverting:
    """Return whether code inverts a transform: by a function, or perhaps number by number."""
    code = _DEFINED.sub("", code)
    called = {*_CALLED.findall(code)}
    if _INVERTED.search(code) or any(map(_INVERTING.fullmatch, called)):
        return "yes"
    if _MAY_INVERT.search(code) or _CONJUGATES.search(code):
        return "perhaps"
    for name in ("sin", "cos"):
        angles = _ROTATES[name].findall(code) + _FACTOR[name].findall(code)
        if all(_HALF.search(angle) for angle in angles):
            return "no"
    return "perhaps"


def _read_lookups(workspace: Workspace) -> Iterator[_LookedUp]:
    started: set[Location] = set()
    for node in workspace.launches.nodes:
        started.update(facts.location for facts in workspace.code.find_nodes(node))
        if node.when is not False:
            yield from _pairs(list_frames(workspace, node), node.executable)
    for facts in workspace.code.nodes:
        if facts.location not in started:
            frames = [(frame.name, frame) for frame in facts.frames]
            yield from _pairs(frames, facts.name or facts.class_name)


def _pairs(frames: Iterable[tuple[str | None, NodeFrame]], node: str) -> Iterator[_LookedUp]:
    """Yield the frames of each lookup of a node."""
    by_call: dict[Location, list[str | None]] = {}
    for name, frame in frames:
        if frame.lookup:
            plain = name.removeprefix("/") if name is not None else None
            by_call.setdefault(frame.lookup, []).append(plain)
    for at, names in by_call.items():
        target, source = names if len(names) == 2 else (None, None)
        yield _LookedUp(target, source, node, at)


def _may_look_up_others(workspace: Workspace, lookups: Sequence[_LookedUp]) -> bool:
    """Return whether code may look up transforms that are not known."""
    if workspace.launches.unknown_nodes or any(None in lookup[:2] for lookup in lookups):
        return True
    texts = list(workspace.texts.python_texts)
    texts += [source.text for source in workspace.texts.every_source(CPP_ENDINGS)]
    words = _LOOKUPS if not lookups else _OTHER_LOOKUPS
    return any(word in text for text in texts for word in words)
