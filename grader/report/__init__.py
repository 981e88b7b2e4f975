"""A report in each of its formats. Renderers lay it out; they never grade.

It imports `grading`, `classroom`, `drawing` and below. Begin with `formats.py`. A report is described in `document.py`,
of entries and blocks in `criteria.py`; the sentences are in `content.py` and `details.py`.
"""
