"""Manual grading: the queue of what a person grades, and the pictures that belong to it."""
