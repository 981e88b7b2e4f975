"""The gradebook: its tables, the current grades, manual marks, late penalties and statistics."""
