"""The autograder zip for Gradescope.

It imports `grading` and below. Begin with `gradescope.py`. What is in `on_gradescope/` is put into
the root of the zip and runs there; nothing here imports it.
"""
