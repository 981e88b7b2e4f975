"""A new rubric from a reference solution: its facts are measured, written as criteria, and tried on the reference.

It imports `grading` and below. Begin with `draft.py`.
"""
