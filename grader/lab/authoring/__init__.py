"""Rubrics from reference solutions, and their tests.

What a reference passes is written as criteria. A rubric is tested by mutants and equivalents.

It imports `hints`, `grading` and below. Begin with `draft.py`; a rubric is tested in
`rubric_test.py`.
"""
