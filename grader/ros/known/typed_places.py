"""Where files name something: the file typed_places.toml."""

from collections.abc import Mapping
from functools import cache
from typing import NamedTuple

from grader.base.grouping import Strings, StringsByName
from grader.ros.known.typed_rows import read_file


class TypedRow(NamedTuple):
    """Places where names of one kind are written; the file says what the keys are."""

    names: str = ""
    kinds: Strings = ()
    holders: frozenset[str] = frozenset()
    slots: frozenset[str] = frozenset()
    languages: frozenset[str] = frozenset()
    part: str = ""
    path: str = ""  # how it ends
    is_text: bool = True


class TypedPlaces(NamedTuple):
    """The file: the rows, and words by `holder slot`, with what each means."""

    row: tuple[TypedRow, ...]
    words: Mapping[str, StringsByName]


@cache
def typed_places() -> TypedPlaces:
    """Return where files name something, and the few words that some places may have."""
    return read_file(TypedPlaces, "typed_places")
