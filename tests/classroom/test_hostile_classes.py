"""Hostile names and symlinks in generated classes: a short run of `python -m tests.classroom.hostile_classes`."""

from tests.classroom.hostile_classes import try_classes


def test_nobody_gets_anything_of_another_student() -> None:
    """No result comes from a file outside of the student's folder, and no addition of another student changes a mark."""
    try_classes(60)
