"""URDF text to a robot, as ROS 2 reads it; forward kinematics; shapes.

It imports `xml` and is usable on its own. Begin with `model.py`, then `reader.py` and
`kinematics.py`.
"""
