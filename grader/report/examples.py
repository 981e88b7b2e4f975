"""What docs/examples/ has for a problem code or a check: an explanation, and what is wrong and what is right."""

import textwrap
from collections.abc import Iterator, Mapping
from functools import cache
from string import digits
from typing import Any

from grader.files.reading import shipped_folder
from grader.grading.toml_file import read_toml
from grader.grading.toml_rows import toml_literal
from grader.problems import Kind

_CHECKS = "checks"


def explanation_of(kind: Kind) -> str:
    """Return what ROS 2 does about a problem and how to fix the file, in one line; the title if that is unknown."""
    entry = _family(_family_of(kind.code)).get(kind.code, {})
    return " ".join(entry.get("explanation", kind.title).split())


def example_blocks(name: str) -> Iterator[tuple[str, str, str]]:
    """Yield title, file name and text of a check's row in a rubric, of what is wrong and of what is right, if known."""
    family = _family_of(name)
    entries = _family(family)
    example = entries.get(name, {})
    if "wrong" in example:
        if family == _CHECKS:
            given = f"\nwith = {toml_literal(example['with'])}" if "with" in example else ""
            yield "In a rubric", "rubric.toml", f'check = "{name}"{given}'
        file = example.get("frame", next(iter(entries["frames"]))).rpartition("/")[2]
        yield "Wrong", file, example["wrong"].rstrip() or "(an empty file)"
        yield "Right", file, example["right"].rstrip()


def examples(name: str) -> Iterator[str]:
    """Yield these blocks as paragraphs."""
    return (f"{title}:\n\n{textwrap.indent(text, '    ')}" for title, _, text in example_blocks(name))


def _family_of(name: str) -> str:
    return name.rstrip(digits).lower() if name.isupper() else _CHECKS


@cache
def _family(name: str) -> Mapping[str, Any]:
    path = shipped_folder("docs", "examples") / f"{name}.toml"  # not in a bundle for a platform
    return read_toml(path.read_bytes(), path)[1] if path.is_file() else {}


def default_text(value: object) -> str:
    """Return a default as a rubric has it, one that is not given as `not checked`."""
    return "not checked" if value is None else toml_literal(value)
