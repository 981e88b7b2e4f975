"""The first top-level <robot> of a text, written as XML: tags and attributes only, which are all that urdfdom reads."""

import re

from grader.xml.tinyxml2.tags import Tag
from grader.xml.tinyxml2.values import escape

_PLAIN_NAME = re.compile(r"(?!(?i:xml))[A-Za-z_][A-Za-z0-9_.\-]*")
_MAX_NAME_LENGTH = 60  # the longest name that urdfdom knows has 17 letters
_MAX_DEPTH = 32  # urdfdom never looks deeper than robot/link/visual/geometry/box


class RobotWriter:
    """A writer of opening and closing tags. Names that XML or lxml may refuse have no meaning for urdfdom: `_` replaces them."""

    def __init__(self) -> None:
        self.offsets: list[int] = []  # of the start tags that were written
        self._out: list[str] = []

    def open(self, tag: Tag, depth: int) -> str:
        """Write a tag with `depth` open tags around it, all of which were written, and return the name that it got."""
        if depth >= _MAX_DEPTH or (depth == 0 and (tag.name != "robot" or self._out)):
            return ""
        self.offsets.append(tag.offset)
        name = tag.name if _is_plain(tag.name) else "_"
        values = "".join(f' {key}="{escape(value)}"' for key, value in tag.attributes.items() if _is_plain(key))
        self._out.append(f"<{name}{values}{'>' if tag.form == 'open' else '/>'}")
        return name

    def close(self, name: str) -> None:
        """Write the closing tag of one that was written."""
        self._out.append(f"</{name}>")

    @property
    def xml(self) -> bytes:
        """The robot as XML; empty without a robot."""
        return "".join(self._out).encode()


def _is_plain(name: str) -> bool:
    return len(name) < _MAX_NAME_LENGTH and _PLAIN_NAME.fullmatch(name) is not None
