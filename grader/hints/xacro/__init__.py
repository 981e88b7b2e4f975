"""Edits of xacro files: of the texts that expanded elements come from."""
