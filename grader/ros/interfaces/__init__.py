"""Messages, services and actions: their files, and the types of well-known packages.

The files are read as rosidl reads them.
"""
