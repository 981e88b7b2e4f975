"""Bounded XML parsing with lxml, the TinyXML2 dialect, and the place of every element and attribute."""
