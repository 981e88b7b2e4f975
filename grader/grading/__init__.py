"""Points: the rubric, the grade, the report. The only layer that knows what a fact is worth."""
