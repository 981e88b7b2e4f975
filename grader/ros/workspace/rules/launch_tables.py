"""Tables of parameters in launch files in Python that are no dictionaries."""

import ast
import re
from collections.abc import Iterator

from grader.base.source import Source
from grader.base.text import cut, quoted
from grader.ros.python.parse import Code, location_in, parse, position_of
from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.rules.names import Compared, Fact, Mismatch
from grader.ros.workspace.rules.rule_table import PARAMETER_TABLE

# A text in braces that a comma follows: only such files are parsed.
_MAY_BE_SET = re.compile(r"\{\s*+['\"][^'\"\n]*+['\"]\s*+,")
_MAX_SHOWN = 60  # characters of a set


def launch_table_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the sets among the parameters of a node in a launch file.

    launch_ros takes what is no dictionary for the path of a file (normalize_parameters.py), so it
    sets no parameter. A set of one text is a path that is meant.
    """
    for package in workspace.packages:
        for source in workspace.texts.launch_sources(package):
            if source.path.endswith(".py") and _MAY_BE_SET.search(source.text):
                yield Compared("parameters")
                yield from _sets_in(source)


def _sets_in(source: Source) -> Iterator[Mismatch]:
    code = parse(source.text.encode("utf-8", "replace"), source.path)
    if not isinstance(code, Code):
        return
    for node in ast.walk(code.tree):
        match node:
            case ast.keyword(arg="parameters", value=ast.List(elts=items)):
                for item in items:
                    if isinstance(item, ast.Set) and _is_table(item):
                        yield _written_as_set(code, item)


def _is_table(items: ast.Set) -> bool:
    """Return whether a set has two texts or numbers at least, and nothing that is computed."""
    return len(items.elts) > 1 and all(isinstance(item, ast.Constant) for item in items.elts)


def _written_as_set(code: Code, items: ast.Set) -> Mismatch:
    shown = quoted(cut(ast.unparse(items), _MAX_SHOWN))
    message = (
        f"{shown} is a set, which launch_ros takes for the path of a file, so it sets no "
        "parameter: write a dictionary, with colons"
    )
    return Mismatch(PARAMETER_TABLE, message, location_in(code.source, position_of(items)))
