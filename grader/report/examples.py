"""What docs/examples/ has for a problem code, a rule or a check.

This is an explanation, what is wrong and what is right.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from string import digits
from typing import Any

from grader.base.names import last_part
from grader.base.problems import Kind
from grader.base.records import Named
from grader.base.toml_file import read_toml, toml_literal
from grader.files.reading import shipped_folder
from grader.workspace.api import RULES

_CHECKS = "checks"


class _ExampleBlock(Named):
    """A part of an example: a text in a file."""

    title: str
    file: str  # its name
    text: str


def explain_kind(kind: Kind) -> str:
    """Return what ROS 2 does about a problem and how to fix the file, in one line.

    It is the title if that is unknown.
    """
    entry = _read_examples(_name_file(kind.code)).get(kind.code, {})
    return " ".join(entry.get("explanation", kind.title).split())


def example_blocks(name: str) -> Iterator[_ExampleBlock]:
    """Yield a check's row in a rubric, and the example of a check, a rule or a code.

    The example is there only if it is known; that of a code may be that of one of its rules.
    """
    if name in RULES:
        yield from make_blocks(RULES[name]._asdict())
        return
    file = _name_file(name)
    entries = _read_examples(file)
    example = entries.get(name, {})
    if "example" in example:
        yield from example_blocks(example["example"])
    if "wrong" in example:
        if file == _CHECKS:
            given = f"\nwith = {toml_literal(example['with'])}" if "with" in example else ""
            yield _ExampleBlock("In a rubric", "rubric.toml", f'check = "{name}"{given}')
        yield from make_blocks({"frame": next(iter(entries["frames"])), **example})


def make_blocks(example: Mapping[str, Any]) -> Iterator[_ExampleBlock]:
    """Yield what is wrong and what is right in an example, and the other files beside it."""
    file = _name_frame(example["frame"])
    yield _ExampleBlock("Wrong", file, example["wrong"].strip("\n") or "(an empty file)")
    yield _ExampleBlock("Right", file, example["right"].strip("\n"))
    for frame, text in example.get("beside", {}).items():
        other = _name_frame(frame)
        if text:
            yield _ExampleBlock(f"Beside it, in {other}", other, text.strip("\n"))


def _name_frame(frame: str) -> str:
    return last_part(frame)


def _name_file(name: str) -> str:
    if name.isupper():
        return name.rstrip(digits).lower()
    return _CHECKS


@cache
def _read_examples(name: str) -> Mapping[str, Any]:
    path = shipped_folder("docs", "examples") / f"{name}.toml"  # not in a bundle for a platform
    if path.is_file():
        return read_toml(path.read_bytes(), path)[1]
    return {}
