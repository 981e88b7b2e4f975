"""Grade robotics lab submissions by what the robot does."""

__version__ = "0.1.0"
