"""Manual grading: the queue of items, and their pictures."""
