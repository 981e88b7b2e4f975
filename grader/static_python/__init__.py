"""Python files of a submission, followed by reading: nothing of them is ever run or imported."""
