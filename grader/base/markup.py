"""The extent of tags, attributes and elements in a markup file, for edits of nothing else.

The text need not be well-formed XML: what a lenient parser reads can be edited, too.
"""

import re
from collections.abc import Iterator

from grader.base.grouping import Span
from grader.base.patterns import on_use
from grader.base.records import Named

_HEAD = on_use(r"""<\s*+([^\s=/>"'<]*+)((?:"[^"]*+"|'[^']*+'|[^>"'<])*)(/?)>""")
_TAG_NAME = on_use(r"<\s*[^\s=/>]*")
_ATTRIBUTE = on_use(r"""\s*([^\s=/>"']+)\s*=\s*(?:"([^"]*)"|'([^']*)')""")
_TOKEN = on_use(
    r"<!--.*?(?:-->|\Z)|<!\[CDATA\[.*?(?:\]\]>|\Z)|<\?.*?(?:\?>|\Z)|<!|</[^<>]*>?|<", re.DOTALL
)
# A word of the value of an attribute, in which an expression of xacro is a part.
WORD_OF_VALUE = on_use(r"(?:\$\{[^{}]*\}|\$\((?:[^()]|\([^()]*\))*+\)|[^\s$]|\$)+")
_INDENTED = on_use(r"\n([ \t]++)<(?![!?/])")  # a tag; the first one is one step from its parent
_STEP = "   "  # of indentation, where the file shows none


class Attribute(Named):
    """The offsets of the name, the value and the end of an attribute, such as xyz="0 0 1".

    The attribute is one of a start tag.
    """

    name: str
    start: int
    value_start: int
    value_end: int
    end: int

    @property
    def value(self) -> Span:
        """The offsets of its value."""
        return self.value_start, self.value_end


def attributes(text: str, start: int) -> Iterator[Attribute]:
    """Yield the attributes of the start tag at an offset."""
    name = _TAG_NAME.match(text, start)
    position = name.end() if name else start
    while match := _ATTRIBUTE.match(text, position):
        group = 2 if match[2] is not None else 3
        yield Attribute(match[1], match.start(1), match.start(group), match.end(group), match.end())
        position = match.end()


def attribute(text: str, start: int, name: str) -> Attribute | None:
    """Return the attribute of this name of the start tag at an offset."""
    return next(
        (candidate for candidate in attributes(text, start) if candidate.name == name), None
    )


def name_end(text: str, start: int) -> int:
    """Return the offset after the name of the start tag at an offset."""
    match = _TAG_NAME.match(text, start)
    return match.end() if match else start


def head_end(text: str, start: int) -> tuple[int, bool]:
    """Return the offset after the start tag at an offset, and whether the element is empty.

    An empty element is written <a/>.
    """
    match = _HEAD.match(text, start)
    if not match:
        end = text.find(">", start)
        return (end + 1 if end >= 0 else len(text)), text[end - 1 : end] == "/"
    return match.end(), match[3] == "/" or match[2].endswith("/")


def element_end(text: str, start: int) -> int:
    """Return the offset after the end tag of the element at an offset.

    Returns the end of the text where the end tag is missing.
    """
    position, is_empty = head_end(text, start)
    if is_empty:
        return position
    depth = 1
    while depth:
        token = _TOKEN.search(text, position)
        if not token:
            return len(text)
        position = token.end()
        if token[0].startswith("</"):
            depth -= 1
        elif token[0] == "<":
            position, is_empty = head_end(text, token.start())
            if not is_empty:
                depth += 1
    return position


def indentation(text: str, start: int) -> str:
    """Return the blank text between the start of a line and an offset.

    It is empty if there is something else.
    """
    line = text[text.rfind("\n", 0, start) + 1 : start]
    return line if line.isspace() else ""


def indented(xml: str, indent: str, newline: str) -> str:
    """Return the text of an element with its lines moved to an indentation.

    The first line has none.
    """
    lines = xml.replace("\r", "").split("\n")
    margin = min((len(line) - len(line.lstrip()) for line in lines[1:] if line.strip()), default=0)
    return f"{newline}{indent}".join(
        [lines[0], *(line[margin:] for line in lines[1:] if line.strip())]
    )


def child_indentation(text: str, start: int) -> str:
    """Return the indentation of the children of the element at an offset.

    It is that of its first child, else one step more than that of the element.
    """
    own_indentation = indentation(text, start)
    end, is_empty = head_end(text, start)
    token = None if is_empty else _TOKEN.search(text, end)
    if token and not token[0].startswith("</"):
        child_indent = indentation(text, token.start())
        if len(child_indent) > len(own_indentation):
            return child_indent
    step = _INDENTED.search(text)
    return own_indentation + (step[1] if step else _STEP)
