"""What ROS 2 has: data with its source, and one reader."""
