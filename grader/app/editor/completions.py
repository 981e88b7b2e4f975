"""The names that an editor offers at a place where one is written."""

import re
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.parameter_keys import parameter_key
from grader.app.editor.places import TextPlace
from grader.files.tree import overlaid

_MAX_BEFORE = 2_000  # characters, in which it is searched what is asked for
_MAX_OFFERED = 500
_PACKAGE = r"(?P<owner>[\w.-]+)"
_QUOTE = "[\"']"


# The types of joints that ROS 2 knows, with what each does.
_JOINT_TYPES = {
    "fixed": "does not move",
    "continuous": "rotates about its axis without limits, as a wheel does; has no <limit>",
    "revolute": "rotates about its axis between the limits of <limit>, in radians",
    "prismatic": "slides along its axis between the limits of <limit>, in metres",
    "planar": "moves in the plane across its axis; robot_state_publisher does not publish it",
    "floating": "moves freely; robot_state_publisher does not publish it",
}


class _Context(NamedTuple):
    """What may be written behind a text: its pattern may name the owner of the names."""

    endings: tuple[str, ...]
    before: re.Pattern[str]
    kinds: Sequence[str]


def _context(endings: Sequence[str], before: str, *kinds: str) -> _Context:
    return _Context(tuple(endings), re.compile(rf"{before}[\w.~/-]*\Z", re.DOTALL), kinds)


def _attribute(tags: str, name: str) -> str:
    """Return the pattern of the beginning of an attribute of some tags."""
    return rf"<(?:{tags})\b[^<>]*\s{name}\s*=\s*{_QUOTE}"


_XML = (".urdf", ".xacro", ".xml", ".sdf", ".srdf", ".world", ".launch")
_ROBOT = (".urdf", ".xacro")
_YAML = (".yaml", ".yml")
_PYTHON = (".py",)
_JOINT_TYPE = re.compile(rf"{_attribute('joint', 'type')}\w*\Z")
_LIST_BEFORE = rf"(?:\s*:\s*\[?|\s*:\s*(?:\n\s*-[^\n]*)*\n\s*-|[^\n]*\[[^\]\n]*[\[,])\s*{_QUOTE}?"
_CONTEXTS: Sequence[_Context] = (
    _context(
        _XML, r"\$\(find(?:-pkg-share)?\s+" + _PACKAGE + r"\)/(?=[^\"'<>]*\Z)[^\"'<>]*?", "file"
    ),
    _context(_XML, "package://" + _PACKAGE + "/", "file"),
    _context(_XML, r"(?:package://|\$\(find(?:-pkg-share)?\s+)", "package"),
    _context(_XML, r"\$\(arg\s+", "xacro argument"),
    _context(_XML, r"\$\(var\s+", "launch argument"),
    _context(_XML, _attribute("parent|child|disable_collisions", "link[12]?"), "link"),
    _context(_XML, _attribute("mimic", "joint"), "joint"),
    _context(_XML, _attribute("gazebo", "reference"), "link", "joint"),
    _context(_XML, _attribute("joint", "name"), "joint"),
    _context(_XML, _attribute("material", "name"), "material"),
    _context(_XML, _attribute("node|executable|composable_node", "pkg"), "package"),
    _context(
        _XML,
        rf"<(?:node|executable)\b[^<>]*\spkg\s*=\s*{_QUOTE}{_PACKAGE}{_QUOTE}[^<>]*"
        rf"\sexec\s*=\s*{_QUOTE}",
        "program",
    ),
    _context(_YAML, rf"\b\w*(?:joints?|(?:joints?|wheels?)_names?){_LIST_BEFORE}", "joint"),
    _context(_YAML, r"\b\w*(?:frames?|frame_id|_link)" + _LIST_BEFORE, "frame"),
    _context(
        _PYTHON,
        rf"package\s*=\s*{_QUOTE}{_PACKAGE}{_QUOTE}[^()]*executable\s*=\s*{_QUOTE}",
        "program",
    ),
    _context(
        _PYTHON,
        rf"(?:get_package_share_directory|FindPackageShare)\s*\(\s*{_QUOTE}{_PACKAGE}{_QUOTE}"
        rf"\s*\)+\s*,\s*{_QUOTE}launch{_QUOTE}\s*,\s*{_QUOTE}",
        "launch file",
    ),
    _context(
        _PYTHON,
        rf"(?:package\s*=|(?:get_package_share_directory|FindPackageShare)\s*\()\s*{_QUOTE}",
        "package",
    ),
    _context(_PYTHON, rf"LaunchConfiguration\s*\(\s*{_QUOTE}", "launch argument"),
    _context(_PYTHON, rf"frame_id\s*=\s*{_QUOTE}", "frame"),
    _context(_PYTHON, rf"\bfrom\s+{_PACKAGE}\.msg\s+import\s+(?:\w+\s*,\s*)*", "message"),
    _context(_PYTHON, rf"\bfrom\s+{_PACKAGE}\.srv\s+import\s+(?:\w+\s*,\s*)*", "service"),
    _context(_PYTHON, rf"\bfrom\s+{_PACKAGE}\.action\s+import\s+(?:\w+\s*,\s*)*", "action"),
)


def completions(look: Look, place: TextPlace) -> list[lsp.CompletionItem]:
    """Return the names that may be written at a place."""
    before = place.lines.text_before(place.line, place.column)[-_MAX_BEFORE:]
    if place.path.endswith(_ROBOT) and _JOINT_TYPE.search(before):
        member = lsp.CompletionItemKind.EnumMember
        types = _JOINT_TYPES.items()
        return [lsp.CompletionItem(name, kind=member, detail=text) for name, text in types]
    for context in _CONTEXTS:
        match = context.before.search(before) if place.path.endswith(context.endings) else None
        if match is not None:
            owner = match.groupdict().get("owner") or ""
            names: list[str] = []
            for kind in context.kinds:
                names += look.names.offered(kind, owner)
            return _items(names, context.kinds[0])
    if place.path.endswith(_YAML):
        *above, line = before.split("\n")
        key = parameter_key(above, line)
        if key is not None and re.fullmatch(r" *[\w.]*", line):
            whole = _without_line(look, place)
            return _items(whole.names.parameters_below(key.node, key.prefix), "parameter")
    return []


def _without_line(look: Look, place: TextPlace) -> Look:
    """Return a look at the files without a line: while a key is typed, its file is no YAML."""
    lines = place.lines.text.split("\n")
    lines[place.line - 1] = ""
    data = "\n".join(lines).encode("utf-8", "surrogatepass")
    return look.again(overlaid(look.tree, {place.path: data}))


def _items(names: Iterable[str], kind: str) -> list[lsp.CompletionItem]:
    shown = [*dict.fromkeys(names)][:_MAX_OFFERED]
    return [
        lsp.CompletionItem(name, kind=lsp.CompletionItemKind.Value, detail=kind) for name in shown
    ]
