"""Compare the grader's expansion with xacro's on random documents: `python -m tests.xacro.compare 50000 [FIRST SEED]`."""

import sys
from collections.abc import Iterable
from multiprocessing import Pool

from tests.xacro import grammar, oracle
from tests.xacro.comparing import difference

MAX_SHOWN = 10


def compared(seed: int) -> tuple[int, bool, str | None]:
    """Return a seed, whether xacro accepts its document, and how the grader's expansion differs, if it does."""
    document = grammar.document(seed)
    expected = oracle.expand(document)
    try:
        text = difference(document, expected)
    except Exception as error:  # noqa: BLE001 - an expansion never raises, so this is a difference
        text = f"{type(error).__name__}: {error}"
    return seed, isinstance(expected, oracle.Accepted), text


def summary(results: Iterable[tuple[int, bool, str | None]]) -> list[str]:
    """Return how many documents agree, and the first that do not."""
    listed = sorted(results)
    different = [(seed, text) for seed, _, text in listed if text is not None]
    accepted = sum(is_accepted for _, is_accepted, _ in listed)
    counted = f"{len(listed) - len(different)} of {len(listed)} documents agree; xacro accepts {accepted}"
    return [counted, *(f"seed {seed}: {text}" for seed, text in different[:MAX_SHOWN])]


def main(number: int, first: int = 0) -> int:
    """Compare so many documents, print the summary and return the exit code."""
    with Pool() as pool:
        lines = summary(pool.imap_unordered(compared, range(first, first + number), chunksize=100))
    print("\n".join(lines))
    return int(len(lines) > 1)


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
