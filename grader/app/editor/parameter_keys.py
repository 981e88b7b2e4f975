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
    own = _KEY.match(line)
    if own is None or not own["indent"]:
        return None
    indent = len(own["indent"])
    tables: list[str] = []
    is_parameters = False
    for text in reversed(above):
        found = _KEY.match(text)
        if found is None or not found["colon"] or len(found["indent"]) >= indent:
            continue
        indent = len(found["indent"])
        if is_parameters:
            prefix = "".join(f"{table}." for table in reversed(tables))
            return ParameterKey(found["key"].rpartition("/")[2], prefix, own["key"])
        if found["key"] == _PARAMETERS:
            is_parameters = True
        else:
            tables.append(found["key"])
    return None
