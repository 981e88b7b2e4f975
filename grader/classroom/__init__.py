"""A class is a function of plain files.

Submissions, rubric, roster and marks give results and grades.

It imports `grading` and below. Begin with `gradebook.py`, which computes a `StudentGrade` for each
student. `submissions.py` says whose a submission is, `batch_run.py` grades in the processes of
`workers/`, `marks.py` reads what people typed, and `lms/` fills in the files of learning management
systems.
"""
