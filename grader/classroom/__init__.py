"""Many submissions: what a class has handed in, graded side by side, kept in a gradebook, and back to the LMS."""
