"""Mutants of setup.py and of launch files in Python: strings misspelt, entries of lists and imports deleted."""

import ast
import re
from collections.abc import Iterator

from grader.mutation.mutants import MutantEdit, misspelt
from grader.package.edits.python_file import PythonFile, keyword
from grader.package.package import SETUP
from grader.source import Source

# Arguments that only people read.
_FOR_PEOPLE = re.compile(
    "(long_)?description|(author|maintainer)(_email)?|(install|tests)_requires?|classifiers|exclude|keywords|license|url"
    "|version|zip_safe"
)
_MAX_LABEL = 70


def python_changes(path: str, label: str, text: str) -> Iterator[MutantEdit]:
    """Yield the changes of a file: an entry of data_files, an action or an import deleted, a string misspelt."""
    file = PythonFile(Source(path, text))
    is_setup = label == SETUP
    family = "data_files entry deleted" if is_setup else "action removed"
    for item in _entries(file):
        start, end = file.span(item)
        after = file.text[end:].lstrip()
        end = file.text.index(",", end) + 1 if after.startswith(",") else end
        yield MutantEdit(family, f"{label} {_short(file, item)}", start, end, "")
    for call in file.calls("add_action"):
        action = call.args[0] if call.args else call
        yield MutantEdit(family, f"{label} {_short(file, action)}", *file.span(call), "None")
    for node in file.imports if is_setup else ():
        yield MutantEdit("import deleted", f"{label} {file.segment(node)}", *file.span(node), "pass")
    ignored = [*_for_people(file)]
    for literal in file.literals:
        if literal.text.strip() and not any(start <= literal.start < end for start, end in ignored):
            place = f"{label} {literal.text[:_MAX_LABEL]}"
            yield MutantEdit("string misspelt", place, literal.start, literal.end, misspelt(literal.text))


def _entries(file: PythonFile) -> Iterator[ast.expr]:
    """Yield the entries of data_files, and the actions of a launch file."""
    given = [keyword(call, "data_files") for call in file.calls("setup")]
    lists = [found.value for found in given if found is not None]
    lists += [call.args[0] for call in file.calls("LaunchDescription") if call.args]
    for found in lists:
        yield from found.elts if isinstance(found, ast.List | ast.Tuple) else ()


def _short(file: PythonFile, node: ast.expr) -> str:
    """Return what tells an item of a list from others: the executable of a node, else its text."""
    executable = keyword(node, "executable") if isinstance(node, ast.Call) else None
    text = " ".join(file.segment(executable.value if executable is not None else node).split())
    return text.strip("'\"") if len(text) <= _MAX_LABEL else text[:_MAX_LABEL]


def _for_people(file: PythonFile) -> Iterator[tuple[int, int]]:
    """Yield the offsets of docstrings and of arguments that only people read."""
    for node in file.nodes:
        match node:
            case ast.Expr(value=ast.Constant()):
                yield file.span(node)
            case ast.keyword(arg=str(name)) if _FOR_PEOPLE.fullmatch(name):
                yield file.span(node)
