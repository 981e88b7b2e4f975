"""What a comparison with an oracle finds, and its summary."""

from collections import Counter
from collections.abc import Iterable
from typing import NamedTuple

MAX_SHOWN = 10


class Compared(NamedTuple):
    """One input: its seed, what the oracle says of it in a word, and how the grader differs, if it does."""

    seed: int
    kind: str
    difference: str | None = None


def summary(results: Iterable[Compared]) -> list[str]:
    """Return how many inputs agree, how many there are of each kind, and the first that differ."""
    listed = sorted(results)
    different = [result for result in listed if result.difference is not None]
    kinds = ", ".join(
        f"{count} {kind}"
        for kind, count in sorted(Counter(result.kind for result in listed).items())
    )
    counted = f"{len(listed)} inputs ({kinds}): {len(listed) - len(different)} agree, {len(different)} differ"
    return [
        counted,
        *(f"seed {result.seed}: {result.difference}" for result in different[:MAX_SHOWN]),
    ]
