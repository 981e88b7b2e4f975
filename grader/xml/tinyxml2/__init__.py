"""The TinyXML2 dialect of XML, translated into well-formed XML for lxml.

ROS 2 reads URDF with TinyXML2, which accepts much that XML forbids and rejects a little that XML allows. A URDF's
meaning is in its tags and attributes alone, so the translation keeps these, in order, and omits text, comments and
declarations.
"""
