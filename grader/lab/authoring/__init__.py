"""A rubric from a reference solution, whose facts are written as criteria, and its test by mutants
and equivalents.

It imports `hints`, `grading` and below. Begin with `draft.py`; a rubric is tested in
`rubric_test.py`.
"""
