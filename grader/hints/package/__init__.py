"""Edits of the files of a package that may undo mistakes: guesses, which are shown only if grading proves them."""
