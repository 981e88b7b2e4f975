"""A difference between a text and XML."""

from typing import NamedTuple

from grader.problems import Kind


class NoteDifference(NamedTuple):
    """A difference from XML, an error, or what was assumed about one, at a character offset."""

    kind: Kind
    message: str
    offset: int
