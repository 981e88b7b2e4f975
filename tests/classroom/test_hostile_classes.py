"""Hostile names and symlinks in generated classes: a short run of `python -m tests.classroom.hostile_classes`."""

from tests.classroom.hostile_classes import try_classes


def test_students_cannot_affect_others() -> None:
    """No result comes from a file outside the student's folder, and no addition of another student changes a mark."""
    try_classes(15)
