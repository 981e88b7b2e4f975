"""Messages, services and actions: their files as rosidl reads them, and the types of well-known
packages.
"""
