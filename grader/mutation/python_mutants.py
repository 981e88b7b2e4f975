"""Mutants of setup.py and of launch files in Python: strings misspelt, entries of lists and imports deleted."""

import ast
from collections.abc import Iterable, Iterator

from grader.mutation.mutants import MutantEdit, misspelt
from grader.package.edits.python_file import PythonFile, keyword
from grader.source import Source

# Arguments that only people read.
_FOR_PEOPLE = (
    *(
        "version",
        "description",
        "long_description",
        "license",
        "maintainer",
        "maintainer_email",
        "author",
        "author_email",
    ),
    *("url", "keywords", "classifiers", "zip_safe", "install_requires", "tests_require", "exclude"),
)
_MAX_LABEL = 70


def setup_changes(path: str, label: str, text: str) -> Iterator[MutantEdit]:
    """Yield the changes of a setup.py: an entry of data_files or an import deleted, a string misspelt."""
    file = PythonFile(Source(path, text))
    tags = ("setup.py",)
    for call in file.calls("setup"):
        entries = keyword(call, "data_files")
        yield from _removals(file, "data_files entry deleted", label, _items(entries.value if entries else None), tags)
    for node in file.imports:
        start, end = file.span(node)
        yield MutantEdit("import deleted", f"{label} {file.segment(node)}", start, end, "pass", tags=tags)
    yield from _strings(file, label, tags)


def launch_changes(path: str, label: str, text: str) -> Iterator[MutantEdit]:
    """Yield the changes of a launch file: an action removed, a string misspelt."""
    file = PythonFile(Source(path, text))
    tags = ("launch",)
    for call in file.calls("LaunchDescription"):
        yield from _removals(file, "action removed", label, _items(call.args[0] if call.args else None), tags)
    for call in file.calls("add_action"):
        start, end = file.span(call)
        yield MutantEdit(
            "action removed",
            f"{label} {_short(file, call.args[0] if call.args else call)}",
            start,
            end,
            "None",
            tags=tags,
        )
    yield from _strings(file, label, tags)


def _items(value: ast.expr | None) -> list[ast.expr]:
    return value.elts if isinstance(value, ast.List | ast.Tuple) else []


def _removals(
    file: PythonFile, family: str, label: str, items: Iterable[ast.expr], tags: tuple[str, ...]
) -> Iterator[MutantEdit]:
    """Yield the removal of each item of a list, with the comma after it."""
    for item in items:
        start, end = file.span(item)
        after = file.text[end:].lstrip()
        if after.startswith(","):
            end = file.text.index(",", end) + 1
        yield MutantEdit(family, f"{label} {_short(file, item)}", start, end, "", tags=tags)


def _short(file: PythonFile, node: ast.expr) -> str:
    """Return what tells an item of a list from others: the executable of a node, else its text."""
    executable = keyword(node, "executable") if isinstance(node, ast.Call) else None
    text = " ".join(file.segment(executable.value if executable is not None else node).split())
    return text.strip("'\"") if len(text) <= _MAX_LABEL else text[:_MAX_LABEL]


def _strings(file: PythonFile, label: str, tags: tuple[str, ...]) -> Iterator[MutantEdit]:
    ignored = list(_for_people(file))
    for literal in file.literals:
        if literal.text.strip() and not any(start <= literal.start < end for start, end in ignored):
            text = literal.text if len(literal.text) <= _MAX_LABEL else literal.text[:_MAX_LABEL]
            yield MutantEdit(
                "string misspelt", f"{label} {text}", literal.start, literal.end, misspelt(literal.text), tags=tags
            )


def _for_people(file: PythonFile) -> Iterator[tuple[int, int]]:
    """Yield the offsets of docstrings and of arguments that only people read."""
    for node in file.nodes:
        match node:
            case ast.Expr(value=ast.Constant()):
                yield file.span(node)
            case ast.keyword(arg=str(name)) if name in _FOR_PEOPLE:
                yield file.span(node)
