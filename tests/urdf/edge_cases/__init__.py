"""Small URDFs, each at the edge of a rule, with ROS 2's verdict on it: a table for each part of the format."""

import tomllib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal


@dataclass(frozen=True, slots=True)
class EdgeCase:
    """A file and ROS 2's verdict on it; a program that hangs or crashes on a file has rejected it."""

    name: str
    rule: str
    text: bytes
    verdict: Literal["clean", "degraded", "rejected"]
    oracle: Literal["agrees", "hangs", "aborts"] = "agrees"
    lyrical: Literal["clean", "degraded", "rejected"] | None = (
        None  # the verdict there, if it is another
    )


def _cases() -> Iterator[EdgeCase]:
    """Yield the cases; what is no UTF-8 is written as Latin-1."""
    for path in sorted(Path(__file__).parent.glob("*.toml")):
        for name, row in tomllib.loads(path.read_bytes().decode()).items():
            text = row["text"].encode() if "text" in row else row["latin_1"].encode("latin-1")
            yield EdgeCase(
                name,
                row["rule"],
                text,
                row["verdict"],
                row.get("oracle", "agrees"),
                row.get("lyrical"),
            )


EDGE_CASES = tuple(_cases())
