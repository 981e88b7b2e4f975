"""The elements and attributes that may be written at a place of a URDF: what an editor offers."""

import re
from collections.abc import Iterator

from grader.ros.xml.urdf_format import TAGS

_TAG = re.compile(
    r"<!--.*?(?:-->|\Z)|<(?P<end>/?)(?P<name>[\w:.-]++)(?P<rest>[^<>]*+)(?P<close>>|\Z)", re.DOTALL
)
_STARTED_TAG = re.compile(r"<[\w:.-]*\Z")
_STARTED_ATTRIBUTE = re.compile(
    r"<(?P<tag>[\w:.-]++)(?P<before>\s(?:[^<>\"']|\"[^\"<]*+\"|'[^'<]*+')*+)\Z"
)
_STARTED_WORD = re.compile(r"\s[\w:]*\Z")
_WRITTEN = re.compile(r"(?<![\w:.-])([\w:.-]++)\s*+=")
_MACRO = "xacro:macro"


def offered_elements(before: str) -> Iterator[tuple[str, str]]:
    """Yield the names that may follow the text of a URDF up to a place, with what each is.

    These are elements behind `<`, and attributes in a tag; there are none in a value or in text. A
    macro of xacro may have what a robot has.
    """
    if _STARTED_TAG.search(before):
        parent = _element_around(before)
        for child in TAGS[parent].children if parent in TAGS else ():
            is_needed = child in TAGS[parent].needed
            yield child, f"in <{parent}>, needed" if is_needed else f"in <{parent}>"
        return
    started = _STARTED_ATTRIBUTE.search(before)
    if started is None or started["tag"] not in TAGS or not _STARTED_WORD.search(before):
        return
    written = {*_WRITTEN.findall(started["before"])}
    for name, about in TAGS[started["tag"]].attributes.items():
        if name not in written:
            parts = f"{' '.join(about.parts)} ".lstrip() if len(about.parts) > 1 else ""
            unit = f"{parts}in {about.unit}" if about.unit not in ("", "1") else parts.strip()
            default = f"default: {about.default}" if about.default else ""
            needed = "needed" if about.default is None else ""
            yield name, ", ".join(word for word in (unit, default, needed) if word)


def _element_around(before: str) -> str:
    """Return the element in which a text ends, other than those of xacro; empty outside."""
    around: list[str] = []
    for tag in _TAG.finditer(before):
        name = tag["name"]
        if name is None or not tag["close"]:  # a comment, or the tag that is typed
            continue
        if tag["end"]:
            if name in around:
                del around[len(around) - 1 - around[::-1].index(name) :]
        elif not tag["rest"].endswith("/"):
            around.append(name)
    for name in reversed(around):
        if name == _MACRO:
            return "robot"
        if not name.startswith("xacro:"):
            return name
    return ""
