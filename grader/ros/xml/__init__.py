"""Bounded XML parsing with lxml, the TinyXML2 dialect, and places of elements and attributes.

Every element and attribute has its place.

It imports only the modules at the top of the package. Begin with `parsing.py`; `tinyxml2.py` is
needed only where ROS 2 and XML disagree, and `repair.py` only for a text that ROS 2 rejects.
"""
