"""Edits that undo what makes ROS 2 reject a URDF, or drop content of it."""
