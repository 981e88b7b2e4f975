"""What all other packages use: places, names, printable text, errors, problems, rigid motions.

The places are those in a file.
"""
