"""The house's one rule: a file imports lower floors only, and families of one floor do not import each other."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent / "grader"
FLOORS = {
    "errors": 0,
    "robot": 1,
    "submission": 2,
    "checks": 3,
    "grading": 4,
    "report": 6,
    "classroom": 5,
    "bundle": 5,
    "cli": 7,
    "__main__": 8,
}
# One thing, one room: where a library may be imported.
ROOMS = {
    "typer": {"cli"},
    "rich": {"cli", "report"},
    "lxml": {"robot", "report"},  # robot/xml.py hands out what others read; a report may be XML
    "yaml": {"submission"},
    "ast": {"submission"},
    "imagesize": {"submission"},
    "docx": {"submission"},
    "pypdf": {"submission"},
    "numpy": {"robot"},
    "tomllib": {"grading", "bundle"},
    "sqlite3": {"classroom"},
    "pebble": {"classroom"},
    "distributed": {"classroom"},
    "watchfiles": {"cli"},
    "csv": {"classroom"},
}
FILES = sorted(ROOT.rglob("*.py"))


def imports(path: Path) -> Iterator[str]:
    """Every module that a file imports, at the top or late."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module or ""


def room(path: Path) -> str:
    """The floor that a file stands on, by name; the package itself has none."""
    return path.relative_to(ROOT).with_suffix("").parts[0]


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_imports_point_down(path: Path) -> None:
    """No file imports from a higher floor, and every room has a floor."""
    if room(path) == "__init__":
        return
    for module in imports(path):
        parts = module.split(".")
        if parts[0] == "grader" and len(parts) > 1:
            assert FLOORS[parts[1]] <= FLOORS[room(path)], f"{path} imports {module}"
        allowed = ROOMS.get(parts[0])
        assert allowed is None or room(path) in allowed, f"{path} imports {module}"


def test_check_families_do_not_import_each_other() -> None:
    """A family of checks stands on its own: only the registry knows them all."""
    shared = {"outcome", "shown", "registry"}
    families = {path.stem for path in (ROOT / "checks").glob("*.py")} - shared - {"__init__"}
    for family in families:
        wanted = {module.removeprefix("grader.checks.") for module in imports(ROOT / "checks" / f"{family}.py")}
        assert not wanted & (families - {family}), family
