"""Launch files of ROS 2 in Python, XML and YAML, evaluated without running them: the nodes they start, their files."""
