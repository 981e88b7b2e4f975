"""Points: the rubric, the grade, the report. The only floor that knows what a thing is worth."""
