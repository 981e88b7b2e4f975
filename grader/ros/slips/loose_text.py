"""What a text has between its tags and around its robot: a tag without its <, an early </robot>."""

import re
from collections.abc import Iterator

from grader.base.slips import Slip
from grader.base.source import Source
from grader.base.text import cut
from grader.ros.xml.urdf_format import TAGS

_MAX_SHOWN = 60  # characters of a tag
_MAX_LENGTH = 2000  # characters of a text between two tags
_MARKUP = re.compile(r"(?s)<!--.*?(?:-->|\Z)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<\?.*?(?:\?>|\Z)|<[^<>]*>?")
_START = re.compile(
    r"""(?:^|(?<=\s))(?P<name>[\w:.-]+)(?:\s+[\w:.-]+\s*=\s*(?:"[^"]*"|'[^']*'))+\s*/?>"""
)
_BARE = re.compile(r"(?:^|(?<=\s))(?P<name>visual|collision|geometry|inertial)\s*>")
_END = re.compile(r"(?:^|(?<=\s))/(?P<name>[\w:.-]+)\s*>")
_NAMED = re.compile(r"""<(?:link|joint)\s[^<>]*?name\s*=\s*["']([^"'<>]*)["']""")
_CLOSED = re.compile(r"(?s)<!--.*?(?:-->|\Z)|</robot\s*>")


def loose_tag_slips(source: Source) -> Iterator[Slip]:
    """Yield the tags that lack their <, so that they are text."""
    position = 0
    text = source.text
    for match in _MARKUP.finditer(text):
        yield from _tags_in(source, position, match.start())
        position = match.end()


def _tags_in(source: Source, start: int, end: int) -> Iterator[Slip]:
    text = source.text[start:end]
    if ">" not in text or len(text) > _MAX_LENGTH:
        return
    for pattern in (_START, _BARE, _END):
        for match in pattern.finditer(text):
            name = match["name"]
            if name in TAGS or name.startswith("xacro:"):
                at = start + match.start()
                shown = cut(match[0], _MAX_SHOWN)
                reaction = f"a < is missing before {shown}"
                assumption = f"{shown} is read as <{shown}"
                yield Slip((source.edit(at, at, "<"),), reaction, assumption, source.at(at))


def early_end_slips(source: Source) -> Iterator[Slip]:
    """Yield the end of the robot after which links or joints follow, and another end.

    A name that is there on both sides is one of a text that was left over.
    """
    text = source.text
    ends = [match for match in _CLOSED.finditer(text) if match[0].startswith("</")]
    if len(ends) != 2 or len(re.findall(r"<robot[\s>]", text)) != 1:
        return
    early, last = ends
    before = set(_NAMED.findall(text, 0, early.start()))
    after = set(_NAMED.findall(text, early.end(), last.start()))
    if not after or before & after:
        return
    line = source.at(early.start()).line
    edit = source.edit(early.start(), early.end(), "")
    reaction = f"the robot ends in line {line}, and what follows is not read"
    assumption = f"{early[0]} in line {line} is ignored"
    yield Slip((edit,), reaction, assumption, source.at(early.start()))
