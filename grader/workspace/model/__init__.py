"""The files of a workspace, read once: packages, robots, and what launch files start."""
