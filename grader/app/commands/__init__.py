"""The work of each command, without typer and without printing.

The command passes the functions that print.

It imports everything below. Begin with `grade_submission.py`; for a class with `grade_class.py`.
"""
