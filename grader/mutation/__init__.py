"""Test a rubric: mutants of its reference must lose points, equivalents nothing, samples what they declare.

It imports `grading` and below. Begin with `testing.py`, then `mutants.py` and `equivalents.py`.
"""
