"""Compare the grader with an oracle: `python -m tests.differential check_urdf 200000 [FIRST SEED] [PROCESSES]`."""

import sys
import time
from collections.abc import Callable, Iterable, Iterator
from functools import partial
from importlib import import_module
from multiprocessing import Pool

from tests.differential.compared import Compared, summary

# What is compared, with how many seeds at once: processes of the oracle are started for each part.
ORACLES = {
    "check_urdf": ("tests.differential.urdfs", 500),
    "check_urdf of Lyrical": ("tests.differential.urdfs_of_lyrical", 500),
    "pinocchio": ("tests.differential.poses", 50),
    "colcon": ("tests.differential.colcons", 20),
    "xacro": ("tests.differential.xacros", 100),
}


def compared_part(oracle: str, seeds: range) -> list[Compared]:
    """Return the comparisons of some seeds."""
    compare: Callable[[range], Iterable[Compared]] = import_module(ORACLES[oracle][0]).compare
    return list(compare(seeds))


def compared_all(
    oracle: str, number: int, first: int = 0, processes: int = 2
) -> Iterator[Compared]:
    """Yield the comparisons of so many seeds."""
    step = ORACLES[oracle][1]
    parts = [
        range(start, min(start + step, first + number))
        for start in range(first, first + number, step)
    ]
    with Pool(processes) as pool:
        for part in pool.imap_unordered(partial(compared_part, oracle), parts):
            yield from part


def main(oracle: str, number: str, first: str = "0", processes: str = "2") -> int:
    """Compare, print the summary and return the exit code: 1 with a difference."""
    start = time.monotonic()
    lines = summary(compared_all(oracle, int(number), int(first), int(processes)))
    lines[0] += f"; {time.monotonic() - start:.0f} s"
    print("\n".join(lines))
    return int(len(lines) > 1)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
