"""The attributes of a broken tag, read as they are meant.

Every word and number of the tag is read: what this cannot place is left to a coarser reading.
"""

import re

from grader.base.markup import WORD_OF_VALUE
from grader.base.patterns import on_use
from grader.ros.xml.tinyxml2 import decode
from grader.ros.xml.urdf_format import PARTS, TAGS

_QUOTES = "\"'“”„‘’‚"
# The name of an attribute with what stands for its = : name==, name:, name =:, or nothing.
_NAME = on_use(
    r"""\s*+(?P<name>[A-Za-z_][\w.-]*(?::[A-Za-z_][\w.-]*)?)
    (?:\s*+(?:=\s*+)++|\s*+:\s*+(?:=\s*+)?|\s*+)(?=["'“”„‘’‚])""",
    re.VERBOSE,
)
# The name of the next attribute at the end of a value whose quote is not closed.
_NEXT = on_use(
    r"""(?:["']\s*+|(?<!\s)\s++)?(?<![A-Za-z_.-])(?P<name>[A-Za-z_][\w-]{0,60}+)\s*+=\s*+\Z"""
)


def read_attributes(tag: str, text: str) -> dict[str, str] | None:
    """Return the attributes in the text of a broken tag, which is behind its name.

    Returns None where a part of it may be anything, or where an attribute is given twice.
    """
    attributes = {}
    text = text.rstrip().removesuffix("/").rstrip()
    position = 0
    while text[position:].strip():
        match = _NAME.match(text, position)
        if not match:
            return None
        start = match.end() + 1
        end = _value_end(text, match.end())
        if match["name"] in attributes or end < 0:
            return None
        value = text[start:end]
        position = end + 1
        following = _next_name(tag, match["name"], value)
        if following:
            value = value[: following.start()]
            position = start + following.start("name")
        elif re.search(r"=\s*\Z", value):
            return None
        attributes[match["name"]] = decode(value)
    return attributes


def _value_end(text: str, start: int) -> int:
    """Return the offset of the quote that ends a value, and -1 if there is none."""
    quote = text[start]
    if quote in "\"'":
        end = text.find(quote, start + 1)
        if end < 0:
            end = text.find("'", start + 1) if quote == '"' else text.find('"', start + 1)
        return end
    closing = re.compile(f"[{_QUOTES[2:]}]").search(text, start + 1)
    return closing.start() if closing else -1


def _next_name(tag: str, attribute: str, value: str) -> re.Match[str] | None:
    """Return the name of another attribute with which a value ends, for want of a quote.

    What is before it has as many numbers as the attribute.
    """
    match = _NEXT.search(value)
    if not match:
        return None
    if tag in TAGS:
        is_attribute = match["name"] in TAGS[tag].attributes
    else:
        is_attribute = match[0].lstrip("\"'")[:1].isspace()
    numbers = PARTS.get(attribute, ()) or ("",)
    count = len(WORD_OF_VALUE.findall(value[: match.start()]))
    return match if is_attribute and count == len(numbers) else None
