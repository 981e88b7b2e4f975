"""A ROS 2 package, read and never run: package.xml, setup.py, CMake, launch files, RViz files.

It imports `files`, `python` and `xml`. Begin with `package.py`.
"""
