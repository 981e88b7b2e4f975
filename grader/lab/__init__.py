"""Grade one submission: what is graded, checks, the rubric, points, hints, new rubrics."""
