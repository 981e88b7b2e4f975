"""A module imports from lower layers only, packages of one layer do not import each other, and there is no cycle."""

import ast
from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter
from itertools import chain
from pathlib import Path

import pytest

from grader.checks.registry import own_checks

ROOT = Path(__file__).parent.parent / "grader"
LAYERS = (
    ("errors", "markup", "text"),
    ("source", "names"),
    ("problems", "edits", "difference"),
    ("files", "static_python", "xml"),
    ("xacro", "robot", "documents", "package"),
    ("submission",),
    ("checks",),
    ("grading",),
    ("mutation", "authoring"),
    ("classroom", "bundle", "drawing"),
    ("report",),
    ("usecases",),
    ("cli",),
    ("__main__",),
)
# The layers inside a package that is large enough to have its own.
INNER = {
    "classroom": (
        ("students",),
        ("matching", "tables"),
        ("typed_names",),
        ("intake", "lms"),
        ("gradebook",),
        ("run", "review"),
    ),
}
# The packages that may import a library: each has one concern.
LIBRARIES = {
    "typer": {"cli"},
    "rich": {"cli", "report", "usecases"},
    "lxml": {"xml", "report", "mutation"},  # a report may be XML; a robot is rewritten as a tree
    "jinja2": {"report"},
    "markupsafe": {"report"},
    "yaml": {"package", "xacro"},
    "ast": {"static_python", "package", "mutation"},
    "docx": {"documents"},
    "pypdf": {"documents"},
    "numpy": {"robot"},
    "tomllib": {"grading", "bundle"},
    "sqlite3": {"classroom"},
    "pebble": {"classroom"},
    "distributed": {"classroom"},
    "csv": {"classroom"},
}


def name_of(path: Path) -> str:
    """Return the dotted name of a module: `grader.robot.reader`."""
    parts = ("grader", *path.relative_to(ROOT).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {name_of(path): path for path in sorted(ROOT.rglob("*.py"))}


def imports(module: str) -> Iterator[str]:
    """Yield the imports of a module, at the top, in functions or for type checkers; those of `grader` as modules."""
    for node in ast.walk(ast.parse(MODULES[module].read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = {f"{node.module}.{alias.name}" for alias in node.names}
            yield from names & MODULES.keys() or {node.module}


def height(layers: tuple[tuple[str, ...], ...], name: str) -> int:
    """Return the number of the layer that contains a package or module."""
    return next(number for number, layer in enumerate(layers) if name in layer)


@pytest.mark.parametrize("module", MODULES)
def test_imports_point_down(module: str) -> None:
    """No module imports from a higher layer or from another package of its own, and each library has its packages."""
    _, *first = module.split(".")
    if not first:
        return
    for imported in imports(module):
        top, *second = imported.split(".")
        allowed = LIBRARIES.get(top)
        assert allowed is None or first[0] in allowed, f"{module} imports {imported}"
        if top != "grader" or not second:
            continue
        if second[0] != first[0]:
            assert height(LAYERS, second[0]) < height(LAYERS, first[0]), f"{module} imports {imported}"
        elif first[0] in INNER and len(first) > 1 and second[1] != first[1]:
            inner = INNER[first[0]]
            assert height(inner, second[1]) < height(inner, first[1]), f"{module} imports {imported}"


def test_no_import_cycle() -> None:
    """No module imports itself by way of others, not even in a function or for type checkers."""
    graph = {module: {name for name in imports(module) if name in MODULES} - {module} for module in MODULES}
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(" -> ".join(error.args[1]))


def test_check_families_do_not_import_each_other() -> None:
    """Only the registry imports families of checks."""
    families = {check.function.__module__ for check in own_checks()}
    for family in families:
        assert not set(imports(family)) & (families - {family}), family


def test_every_package_has_a_layer() -> None:
    """Every package and top-level module is in exactly one layer."""
    named = list(chain.from_iterable(LAYERS))
    assert sorted(named) == sorted(
        {path.relative_to(ROOT).with_suffix("").parts[0] for path in MODULES.values()} - {"__init__"}
    )
