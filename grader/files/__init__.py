"""Read untrusted files: folders, archives, limits. No other package opens a student's file.

It imports only the modules at the top of the package. Begin with `tree.py`, what a folder or an
archive becomes, and `opening.py`, which makes it.
"""
