"""What a text has between its tags and around its robot: a tag without its <, an early </robot>."""

import re

from grader.base import markup
from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips, make_slip
from grader.base.source import Source
from grader.base.text import comment_spans, cut
from grader.ros.xml.urdf_format import TAGS

_MAX_SHOWN = 60  # characters of a tag
_MAX_LENGTH = 2000  # characters of a text between two tags
_MARKUP = on_use(r"(?s)<!--.*?(?:-->|\Z)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<\?.*?(?:\?>|\Z)|<[^<>]*>?")
_START = on_use(
    r"""(?:^|(?<=\s))(?P<name>[\w:.-]+)(?:\s+[\w:.-]+\s*=\s*(?:"[^"]*"|'[^']*'))+\s*/?>"""
)
_BARE = on_use(r"(?:^|(?<=\s))(?P<name>visual|collision|geometry|inertial)\s*>")
_END = on_use(r"(?:^|(?<=\s))/(?P<name>[\w:.-]+)\s*>")
_NAMED = on_use(r"""<(?:link|joint)\s[^<>]*?name\s*=\s*["']([^"'<>]*)["']""")
_ROBOT = on_use(r"<robot(?=[\s>])")
_MARK_OF_COMMENT = on_use("<!--|-->")
_END_OF_COMMENT = on_use(r"(?<!\s)\s*+(?:--\s*+>?|->|-)$")  # as it is misspelt
_DISABLED = on_use(r"(?i)\b(?:not?|todo|old|off|disabled|unused|removed|instead|later)\b")
_ELEMENT = on_use(r"<(?:link|joint|visual|collision|inertial|material|xacro:\w+)[\s/>]")
_CLOSED = on_use(r"(?s)<!--.*?(?:-->|\Z)|</robot\s*>")


def loose_tag_slips(source: Source) -> Slips:
    """Yield the tags that lack their <, so that they are text."""
    position = 0
    text = source.text
    for match in _MARKUP.finditer(text):
        yield from _tags_in(source, position, match.start())
        position = match.end()


def _tags_in(source: Source, start: int, end: int) -> Slips:
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
                yield make_slip((source.edit(at, at, "<"),), reaction, assumption)


def early_end_slips(source: Source) -> Slips:
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
    yield make_slip((edit,), reaction, assumption)


def nested_robot_slips(source: Source) -> Slips:
    """Yield the <robot> inside of another one, whose content is that of the robot."""
    text = source.text
    starts = [match.start() for match in _ROBOT.finditer(text)]
    if len(starts) != 2:
        return
    inner = starts[1]
    head = markup.head_end(text, inner)[0]
    end = markup.element_end(text, inner)
    closing = text.rfind("</robot", inner, end)
    if closing < 0 or "</robot" not in text[end:]:
        return
    edits = (source.edit(inner, head, ""), source.edit(closing, end, ""))
    assumption = "what is inside of the second <robot> is read as part of the first one"
    yield Slip(edits, "ROS 2 ignores <robot> in <robot>", assumption, source.at(inner))


def open_comment_slips(source: Source) -> Slips:
    """Yield the comments of one line whose end is missing, so that elements are in them.

    One that may end after the next comment is left as it is, and one that says that a part is not
    there.
    """
    text = source.text
    for begin, end in comment_spans(text):
        start = begin + len("<!--")
        first, _, rest = text[start:end].partition("\n")
        first = first.rstrip()
        words = _END_OF_COMMENT.sub("", first)
        is_left = words == first and _DISABLED.search(words)
        mark = _MARK_OF_COMMENT.search(text, end + len("-->"))
        is_later = mark is not None and mark[0] == "-->"
        if is_left or is_later or "<" in first or not words.strip():
            continue
        if "<!--" in rest and _ELEMENT.search(rest):
            line = source.at(begin).line
            edit = source.edit(start + len(words), start + len(first), " -->")
            reaction = f"the comment of line {line} is not closed, so that elements are in it"
            yield make_slip((edit,), reaction, f"the comment ends in line {line}")
