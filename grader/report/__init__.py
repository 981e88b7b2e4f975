"""A report in each of its formats. Renderers lay it out; they never grade.

It imports `grading`, `classroom`, `drawing` and below. Begin with `formats.py`; the sentences are in `content.py`
and `details.py`.
"""
