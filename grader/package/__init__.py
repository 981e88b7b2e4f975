"""A ROS 2 package, read and never run: package.xml, setup.py, launch files and RViz files."""
