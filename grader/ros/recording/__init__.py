"""Reads recordings of `ros2 bag record`: files in MCAP or SQLite, and what the robot did in them.

Nothing of a recording is run, and no definition of a message becomes code.
"""
