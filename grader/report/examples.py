"""What docs/examples/ has for a problem code or a check: the explanation, what is wrong, what is
right.
"""

from collections.abc import Iterator, Mapping
from functools import cache
from string import digits
from typing import Any

from grader.base.problems import Kind
from grader.base.toml_file import read_toml, toml_literal
from grader.files.reading import shipped_folder

_CHECKS = "checks"


def explanation_of(kind: Kind) -> str:
    """Return what ROS 2 does about a problem and how to fix the file, in one line; the title if
    that is unknown.
    """
    entry = _family(_family_of(kind.code)).get(kind.code, {})
    return " ".join(entry.get("explanation", kind.title).split())


def example_blocks(name: str) -> Iterator[tuple[str, str, str]]:
    """Yield title, file name and text of a check's row in a rubric, of what is wrong and of what is
    right, if known.
    """
    family = _family_of(name)
    entries = _family(family)
    example = entries.get(name, {})
    if "wrong" in example:
        if family == _CHECKS:
            given = f"\nwith = {toml_literal(example['with'])}" if "with" in example else ""
            yield "In a rubric", "rubric.toml", f'check = "{name}"{given}'
        yield from wrong_and_right(example, entries["frames"])


def wrong_and_right(
    example: Mapping[str, Any], frames: Mapping[str, str]
) -> Iterator[tuple[str, str, str]]:
    """Yield title, file name and text of what is wrong and of what is right in an example, which is
    in the first frame unless it names another one.
    """
    file = example.get("frame", next(iter(frames))).rpartition("/")[2]
    yield "Wrong", file, example["wrong"].rstrip() or "(an empty file)"
    yield "Right", file, example["right"].rstrip()


def _family_of(name: str) -> str:
    if name.isupper():
        return name.rstrip(digits).lower()
    return _CHECKS


@cache
def _family(name: str) -> Mapping[str, Any]:
    path = shipped_folder("docs", "examples") / f"{name}.toml"  # not in a bundle for a platform
    if path.is_file():
        return read_toml(path.read_bytes(), path)[1]
    return {}
