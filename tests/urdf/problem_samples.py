"""A small file for each kind of problem."""

import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from grader.ros.known.releases import Release


@dataclass(frozen=True, slots=True)
class ProblemSample:
    """A file with a problem of this code at the ¦; `also` lists the other codes in it."""

    code: str
    name: str
    marked: str
    also: str = ""
    distro: Release = "jazzy"

    @property
    def data(self) -> bytes:
        """Return the file without the mark."""
        return self.marked.replace("¦", "").encode("utf-8", "surrogateescape")

    @property
    def location(self) -> tuple[int, int]:
        """Return line and column of the mark, counted from 1 in characters."""
        before = self.marked[: self.marked.index("¦")]
        return before.count("\n") + 1, len(before) - before.rfind("\n")


def _sample(row: dict[str, Any]) -> ProblemSample:
    if "latin_1" in row:
        row["marked"] = row.pop("latin_1").encode("latin-1").decode("utf-8", "surrogateescape")
    return ProblemSample(**row)


_TABLE = Path(__file__).with_suffix(".toml").read_bytes().decode()
SAMPLES = tuple(map(_sample, tomllib.loads(_TABLE)["sample"]))
