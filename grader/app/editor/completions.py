"""The names that an editor offers at a place where one is written."""

import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from lsprotocol import types as lsp

from grader.app.editor.look import Look
from grader.app.editor.parameter_keys import parameter_key
from grader.app.editor.places import TextPlace, readings

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
_SHARE = rf"(?:get_package_share_directory|FindPackageShare)\s*\(\s*{_QUOTE}{_PACKAGE}{_QUOTE}\s*\)"
_NAMED_SHARE = re.compile(rf"\b(?P<share>\w+)\s*=\s*{_SHARE}")
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
        rf"executable\s*=\s*{_QUOTE}spawner(?:\.py)?{_QUOTE}[^()\[]*arguments\s*=\s*\["
        rf"(?:\s*{_QUOTE}[\w./-]*{_QUOTE}\s*,)*\s*{_QUOTE}",
        "controller",
    ),
    _context(
        _PYTHON,
        rf"{_SHARE}\s*\)*\s*,\s*(?P<folders>(?:{_QUOTE}[\w./-]*{_QUOTE}\s*,\s*)*){_QUOTE}",
        "file",
    ),
    _context(
        _PYTHON,
        r"(?:PathJoinSubstitution\s*\(\s*\[|os\.path\.join\s*\()\s*(?P<share>\w+)\s*,\s*"
        rf"(?P<folders>(?:{_QUOTE}[\w./-]*{_QUOTE}\s*,\s*)*){_QUOTE}",
        "file",
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
    whole = place.lines.text_before(place.line, place.column)
    before = whole[-_MAX_BEFORE:]
    if place.path.endswith(_ROBOT):
        if _JOINT_TYPE.search(before):
            return _items_with_details(_JOINT_TYPES.items(), lsp.CompletionItemKind.EnumMember)
        elements = look.names.elements_behind(whole)
        if elements:
            return _items_with_details(elements, lsp.CompletionItemKind.Property)
    for context in _CONTEXTS:
        match = context.before.search(before) if place.path.endswith(context.endings) else None
        if match is not None:
            return _offered(look, place, context, match.groupdict())
    if place.path.endswith(_YAML):
        *above, line = before.split("\n")
        key = parameter_key(above, line)
        if key is not None and re.fullmatch(r" *[\w.]*", line):
            keys: list[str] = []
            for one in readings(look, place, keeps_line=False):
                keys = max(keys, one.names.parameters_below(key.node, key.prefix), key=len)
            return _items(keys, "parameter")
    return []


def _offered(
    look: Look, place: TextPlace, context: _Context, given: Mapping[str, str | None]
) -> list[lsp.CompletionItem]:
    """Return the names that a context offers, below the folders that are written before."""
    owner = given.get("owner") or ""
    if share := given.get("share"):
        shares = _NAMED_SHARE.finditer(place.lines.text)
        owner = next((each["owner"] for each in shares if each["share"] == share), "")
        if not owner:
            return []
    names: list[str] = []
    for one in readings(look, place, keeps_line=False):
        some = [name for kind in context.kinds for name in one.names.offered(kind, owner)]
        names = max(names, some, key=len)
    folders = re.findall(rf"{_QUOTE}([^\"']*){_QUOTE}", given.get("folders") or "")
    below = "".join(f"{folder.strip('/')}/" for folder in folders)
    names = [name.removeprefix(below) for name in names if name.startswith(below)]
    return _items(names, context.kinds[0])


def _items_with_details(
    names: Iterable[tuple[str, str]], kind: lsp.CompletionItemKind
) -> list[lsp.CompletionItem]:
    return [lsp.CompletionItem(name, kind=kind, detail=text) for name, text in names]


def _items(names: Iterable[str], kind: str) -> list[lsp.CompletionItem]:
    shown = [*dict.fromkeys(names)][:_MAX_OFFERED]
    return [
        lsp.CompletionItem(name, kind=lsp.CompletionItemKind.Value, detail=kind) for name in shown
    ]
