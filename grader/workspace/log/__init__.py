"""Outputs of ROS 2 in a terminal or a log file: their messages, and what explains them."""
