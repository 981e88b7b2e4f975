"""Where the calls of a Python file end."""

import ast
from collections.abc import Mapping

from grader.base.source import Source
from grader.ros.python.parse import Code, end_position, location_in, make_position, parse
from grader.ros.python.walking import walk


def ends_of_calls(source: Source) -> Mapping[tuple[int, int], int]:
    """Return the offsets at which calls end, by the line and column at which they begin.

    Of several calls that begin at one place, as in `a.b().c()`, it is the end of the longest.
    There are none in a file that Python cannot read.
    """
    code = parse(source.text.encode("utf-8", "surrogateescape"), source.path)
    ends: dict[tuple[int, int], int] = {}
    for node in walk(code.tree) if isinstance(code, Code) else ():
        if isinstance(node, ast.Call):
            place = location_in(source, make_position(node))
            end = location_in(source, end_position(node))
            key = (place.line, place.column)
            offset = source.start_offset(end)
            ends[key] = max(offset, ends.get(key, 0))
    return ends
