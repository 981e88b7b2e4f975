"""A robot as a picture: what is shown of it, and where in three views.

It imports `grading` and below, and knows no format. Begin with `picture.py`.
"""
