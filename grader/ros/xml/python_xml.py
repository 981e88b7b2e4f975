"""Whether Python's own XML parser reads a text.

joint_state_publisher uses it, not TinyXML2 as the rest of ROS 2.
"""

from typing import NoReturn


class _DeclaresEntities(Exception):
    """A text whose entities would have to be expanded."""


def python_xml_error(text: str) -> tuple[str, int] | None:
    """Return why `xml.dom.minidom` cannot parse a text, and the offset at which it stops.

    Returns None if it can, or if the text declares entities.

    The parser is that of minidom, expat with namespaces; it opens no file, and no entity is
    expanded. The encoding that the text declares does not count, because joint_state_publisher gets
    decoded text.
    """
    from xml.parsers import expat  # late: xacro writes XML that every parser reads

    data = text.encode("utf-8", "surrogateescape")
    parser = expat.ParserCreate("utf-8", " ")
    parser.EntityDeclHandler = _stop
    try:
        parser.Parse(data, True)
    except expat.ExpatError as error:
        offset = len(data[: parser.ErrorByteIndex].decode("utf-8", "surrogateescape"))
        return expat.ErrorString(error.code), offset
    except _DeclaresEntities:
        return None
    return None


def _stop(*_declaration: object) -> NoReturn:
    raise _DeclaresEntities
