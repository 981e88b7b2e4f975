"""Launch files of ROS 2 in Python, XML and YAML, followed by reading: which nodes they start, from which files."""
