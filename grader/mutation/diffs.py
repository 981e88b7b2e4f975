"""The unified diff of a file with one change: one hunk."""

from itertools import takewhile

_CONTEXT = 2  # lines around a change


def hunk(path: str, before: str, after: str) -> str:
    """Return the unified diff of two texts that differ in one place, without a line break at its end."""
    old, new = before.splitlines(), after.splitlines()
    start = _common(old, new)
    end = _common(old[start:][::-1], new[start:][::-1])
    first, last = max(0, start - _CONTEXT), min(end, _CONTEXT)
    removed, added = old[start : len(old) - end], new[start : len(new) - end]
    above, below = old[first:start], old[len(old) - end : len(old) - end + last]
    size = len(above) + len(below)
    lines = [
        f"--- {path}",
        f"+++ {path}",
        f"@@ -{_span(first, size + len(removed))} +{_span(first, size + len(added))} @@",
        *(f" {line}" for line in above),
        *(f"-{line}" for line in removed),
        *(f"+{line}" for line in added),
        *(f" {line}" for line in below),
    ]
    return "\n".join(lines)


def _common(one: list[str], other: list[str]) -> int:
    return sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False)))


def _span(first: int, size: int) -> str:
    """Return the range of lines as diff writes it: an empty one names the line before."""
    return f"{first + (size > 0)},{size}"
