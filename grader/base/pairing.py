"""Kuhn's algorithm: as many pairs as possible of two sides.

Each item fits some items of the other side.
"""

from collections.abc import Sequence


def most_pairs(fitting: Sequence[Sequence[int]]) -> dict[int, int]:
    """Return pairs by index: an item of the second side, and its partner of the first one.

    Args:
        fitting: For each item of the first side, the indices of those of the second one that fit
            it.
    """
    partners: dict[int, int] = {}

    def place(item: int, passed: set[int]) -> bool:
        """Give an item a partner, perhaps that of another item, which then gets another one."""
        for other in fitting[item]:
            if other not in passed:
                passed.add(other)
                if other not in partners or place(partners[other], passed):
                    partners[other] = item
                    return True
        return False

    for item in range(len(fitting)):
        place(item, set())
    return partners
