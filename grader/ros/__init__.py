"""Read what ROS 2 reads, without running it: packages, robots, and the names that they share."""
