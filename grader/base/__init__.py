"""What all other packages use: places in a file, names, printable text, errors, problems,
rigid motions.
"""
