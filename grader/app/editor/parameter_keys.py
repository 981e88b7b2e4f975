"""The key of a parameter in a line of YAML: the node that it is of, and its whole name."""

import re
from collections.abc import Sequence
from typing import NamedTuple

_KEY = re.compile(r"(?P<indent> *)(?P<key>[\w/*.-]*)(?P<colon> *:)?")
_PARAMETERS = "ros__parameters"


class ParameterKey(NamedTuple):
    """A key below `ros__parameters`."""

    node: str  # the last part of its name
    prefix: str  # the keys of the tables that it is in, each with a dot
    key: str

    @property
    def name(self) -> str:
        """The name of the parameter."""
        return self.prefix + self.key


def parameter_key(above: Sequence[str], line: str) -> ParameterKey | None:
    """Return the parameter whose key a line has, or begins; None where it is none.

    Args:
        above: The lines above it.
        line: The line.
    """
    parent = _KEY.match(line)
    if parent is None or not parent["indent"]:
        return None
    indent = len(parent["indent"])
    tables: list[str] = []
    is_parameters = False
    for text in reversed(above):
        match = _KEY.match(text)
        if match is None or not match["colon"] or len(match["indent"]) >= indent:
            continue
        indent = len(match["indent"])
        if is_parameters:
            prefix = "".join(f"{table}." for table in reversed(tables))
            return ParameterKey(match["key"].rpartition("/")[2], prefix, parent["key"])
        if match["key"] == _PARAMETERS:
            is_parameters = True
        else:
            tables.append(match["key"])
    return None
