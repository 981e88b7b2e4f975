"""What Python code uses and nothing defines: names, messages of a module, fields of messages."""

import ast
from collections.abc import Collection, Iterable, Sequence

from grader.base.names import near
from grader.base.problems import NO_FIXES, Fixes
from grader.base.source import Source
from grader.base.text import first_part
from grader.ros.interfaces.interface_types import Interface
from grader.ros.interfaces.known_interfaces import known_interfaces
from grader.ros.known.package_tables import INTERFACE_KINDS, interface_table, python_table
from grader.ros.known.python_names import python_names
from grader.ros.known.releases import Release
from grader.ros.nodes.node_facts import (
    CodeFault,
    CodeFaults,
    FieldUse,
)
from grader.ros.nodes.python.code_edits import CodeEdits
from grader.ros.nodes.used_fields import resolve_field
from grader.ros.python.bindings import names_bound
from grader.ros.python.constants import binds_unseen
from grader.ros.python.library import find_meant_module
from grader.ros.python.parse import Code, Position, every_node, location_in, make_position
from grader.ros.python.walking import walk

# Messages of pyflakes about what certainly fails when it runs.
_CERTAIN = frozenset(
    {
        "UndefinedName",
        "UndefinedLocal",
        "StringDotFormatMissingArgument",
        "PercentFormatPositionalCountMismatch",
        "PercentFormatMissingArgument",
        "PercentFormatExpectedMapping",
        "PercentFormatExpectedSequence",
    }
)
# Names that each module has, or that another system defines.
_ELSEWHERE = frozenset({"__file__", "__builtins__", "__annotations__", "WindowsError"})
# What students forget to import: modules, and names in them.
_MODULES = ("rclpy", "math", "time", "os", "sys", "random")
_IMPORTED = {"Node": "rclpy.node"}
# Packages with the messages that nodes usually send, and names in them that other libraries have.
_MESSAGES = ("std_msgs", "geometry_msgs", "sensor_msgs", "nav_msgs", "builtin_interfaces")
_OF_OTHERS = ("Image", "Path")


def undefined_names(code: Code) -> CodeFaults:
    """Yield the names that are not defined, wherever they are used.

    Texts that are formatted with too little are yielded, too.
    """
    from pyflakes.checker import Checker  # late: few commands read the code of nodes

    class ReleaseChecker(Checker):
        # Instead of those of the Python that runs it.
        builtIns = set[str]()  # noqa: N815, RUF012

    nodes = code.nodes
    if binds_unseen(nodes):
        return
    try:
        names = python_names("builtins", code.releases) | _ELSEWHERE
        checker = ReleaseChecker(code.tree, builtins=names)
    except RecursionError:
        return
    unevaluated = _unevaluated(code.tree)
    bound = names_bound(nodes)
    for message in sorted(checker.messages, key=lambda fault: (fault.lineno, fault.col)):
        at = Position(message.lineno, message.col + 1)
        kind = type(message).__name__
        if kind in _CERTAIN and at not in unevaluated:
            fixes = NO_FIXES
            if kind == "UndefinedName":
                fixes = _define(code, str(message.message_args[0]), at, bound)
            text = message.message % message.message_args
            yield CodeFault("name-binding", text, location_in(code.source, at), fixes=fixes)


def _define(code: Code, name: str, at: Position, bound: Collection[str]) -> Fixes:
    """Return the fix that imports a name, or writes the one that surely is meant."""
    edits = CodeEdits(code.source)
    module = _IMPORTED.get(name) or _module_of_message(name)
    if module or name in _MODULES:
        statement = f"from {module} import {name}" if module else f"import {name}"
        for first in code.tree.body:
            is_import = isinstance(first, ast.Import | ast.ImportFrom)
            if is_import and getattr(first, "module", "") != "__future__":
                return edits.add_before(first, statement)
        return NO_FIXES
    # A class is no variable: Marker and marker.
    is_class = name[:1].isupper()
    meant = near(name, [other for other in bound if other[:1].isupper() == is_class])
    if meant is None:
        return NO_FIXES
    location = location_in(code.source, at)
    start = code.source.start_offset(location)
    return edits.rewrite(start, start + len(name), meant)


def _module_of_message(name: str) -> str:
    """Return the module of the only well-known message of a name; empty if there is none."""
    modules = [
        f"{package}.msg"
        for package in _MESSAGES
        if name in (interface_table(package) or {}).get("msg", {})
    ]
    return modules[0] if len(modules) == 1 and name not in _OF_OTHERS else ""


def _unevaluated(tree: ast.Module) -> set[Position]:
    """Return the places in annotations, which Python does not always evaluate."""
    places = set()
    for node in every_node(tree):
        annotation = getattr(node, "annotation", None) or getattr(node, "returns", None)
        for part in walk(annotation) if annotation is not None else ():
            if isinstance(part, ast.expr):
                places.add(make_position(part))
    return places


def wrong_imports(code: Code, own_modules: Collection[str]) -> CodeFaults:
    """Yield the first import of a well-known message or module that certainly fails.

    Only statements of the module itself count: others may be prepared for a failure. `own_modules`
    are those of its package.
    """
    for statement in code.tree.body:
        imports: list[tuple[str, list[str]]] = []
        match statement:
            case ast.Import(names=names):
                imports = [(alias.name, []) for alias in names]
            case ast.ImportFrom(module=str(module), names=names, level=0):
                imports = [(module, [alias.name for alias in names])]
        for module, imported in imports:
            message, meant = _why_wrong(module, imported)
            if message and first_part(module) not in own_modules:
                fixes = CodeEdits(code.source).rewrite_in(statement, module, meant)
                yield CodeFault("name-binding", message, code.at(statement), fixes=fixes)
                return


def _why_wrong(module: str, names: Sequence[str]) -> tuple[str, str]:
    """Return why an import fails, and the module that is meant; empty for one that may not."""
    package, _, section = module.partition(".")
    if first_part(section) in INTERFACE_KINDS:
        return "", ""
    for kind, known in (interface_table(package) or {}).items():
        for name in names:
            if name in known:
                meant = f"{package}.{kind}"
                message = f"{module} has no {name}: write from {meant} import {name}"
                return message, meant if known.keys() >= {*names} else ""
    other = find_meant_module(module, python_table().modules)
    if other is None:
        return "", ""
    guess = f"; did you mean {other}?" if other else ": it is of ROS 1"
    return f"there is no module {module}{guess}", other


def wrong_fields(
    source: Source, uses: Iterable[FieldUse], releases: Collection[Release]
) -> CodeFaults:
    """Yield the fields that well-known types do not have, where it is sure what is meant."""

    def find(package: str, name: str) -> Interface | None:
        return (known_interfaces(package, tuple(releases)) or {}).get(name)

    for use in uses:
        used = resolve_field(use, find)
        if not used or not used.is_absent:
            continue
        meant = used.find_meant(find, is_sure=True)
        if meant is not None:
            start = source.offset(use.location.line, use.location.column)
            fixes = CodeEdits(source).rewrite(start, start + len(used.name), meant)
            message = f"{used.owner} has no {used.noun} {used.name}"
            yield CodeFault("interface-field", message, use.location, fixes=fixes)


def wrong_objects(source: Source, uses: Iterable[FieldUse]) -> CodeFaults:
    """Yield the objects of rclpy that code uses in place of their values, or that lack a name."""
    edits = CodeEdits(source)
    for use in uses:
        if not use.instead:
            continue
        name, lacks, end = use.instead
        is_field = not use.type.startswith("rclpy.")
        if not lacks:
            yield from _wrong_member(source, use, name)
            continue
        where = f"the field {use.path[-1]} gets" if is_field else "Python cannot compute with"
        message = f"{where} a {name} of rclpy: write {lacks} behind it"
        fixes = edits.insert(source.start_offset(end), lacks, f"`{lacks}` is added")
        yield CodeFault("value-object", message, use.location, fixes=fixes)


def _wrong_member(source: Source, use: FieldUse, name: str) -> CodeFaults:
    """Yield that an object of rclpy has no attribute of a name, or is computed with a field."""
    written = use.path[-1]
    members = python_table().members[name]
    shown = name.removeprefix("Rcutils")
    if written in members:
        message = (
            "an rclpy Time cannot be combined with this: use Time.from_msg() for a stamp and "
            "Duration(seconds=...) for a number"
        )
        yield CodeFault("value-object", message, use.location)
        return
    meant = near(written, members)
    if meant is not None:
        start = source.start_offset(use.location)
        fixes = CodeEdits(source).rewrite(start, start + len(written), meant)
        message = f"a {shown} of rclpy has no attribute {written}; did you mean {meant}?"
        yield CodeFault("name-binding", message, use.location, fixes=fixes)
    elif shown == name:  # what has more attributes in no release
        message = f"a {shown} of rclpy has no attribute {written}"
        if written in ("sec", "nanosec"):
            message = f"{message}: write .to_msg() before it"
        yield CodeFault("name-binding", message, use.location)
