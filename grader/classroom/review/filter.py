"""Which items of a review are shown."""

from collections.abc import Callable
from typing import NamedTuple


class ReviewFilter(NamedTuple):
    """Which items of a review are shown: of a criterion, of a section, and of a state, one of ITEM_STATES."""

    criterion: str = ""
    section: str = ""
    state: str = ""


# The states that a filter knows, each with its words, and whether an item with a content is in it, by whether this
# review has marked it.
ITEM_STATES: dict[str, tuple[str, Callable[[str, bool], bool]]] = {
    "": ("all", lambda _content, _is_own: True),
    "unmarked": ("unmarked", lambda _content, is_own: not is_own),
    "answered": ("with something to read", lambda content, _is_own: bool(content)),
    "empty": ("without an answer", lambda content, _is_own: not content),
    "marked": ("marked in this review", lambda _content, is_own: is_own),
}
