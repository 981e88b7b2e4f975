"""The autograder zip for Gradescope.

It imports `grading` and below. Begin with `gradescope.py`; `on_gradescope/` runs there, and nothing here imports it.
"""
