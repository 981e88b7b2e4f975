"""A review: one person grades the items that need manual grading."""
