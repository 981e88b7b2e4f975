"""Launch files in Python, XML and YAML, executed as launch does without starting anything.

Begin with `launch_file.py`, then `actions.py`; `launch_classes.json` lists what
launch and launch_ros have.
"""
