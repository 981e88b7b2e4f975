"""A module imports from lower packages and rooms only, and there is no cycle."""

import ast
import re
import tokenize
from collections import Counter
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from importlib import import_module
from io import StringIO
from itertools import chain
from pathlib import Path

import pytest

from grader.lab.checks.registry import own_checks
from grader.workspace.rules.rule_table import list_readers
from tests.prose import COMPREHENSIONS, Prose, size
from tests.weight import MAX_NODES, count_nodes, table

ROOT = Path(__file__).parent.parent / "grader"
TESTS = Path(__file__).parent
# The packages, and the rooms inside each of them, from the bottom: what stands in one string does
# not import each other.
LAYERS = (
    "base",
    "files",
    "workers",
    "ros",
    "workspace",
    "lab",
    "report",
    "classroom",
    "app plugin",
    "__main__",
)
ROOMS = {
    "base": (
        "grouping patterns records",
        "errors late_names markup merge_conflicts text reuse pairing transforms quantities",
        "source names processor_time toml_types",
        "extents problems element_edits toml_file",
        "ignore_comments slips",
    ),
    "ros": (
        "known",
        "python xml",
        "xacro urdf installation mesh interfaces cpp",
        "slips",
        "config recording",
        "launch",
        "package",
        "nodes",
        "api",
    ),
    "workspace": ("model", "graph", "rules", "opening", "index", "log", "api"),
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
        "causes locations screen json_data statuses",
        "criteria readings",
        "content",
        "drawing examples inspection",
        "findings shown_graph",
        "mistakes",
        "writers",
        "pages",
        "explanations formats",
        "writing invocation written_files",
        "open_browser repository",
        "local_server",
    ),
    "classroom": (
        "tables",
        "spreadsheet",
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
    "app": (
        "baseline bundle log_input saving settings",
        "ignoring hints_and_fix",
        "grading",
        "commands editor",
        "cli api",
    ),
}
# The packages, or rooms of them, that may import a library: each has one concern.
LIBRARIES = {
    "typer": {"app.cli"},
    "rich": {"app", "report", "classroom"},
    "lxml": {"lab.documents", "ros.xml", "report", "lab.authoring"},  # of Word; a report may be XML
    "jinja2": {"report"},
    "markupsafe": {"report", "classroom.review"},
    "yaml": {"ros.config", "ros.launch", "ros.xacro"},
    "ast": {
        "ros.python",
        "ros.installation",
        "ros.launch",
        "ros.package",
        "ros.nodes",
        "lab.hints",
        "lab.authoring",
    },
    "tree_sitter": {"ros.cpp"},
    "tree_sitter_cpp": {"ros.cpp"},
    "docx": {"lab.documents"},
    "pypdf": {"lab.documents"},
    "numpy": {"report", "ros.urdf", "ros.mesh", "base.transforms"},
    "tomllib": {
        "base.toml_file",
        "app.bundle",
        "ros.known",
        "ros.installation",
        "ros.launch",
        "classroom.marks",
        "report",
    },
    "sqlite3": {"ros.recording"},
    "pebble": {"workers"},
    "distributed": {"workers"},
    "csv": {"classroom.tables"},
    "xlsxwriter": {"classroom.spreadsheet"},
    "pyflakes": {"ros.nodes"},
    "pygls": {"app.editor"},
    "lsprotocol": {"app.editor"},
}


# How dense the code may be: see `tests/prose.py`. A limit may only get lower.
LIMITS = {
    "nodes of a simple statement, mean": 13.1,
    "nodes of a simple statement, 90th percentile": 24,
    "comprehensions for each 1,000 nodes": 5.3,
    "conditional expressions for each 1,000 nodes": 3.0,
    "comprehensions that hold another": 6,
    "conditional expressions that hold another": 0,
    "simple statements with several comprehensions": 15,
    "packed functions over 300 nodes": 4,
    "packed functions over 200 nodes": 18,
    "small private functions that are used once": 14,
    "code that reads a message": 1,
    "names of ros that other packages import, besides its API": 116,
    "names of the workspace that other packages import, besides its API": 16,
}


def name_of(path: Path) -> str:
    """Return the dotted name of a module: `grader.ros.urdf.reader`."""
    parts = ("grader", *path.relative_to(ROOT).with_suffix("").parts)
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


APIS = ("grader.ros.api", "grader.workspace.api")
MODULES = {name_of(path): path for path in sorted(ROOT.rglob("*.py"))}


@cache
def imports(module: str) -> tuple[str, ...]:
    """Return the imports of a module, at the top, in functions or for type checkers; those of `grader` as modules."""
    return tuple(_imports(module))


def _imports(module: str) -> Iterator[str]:
    for node in ast.walk(prose().trees[module]):
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
    if rooms is None:
        return True
    if place[1:2] == other[1:2]:
        return True
    return height(rooms, other[1]) < height(rooms, place[1])


def test_imports_point_down() -> None:
    """No module imports from a higher package or room, and each library has its packages."""
    wrong = [
        f"{module} imports {imported}{_rooms_that_may_import(imported)}"
        for module in MODULES
        for imported in imports(module)
        if not points_down(module, imported)
    ]
    assert wrong == []


def _rooms_that_may_import(imported: str) -> str:
    """Return which rooms may import a library; empty for a module of the project."""
    allowed = LIBRARIES.get(imported.partition(".")[0])
    return f", which only {', '.join(sorted(allowed))} may import" if allowed else ""


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


def test_no_module_of_a_grading_reads_settings() -> None:
    """Only the inspection imports them."""
    for module in ("grader.app.grading", "grader.app.commands.watch", "grader.app.api"):
        assert not {"grader.app.settings", "grader.app.ignoring"} & {*imports(module)}


def test_what_is_above_lab_imports_from_ros_and_the_workspace_by_their_apis() -> None:
    """The commands, reports, classes and plug-ins name no module inside of them, also not for type checkers."""
    places = {
        (module, imported)
        for module in MODULES
        if module.split(".")[1:2] in (["app"], ["report"], ["classroom"], ["plugin"])
        for imported in imports(module)
        if imported.startswith(("grader.ros", "grader.workspace"))
    }
    assert len(places) > 20
    assert {pair for pair in places if pair[1] not in APIS} == set()


@pytest.mark.parametrize("name", APIS)
def test_an_api_has_the_names_that_type_checkers_see(name: str) -> None:
    """Each name of the API is the one of the module that it is imported from for type checkers."""
    api = import_module(name)
    typed = list(names_of_api(name))
    assert sorted(" ".join(api._NAMES.values()).split()) == sorted(name for _, name in typed)
    for module, imported in typed:
        assert getattr(api, imported) is getattr(import_module(module), imported)
    with pytest.raises(AttributeError, match="no attribute 'Submission'"):
        api.Submission  # noqa: B018


def names_of_api(api: str) -> Iterator[tuple[str, str]]:
    """Yield the modules of a package with the names of its public API."""
    package = api.removesuffix("api")
    for node in ast.walk(prose().trees[api]):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(package):
            yield from ((str(node.module), alias.name) for alias in node.names)


# Types that packages share, and whose names say what they are: of URDF, of ROS 2, and of a graph.
PLAIN = frozenset(
    {
        *("Box", "Capsule", "Cylinder", "Mesh", "Origin", "Sphere", "Visual", "UnknownShape"),
        *("Qos", "StatedReleases", "MeshLoader", "LogAnswer", "NamePlaces", "WrittenName"),
        "TypedPlace",
        *(
            "Recording",
            "RecordingFiles",
            "RecordedTopic",
            "FrameComparison",
            "WheelTravel",
            "DescribedRecording",
            "HeardTopic",
        ),
        *("GraphNode", "GraphEnd", "GraphTransform", "Connection", "EndedProcess", "GivenValue"),
    }
)


def test_words_of_the_architecture_are_those_of_the_code() -> None:
    """Each word of the page's table is the name of a type, a function or a module."""
    known = {name.rpartition(".")[2] for name in MODULES}
    for tree in prose().trees.values():
        for node in tree.body:
            match node:
                case ast.ClassDef(name=name) | ast.FunctionDef(name=name):
                    known.add(name)
                case ast.Assign(targets=[ast.Name(id=name)]) if not name.isupper():
                    known.add(name)  # a type that has another name
    words = explained_words()
    assert len(words) > 30
    assert [word for word in words if word not in known] == []
    assert [word for word, count in Counter(words).items() if count > 1] == []


def test_types_that_packages_share_are_explained() -> None:
    """Each class of an API is in the table of words, on the page of the Python API, or its name says what it is."""
    api = (ROOT.parent / "docs/python.md").read_text(encoding="utf-8")
    shared = set(shared_classes())
    code = " ".join(re.findall(r"```.*?```|`[^`]+`", api, re.DOTALL))
    explained = {*explained_words(), *re.findall(r"\w+", code)}
    assert len(shared) > 40
    assert shared - explained - PLAIN == set()
    assert PLAIN - (shared - explained) == set()


def explained_words() -> list[str]:
    """Return the words in the first column of the table of words in docs/architecture.md."""
    page = (ROOT.parent / "docs/architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`.*?) \|", page.partition("\n## Words\n")[2], re.MULTILINE)
    return re.findall(r"`(\w+)`", " ".join(rows))


def shared_classes() -> Iterator[str]:
    """Yield the classes that the APIs of packages and the module for plug-ins export."""
    for module in (*APIS, "grader.plugin"):
        for node in ast.walk(prose().trees[module]):
            if isinstance(node, ast.ImportFrom) and node.module in prose().trees:
                body = prose().trees[node.module].body
                classes = {it.name for it in body if isinstance(it, ast.ClassDef)}
                yield from (alias.name for alias in node.names if alias.name in classes)


@pytest.mark.slow
def test_ros_and_the_workspace_know_no_lab_and_no_submission() -> None:
    """No name in them speaks of these, and no docstring or comment."""
    words = re.compile(r"(?i)submission|\blab(?:s|\b|_)")
    texts = {
        path.relative_to(ROOT).as_posix(): chain(*_words_of_code(path))
        for module, path in MODULES.items()
        if module.startswith(("grader.ros.", "grader.workspace."))
    }
    found = {(path, text) for path, lines in texts.items() for text in lines if words.search(text)}
    assert found == set()


def _words_of_code(path: Path) -> Iterator[list[str]]:
    """Yield the names of a file's code, its comments and its docstrings."""
    source = path.read_text(encoding="utf-8")
    tokens = [*tokenize.generate_tokens(StringIO(source).readline)]
    yield [token.string for token in tokens if token.type in (tokenize.NAME, tokenize.COMMENT)]
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef)
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, kinds):
            yield [ast.get_docstring(node) or ""]


def test_no_type_of_a_workspace_has_many_members() -> None:
    """A type of the model or of the graph with more than twenty fields and methods is two things."""
    many = {}
    for module in MODULES:
        if module.startswith(("grader.workspace.model.", "grader.workspace.graph.")):
            classes = [it for it in prose().trees[module].body if isinstance(it, ast.ClassDef)]
            for node in classes:
                members = sum(isinstance(it, ast.FunctionDef | ast.AnnAssign) for it in node.body)
                many[node.name] = members
    assert len(many) > 10
    assert {name: members for name, members in many.items() if members > 20} == {}


def test_only_rules_say_that_something_does_not_agree() -> None:
    """Each finding of a workspace is made in the room `rules`, by a function that names the rule's row."""
    makers = {"Mismatch", "warning", "problem"}
    places = []
    for module, tree in prose().trees.items():
        if module.startswith("grader.workspace.rules."):
            continue
        for node in ast.walk(tree):
            if not isinstance(node, ast.Call):
                continue
            if ast.unparse(node.func).rpartition(".")[2] in makers:
                places.append((module, node.lineno))
    assert places == []


def test_modules_of_checks_do_not_import_each_other() -> None:
    """Only the registry imports modules of checks."""
    modules = {check.function.__module__ for check in own_checks()}
    for module in modules:
        assert not set(imports(module)) & (modules - {module}), module


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
    used |= {f"grader.workspace.rules.{reader}" for reader in list_readers()}
    own = [
        (module, name)
        for module in MODULES
        for name in defined_names(module)
        if not name.startswith("_")
    ]
    assert [f"{module}.{name}" for module, name in own if f"{module}.{name}" not in used] == []


def defined_names(module: str) -> Iterator[str]:
    """Yield the functions, classes and constants that a module defines at its top, of those that only modules import."""
    for node in prose().trees[module].body if not module.startswith(NAMED_BY_OTHERS) else ():
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


@cache
def prose() -> Prose:
    """Return the code of the grader, which is parsed once."""
    return Prose(MODULES)


def figures_of_prose() -> dict[str, float]:
    """Return the figures of how dense the code is."""
    code = prose()
    sizes = [size(statement) for statement in code.simple_statements]
    nodes = count_nodes()
    comprehensions = sum(code.kinds[kind] for kind in COMPREHENSIONS)
    return {
        "nodes of a simple statement, mean": sum(sizes) / len(sizes),
        "nodes of a simple statement, 90th percentile": sizes[len(sizes) * 9 // 10],
        "comprehensions for each 1,000 nodes": 1000 * comprehensions / nodes,
        "conditional expressions for each 1,000 nodes": 1000 * code.kinds[ast.IfExp] / nodes,
        "comprehensions that hold another": len(code.holding(COMPREHENSIONS)),
        "conditional expressions that hold another": len(code.holding((ast.IfExp,))),
        "simple statements with several comprehensions": code.crowded_statements(),
        "packed functions over 300 nodes": sum(it.is_packed(300) for it in code.functions),
        "packed functions over 200 nodes": sum(it.is_packed(200) for it in code.functions),
        "small private functions that are used once": len(code.tiny_functions()),
        "code that reads a message": len(code.comparisons_of_messages()),
        "names of ros that other packages import, besides its API": len(names_from("ros")),
        "names of the workspace that other packages import, besides its API": len(
            names_from("workspace")
        ),
    }


def names_from(package: str) -> set[tuple[str, str]]:
    """Return the modules of `ros` or `workspace` with the names that higher packages import from them, and that are not of
    its API.
    """
    prefix = f"grader.{package}."
    pairs: set[tuple[str, str]] = set()
    for module in MODULES:
        if module.startswith((prefix, "grader.workspace.")):
            continue
        for node in ast.walk(prose().trees[module]):
            if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(prefix):
                pairs |= {(str(node.module), alias.name) for alias in node.names}
    return {pair for pair in pairs - {*names_of_api(f"{prefix}api")} if pair[0] not in APIS}


def test_no_test_replaces_a_name_that_another_module_imports() -> None:
    """A name is replaced in the module that uses it.

    A module that imports the name by `from` before the test does not see the replacement, and one that imports it
    during the test keeps it for all later tests: the result would depend on their order.
    """
    imported = {name for module in MODULES for name in _names_by_from(prose().trees[module])}
    replaced = {
        (name, path.relative_to(TESTS).as_posix())
        for path in TESTS.rglob("*.py")
        for name in _replaced_names(path)
    }
    assert len(replaced) > 20
    assert [pair for pair in sorted(replaced) if pair[0] in imported] == []


def test_no_test_writes_into_the_folder_around_those_of_others() -> None:
    """A package.xml there would make each folder of a later test a part of its package."""
    name = "get" + "basetemp"
    assert [path for path in TESTS.rglob("*.py") if name in path.read_text("utf-8")] == []


def _names_by_from(tree: ast.Module) -> Iterator[str]:
    """Yield the names that a module keeps from its import on; an import in a function looks again in each call."""
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def _replaced_names(path: Path) -> Iterator[str]:
    """Yield the names of the grader's modules that a test replaces, `grader.base.names.near`."""
    text = path.read_text(encoding="utf-8")
    if "setattr(" not in text and "patch" not in text:
        return
    tree = ast.parse(text)
    modules: dict[str, str] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            modules |= {it.asname or it.name: f"{node.module}.{it.name}" for it in node.names}
        elif isinstance(node, ast.Import):
            modules |= {it.asname: it.name for it in node.names if it.asname}
    for node in ast.walk(tree):
        match node:
            case ast.Constant(value=str(name)) if name.rpartition(".")[0] in MODULES:
                yield name
            case ast.Call(
                func=ast.Attribute(attr="setattr" | "object"),
                args=[target, ast.Constant(value=str(name)), *_],
            ):
                module = ast.unparse(target)
                module = modules.get(module, module)
                if module in MODULES:
                    yield f"{module}.{name}"


@pytest.mark.slow
def test_the_code_stays_within_its_budget() -> None:
    """All code together has at most MAX_NODES nodes; the table says where they are."""
    nodes = count_nodes()
    assert nodes <= MAX_NODES, f"remove code, or take the feature out\n{table()}"


@pytest.mark.slow
def test_the_code_gets_no_denser() -> None:
    """No figure is above its limit, and no limit is far above its figure: limits only get tighter."""
    figures = figures_of_prose()
    assert figures.keys() == LIMITS.keys()
    assert {name: value for name, value in figures.items() if value > LIMITS[name]} == {}
    assert {name: value for name, value in figures.items() if value < 0.9 * LIMITS[name] - 2} == {}


def test_names_are_unique() -> None:
    """No two classes have one name, nor two modules of one package."""
    assert prose().repeated_class_names() == {}
    modules = [path for path in MODULES.values() if path.stem != "__init__"]
    names = Counter((path.relative_to(ROOT).parts[0], path.stem) for path in modules)
    assert [name for name, count in names.items() if count > 1] == []
