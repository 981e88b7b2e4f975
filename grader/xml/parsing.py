"""lxml told to open nothing: no file, no network, no entity."""

from lxml import etree

Element = etree._Element  # noqa: SLF001  lxml has no public name for it
XMLSyntaxError = etree.XMLSyntaxError

# Whoever calls hands over bytes that are capped already.
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
    """The root element of an XML text; raises XMLSyntaxError."""
    return etree.fromstring(data, _PARSER)
