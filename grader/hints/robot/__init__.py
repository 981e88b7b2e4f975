"""Edits of a robot: small changes of its text, each a mistake that students make, undone."""
