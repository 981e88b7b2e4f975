"""Assign the files of a class to its students."""
