"""Labs of other courses: single robots, with rubrics (test_labs.py), and whole packages (variants.py)."""
