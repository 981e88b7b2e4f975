"""A new rubric from a reference solution: its facts are tried on it, and written as criteria.

It imports `grading` and below. Begin with `draft.py`.
"""
