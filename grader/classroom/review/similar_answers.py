"""Answers that are similar: a review offers to mark them together, and a person decides."""

import re
from collections.abc import Sequence
from difflib import SequenceMatcher

_MIN_SHARE = 0.85  # of the words that two similar answers have in common, in the same order
_MAX_WORDS = 300  # of an answer that are compared
_MIN_WORDS = 6  # in a shorter answer, one word makes the difference


def split_words(text: str) -> list[str]:
    """Return the words of an answer, without differences of case, spaces and punctuation."""
    return re.findall(r"\w+", text.casefold())[:_MAX_WORDS]


def share_of_words(some: Sequence[str], others: Sequence[str]) -> float:
    """Return the share of words that two answers have in common; 0 if they are not similar."""
    if min(len(some), len(others)) < _MIN_WORDS:
        return 0.0
    matcher = SequenceMatcher(None, some, others, autojunk=False)
    # The first two are bounds that cost little.
    for ratio in (matcher.real_quick_ratio, matcher.quick_ratio, matcher.ratio):
        share = ratio()
        if share < _MIN_SHARE:
            return 0.0
    return share
