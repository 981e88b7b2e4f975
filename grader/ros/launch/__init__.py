"""Launch files in Python, XML and YAML, executed as launch does without starting anything.

It imports `python` and `xml`. Begin with `reader.py`, then `actions.py`; `api.json` lists what
launch and launch_ros have.
"""
