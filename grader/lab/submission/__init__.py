"""Submissions: which URDF and which package of the files are graded, and why.

It imports all readers below, and knows no checks. Begin with `submission.py`; `selection.py`
decides.
"""
