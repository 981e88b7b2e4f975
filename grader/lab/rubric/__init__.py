"""A rubric: its file, its keys, its criteria, its model answers."""
