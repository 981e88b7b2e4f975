"""A module imports from lower packages and rooms only, and there is no cycle."""

import ast
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from itertools import chain
from pathlib import Path

import pytest

from grader.lab.checks.registry import own_checks

ROOT = Path(__file__).parent.parent / "grader"
# The packages, and the rooms inside each of them, from the bottom: what stands in one string does
# not import each other.
LAYERS = (
    "base",
    "files",
    "workers",
    "ros",
    "lab",
    "report",
    "classroom",
    "app plugin",
    "__main__",
)
ROOMS = {
    "base": ("errors markup merge_conflicts text reuse pairing", "source names", "problems"),
    "ros": (
        "known python xml",
        "xacro urdf build",
        "config",
        "launch",
        "package",
        "workspace",
    ),
    "lab": (
        "documents",
        "submission",
        "checks",
        "rubric",
        "grading",
        "hints",
        "authoring",
    ),
    "report": (
        "locations screen json_data",
        "criteria",
        "content",
        "drawing inspection",
        "writers",
        "pages",
        "explanations formats",
        "writing invocation",
        "open_browser repository",
    ),
    "classroom": (
        "tables",
        "roster",
        "results",
        "marks",
        "intake",
        "run",
        "gradebook",
        "lms",
        "reports",
        "commands",
        "review",
    ),
    "app": ("bundle", "hints_and_fix", "grading", "commands", "cli api"),
}
# The packages, or rooms of them, that may import a library: each has one concern.
LIBRARIES = {
    "typer": {"app.cli"},
    "rich": {"app", "report", "classroom"},
    "lxml": {"lab.documents", "ros.xml", "report", "lab.authoring"},  # of Word; a report may be XML
    "jinja2": {"report"},
    "markupsafe": {"report", "classroom.review"},
    "yaml": {"ros.config", "ros.launch", "ros.xacro"},
    "ast": {"ros.python", "ros.build", "ros.launch", "ros.package", "lab.hints", "lab.authoring"},
    "docx": {"lab.documents"},
    "pypdf": {"lab.documents"},
    "numpy": {"report", "ros.urdf"},
    "tomllib": {
        "lab.rubric",
        "app.bundle",
        "ros.known",
        "ros.build",
        "ros.launch",
        "classroom.marks",
        "report",
    },
    "pebble": {"workers"},
    "distributed": {"workers"},
    "csv": {"classroom.tables"},
}


def name_of(path: Path) -> str:
    """Return the dotted name of a module: `grader.ros.urdf.reader`."""
    parts = ("grader", *path.relative_to(ROOT).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {name_of(path): path for path in sorted(ROOT.rglob("*.py"))}


@cache
def imports(module: str) -> tuple[str, ...]:
    """Return the imports of a module, at the top, in functions or for type checkers; those of `grader` as modules."""
    return tuple(_imports(module))


def _imports(module: str) -> Iterator[str]:
    for node in ast.walk(ast.parse(MODULES[module].read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = {f"{node.module}.{alias.name}" for alias in node.names}
            yield from names & MODULES.keys() or {node.module}


def height(layers: tuple[str, ...], name: str) -> int:
    """Return the number of the layer that contains a package or a room; -1 without one."""
    return next((number for number, layer in enumerate(layers) if name in layer.split()), -1)


def points_down(module: str, imported: str) -> bool:
    """Return whether a module may import another: from lower packages, from lower rooms of its
    own package, from its own room, and libraries in their packages.
    """
    _, *place = module.split(".")
    top, *other = imported.split(".")
    if not place:
        return True
    if top != "grader":
        allowed = LIBRARIES.get(top)
        return allowed is None or not allowed.isdisjoint({place[0], ".".join(place[:2])})
    if not other:
        return True
    if other[0] != place[0]:
        return height(LAYERS, other[0]) < height(LAYERS, place[0])
    rooms = ROOMS.get(place[0])
    if rooms is None or place[1:2] == other[1:2]:
        return True
    return height(rooms, other[1]) < height(rooms, place[1])


def test_imports_point_down() -> None:
    """No module imports from a higher package or room, and each library has its packages."""
    found = [(module, imported) for module in MODULES for imported in imports(module)]
    assert [pair for pair in found if not points_down(*pair)] == []


def test_no_import_cycle() -> None:
    """No module imports itself by way of others, not even in a function or for type checkers."""
    graph = {
        module: {name for name in imports(module) if name in MODULES} - {module}
        for module in MODULES
    }
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
    """Every package, and every room of a package that has rooms, is in exactly one layer."""
    places = {tuple(module.split(".")[1:3]) for module in MODULES} - {()}
    packages = {place[0] for place in places}
    assert sorted(" ".join(LAYERS).split()) == sorted(packages)
    for package, layers in ROOMS.items():
        rooms = {place[1] for place in places if place[0] == package and len(place) > 1}
        assert sorted(" ".join(layers).split()) == sorted(rooms), package


# What names its functions itself: the registry of checks, the commands of typer, the Python API.
NAMED_BY_OTHERS = (
    "grader.lab.checks.",
    "grader.plugin",
    "grader.app.cli.",
    "grader.app.api",
    "grader.__main__",
)


@pytest.mark.slow
def test_names_of_one_module_are_private() -> None:
    """A function, class or constant that no other module imports, of the grader or of its tests, starts with an underscore."""
    others = chain.from_iterable(
        (ROOT.parent / folder).rglob("*.py") for folder in ("tests", "benchmarks", "docs")
    )
    readable = [path for path in others if "setup_samples" not in path.parts]
    used = {name for path in (*MODULES.values(), *readable) for name in used_names(path)}
    own = [
        (module, name)
        for module in MODULES
        for name in defined_names(module)
        if not name.startswith("_")
    ]
    assert [f"{module}.{name}" for module, name in own if f"{module}.{name}" not in used] == []


def defined_names(module: str) -> Iterator[str]:
    """Yield the functions, classes and constants that a module defines at its top, of those that only modules import."""
    for node in (
        ast.parse(MODULES[module].read_text(encoding="utf-8")).body
        if not module.startswith(NAMED_BY_OTHERS)
        else ()
    ):
        match node:
            case ast.FunctionDef() | ast.ClassDef():
                yield node.name
            case ast.Assign(targets=targets):
                yield from (
                    name.id
                    for target in targets
                    for name in ast.walk(target)
                    if isinstance(name, ast.Name) and isinstance(name.ctx, ast.Store)
                )
            case ast.AnnAssign(target=ast.Name(id=name)):
                yield name


def used_names(path: Path) -> Iterator[str]:
    """Yield the names that a module takes from others, `grader.base.names.near`: imported, or by way of an imported module."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    modules: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            for alias in node.names:
                full = f"{node.module}.{alias.name}"
                if full in MODULES:
                    modules[alias.asname or alias.name] = full
                yield full
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id=name), attr=attribute) if name in modules:
                yield f"{modules[name]}.{attribute}"
            case ast.Constant(value=str(text)) if (
                ":" in text
            ):  # "module:function", which is imported late
                yield from (
                    f"{package}.{text.replace(':', '.')}" for package in ("grader", "grader.report")
                )
