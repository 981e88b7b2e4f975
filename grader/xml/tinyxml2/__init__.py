"""TinyXML2's dialect of XML, brought into XML's form so that lxml can read it.

ROS 2 reads URDF with TinyXML2, which accepts much that XML forbids and refuses a little that XML allows. A URDF's meaning is
in its tags and attributes alone, so the translation keeps these, in order, and leaves out text, comments and declarations.
Nothing outside this package knows of the dialect.
"""

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.xml.tinyxml2.scanner import Scan

# lxml turns a line break or tab in a value into a space, TinyXML2 keeps it. Only the bytes that matter are looked at.
_UNIMPORTANT = bytes(sorted(set(range(256)) - set(b"=\"'\t\n\r")))
_BROKEN_VALUE = re.compile(rb"""=[\t\n\r]*(?:"[='\t\n\r]*?[\t\n\r]|'[="\t\n\r]*?[\t\n\r])""")
_DEFAULT_NAMESPACE = re.compile(rb"xmlns[ \t\r\n]*=")
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_PLAIN_START = re.compile(
    rb"""(?!<\?|\xff\xfe|\xfe\xff|\xef\xbb\xbf)|<\?xml\s+version\s*=\s*["']1\.0["'](?:\s+encoding\s*=\s*["'](?i:utf-8)["'])?\s*\?>"""
)


def without_mark(data: bytes) -> bytes:
    """A text without its byte-order mark, over which TinyXML2 goes in silence."""
    return data.removeprefix(_BYTE_ORDER_MARK)


def is_plain(data: bytes) -> bool:
    """Whether a text that lxml accepts means the same to TinyXML2: then no translation is needed."""
    return (
        b"\0" not in data
        and data.find(b"<?", 1) < 0
        and data.count(b"<!") == data.count(b"<!--")
        and _PLAIN_START.match(data) is not None
        and _BROKEN_VALUE.search(data.translate(None, _UNIMPORTANT)) is None
        and (b"xmlns" not in data or _DEFAULT_NAMESPACE.search(data) is None)
    )


def translate(text: str) -> "Scan":
    """Read a text by TinyXML2's rules and write its first <robot> as XML, with the offset of every tag kept."""
    from grader.xml.tinyxml2.scanner import Scanner  # most files are plain, and its patterns take long to compile

    return Scanner(text).scan()
