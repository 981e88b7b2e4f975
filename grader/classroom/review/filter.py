"""Which items of a review are shown."""

from collections.abc import Callable
from typing import NamedTuple

from grader.classroom.gradebook.manual_queue import QueuedResult


class ReviewFilter(NamedTuple):
    """Which items of a review are shown: of a criterion, of a section, and of a state, one of ITEM_STATES."""

    criterion: str = ""
    section: str = ""
    state: str = ""


# The states that a filter knows, each with its words and with what is true of an item that `is_own` if it was marked.
ITEM_STATES: dict[str, tuple[str, Callable[[QueuedResult, bool], bool]]] = {
    "": ("all", lambda item, is_own: item.is_open or is_own),
    "unmarked": ("unmarked", lambda item, _: item.is_open),
    "answered": ("with something to read", lambda item, is_own: bool(item.content) and (item.is_open or is_own)),
    "empty": ("without an answer", lambda item, is_own: not item.content and (item.is_open or is_own)),
    "marked": ("marked in this review", lambda _, is_own: is_own),
}
