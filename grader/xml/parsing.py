"""XML read by lxml, which may open nothing: no file, no network, no entity."""

from lxml import etree

Element = etree._Element  # noqa: SLF001  lxml has no public name for it
XMLSyntaxError = etree.XMLSyntaxError

# Callers limit the number of bytes.
_PARSER = etree.XMLParser(
    resolve_entities=False,
    no_network=True,
    load_dtd=False,
    dtd_validation=False,
    huge_tree=False,
    remove_comments=True,
    remove_pis=True,
)


def parse_xml(data: bytes) -> Element:
    """Return the root element of an XML text; raises XMLSyntaxError."""
    return etree.fromstring(data, _PARSER)
