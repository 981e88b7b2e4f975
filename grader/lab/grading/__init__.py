"""Points: the rubric, the grade, the report. No other layer knows what a fact is worth.

It imports `checks` and everything below. Begin with `grade.py`, then `deciding.py` and `report.py`;
`hints/` searches edits.
"""
