"""Compare random robots: `python -m tests.second_opinion N [FIRST SEED] [PROCESSES]`; `mutants` compares all mutants."""

import sys
from collections.abc import Iterable
from itertools import chain

from tests.second_opinion.compare import Comparison, compared_mutants, compared_seeds, summary


def main(number: str, first: str = "0", processes: str = "1") -> int:
    """Print the summary and return the exit code: 1 with a disagreement."""
    if number == "mutants":
        comparisons: Iterable[Comparison] = chain(
            *map(compared_mutants, ("lab6", "arm", "sensors"))
        )
    else:
        comparisons = compared_seeds(range(int(first), int(first) + int(number)), int(processes))
    lines, different = summary(comparisons)
    print("\n".join(lines))
    return int(different > 0)


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
