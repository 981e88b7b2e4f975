"""Static evaluation of Python files and expressions of a submission: none of them is run or imported."""
