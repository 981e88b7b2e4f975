"""Bounded XML parsing with lxml, the TinyXML2 dialect, and the place of every element and
attribute.

It imports only the modules at the top of the package. Begin with `parsing.py`; `tinyxml2.py` is
needed only where ROS 2 and XML disagree, and `repair.py` only for a text that ROS 2 rejects.
"""
