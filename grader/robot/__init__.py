"""URDF text to a robot, as ROS 2 reads it; forward kinematics; shapes. Usable on its own."""
