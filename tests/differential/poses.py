"""Random trees with joints of all types and mimics: the poses of all links against pinocchio's, to 1e-9."""

from collections.abc import Iterator
from random import Random

from tests.differential.compared import Compared
from tests.oracles.random_trees import difference, random_tree


def compare(numbers: range) -> Iterator[Compared]:
    """Compare the trees of some seeds, each at three random positions."""
    for seed in numbers:
        random = Random(seed)
        yield Compared(seed, "tree", difference(random_tree(random), random, 3))
