"""Sets among the parameters of nodes in launch files in Python, where dictionaries are meant."""

import ast
from collections.abc import Iterator

from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.ros.python.parse import Code, parse
from grader.ros.python.walking import walk

# A text in braces that a comma follows: only such files are parsed.
_MAY_BE_SET = on_use(r"\{\s*+['\"][^'\"\n]*+['\"]\s*+,")


def may_have_sets(source: Source) -> bool:
    """Return whether a launch file may have a set among the parameters of a node."""
    return source.path.endswith(".py") and _MAY_BE_SET.search(source.text) is not None


def parameter_sets(source: Source) -> Iterator[tuple[str, Location]]:
    """Yield the sets in the lists of parameters of a launch file, as written, with their places.

    Those of one item are omitted.

    launch_ros takes what is no dictionary for the path of a file (normalize_parameters.py): a set
    of one text may be meant so.
    """
    code = parse(source.text.encode("utf-8", "replace"), source.path)
    if not isinstance(code, Code):
        return
    for node in walk(code.tree):
        match node:
            case ast.keyword(arg="parameters", value=ast.List(elts=items)):
                for item in items:
                    if isinstance(item, ast.Set) and _is_table(item):
                        at = code.at(item)
                        yield ast.unparse(item), at


def _is_table(items: ast.Set) -> bool:
    """Return whether a set has two texts or numbers at least, and nothing that is computed."""
    return len(items.elts) > 1 and all(isinstance(item, ast.Constant) for item in items.elts)
