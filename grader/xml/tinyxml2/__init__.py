"""The TinyXML2 dialect of XML, translated into well-formed XML for lxml.

ROS 2 reads URDF with TinyXML2, which accepts much that XML forbids and rejects a little that XML allows. A URDF's meaning is
in its tags and attributes alone, so the translation keeps these, in order, and omits text, comments and declarations.
"""

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from grader.xml.tinyxml2.scanner import Scan

# lxml turns a line break or tab in a value into a space, TinyXML2 keeps it. The search skips all other bytes.
_UNIMPORTANT = bytes(sorted(set(range(256)) - set(b"=\"'\t\n\r")))
_BROKEN_VALUE = re.compile(rb"""=[\t\n\r]*(?:"[='\t\n\r]*?[\t\n\r]|'[="\t\n\r]*?[\t\n\r])""")
_DEFAULT_NAMESPACE = re.compile(rb"xmlns[ \t\r\n]*=")
_BYTE_ORDER_MARK = b"\xef\xbb\xbf"
_PLAIN_START = re.compile(
    rb"""(?!<\?|\xff\xfe|\xfe\xff|\xef\xbb\xbf)|<\?xml\s+version\s*=\s*["']1\.0["'](?:\s+encoding\s*=\s*["'](?i:utf-8)["'])?\s*\?>"""
)


def without_mark(data: bytes) -> bytes:
    """Return a text without its byte-order mark, which TinyXML2 skips."""
    return data.removeprefix(_BYTE_ORDER_MARK)


def is_plain(data: bytes) -> bool:
    """Return whether a text that lxml accepts means the same to TinyXML2, so that no translation is needed."""
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
    from grader.xml.tinyxml2.scanner import Scanner  # late: most files are plain, and compiling its patterns takes long

    return Scanner(text).scan()
