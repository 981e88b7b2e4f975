"""Static evaluation of Python files and expressions of a submission: nothing of them is run or imported."""
