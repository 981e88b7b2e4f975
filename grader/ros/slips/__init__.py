"""What is written otherwise in a robot's files, with all that it may stand for.

It imports `xacro`, `xml` and `python`. Begin with `choices.py`, which lists the kinds.
"""
