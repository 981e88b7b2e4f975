"""Facts about one submission.

A check knows no points and no lab: names, frames and numbers come from the rubric.

It imports the readers and `submission`. Begin with `check.py` and `registry.py`, then any module
of checks, such as `placement.py`.
"""
