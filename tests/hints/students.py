"""Mistakes as students make them, each on a correct robot."""

import re
import tomllib
from pathlib import Path
from typing import Any, NamedTuple

from tests.hints.trials import BASES, Base

_LENGTH = re.compile(r'\b(xyz|size|radius|length)="([^"]*)"')


class Mistake(NamedTuple):
    """A robot with one or more mistakes, the correct one that it is made of, and what a good teacher would say."""

    name: str
    base: Base
    text: str
    teacher: str


def _mistake(name: str, row: dict[str, Any]) -> Mistake:
    base = BASES[row["base"]]
    text = base.text
    for after, old, new in row["changes"]:
        start = text.index(old, text.index(after))
        text = text[:start] + new + text[start + len(old) :]
    if "scale" in row:
        text = _scaled(text, row["scale"])
    assert text != base.text, name
    return Mistake(name, base, text, row["teacher"])


def _scaled(text: str, factor: float) -> str:
    """Return a robot in another unit of length; axes stay."""

    def scaled(found: re.Match[str]) -> str:
        numbers = " ".join(f"{float(piece) * factor:g}" for piece in found[2].split())
        return f'{found[1]}="{numbers}"'

    return "\n".join(
        line if "<axis" in line else _LENGTH.sub(scaled, line) for line in text.split("\n")
    )


def _read() -> dict[str, Mistake]:
    rows = tomllib.loads(Path(__file__).with_name("mistakes.toml").read_text(encoding="utf-8"))
    return {name: _mistake(name, row) for name, row in rows.items()}


MISTAKES = _read()
