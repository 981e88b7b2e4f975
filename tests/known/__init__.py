"""Tests of the files of what is known of ROS 2."""
