"""A class is a function of plain files: submissions, rubric, roster and marks give results and grades.

It imports `grading`, `workers` and below. Begin with `grades.py`; `submissions.py` says whose a submission is,
`run/` grades, `marks.py` reads what people typed.
"""
