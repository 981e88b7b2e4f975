"""A report in each of its formats. Renderers lay it out; they never grade.

It imports `grading`, `classroom` and below. Begin with `formats.py`. What a report says is in
`content.py`, and of each criterion in `criteria.py`.
"""
