"""Mutants of what the files of a workspace agree on.

These are names, values in YAML, what CMake installs, and dependencies.
"""

from collections.abc import Iterable, Iterator
from posixpath import basename

from grader.base.patterns import on_use
from grader.base.source import Edit, Source
from grader.lab.authoring.mutants import (
    MAX_LABEL,
    MutantEdit,
    MutantEdits,
    misspelt,
    mutants,
)
from grader.lab.submission.submission import Submission
from grader.ros.config.yaml_nodes import YamlNode, yaml_root
from grader.ros.package.package import CMAKE, MANIFEST
from grader.workspace.rules.name_fixes import NameFixes
from grader.workspace.rules.names import Fact, Use
from grader.workspace.rules.reading import compared_facts
from grader.workspace.rules.rule_table import Family

_YAML = (".yaml", ".yml")
_NUMBER = on_use(r"[-+]?(?:\d++\.?\d*+|\.\d++)(?:[eE][-+]?\d++)?")
_INSTALL = on_use(r"(?im)^[ \t]*install[ \t]*\([^()]*\)")
_DEPENDENCY = on_use(r"<((?:build_|build_export_|exec_)?depend)\b[^<>]*+>\s*+([\w-]++)\s*+</\1>")
_DIRECTIONS = {"GZ_TO_ROS": "ROS_TO_GZ", "ROS_TO_GZ": "GZ_TO_ROS"}
_REVERSED = {"true": "false", "false": "true", "True": "False", "False": "True"}
ComparedName = tuple[Fact, Edit]  # with the edit that misspells it


def compared_names(submission: Submission, families: Iterable[Family]) -> Iterator[ComparedName]:
    """Yield the names of these families that files use or define.

    Each has the edit that misspells it there.
    """
    known = frozenset(families)
    name_fixes = NameFixes(submission.workspace)
    for fact in compared_facts(submission.workspace, known) if known else ():
        for edit in name_fixes.edits(fact.location, fact.name, misspelt(fact.name))[:1]:
            yield fact, edit


def name_changes(
    source: Source, names: Iterable[ComparedName], families: Iterable[Family]
) -> MutantEdits:
    """Yield the changes of a file of a package.

    Those of its format come first, then those of the names in it that are compared.
    """
    name = basename(source.path)
    if name == CMAKE:
        for match in _INSTALL.finditer(source.text):
            place = " ".join(match[0].split())[:MAX_LABEL]
            yield MutantEdit("install removed", place, *match.span(), "")
    elif name == MANIFEST and "dependencies" in families:
        for match in _DEPENDENCY.finditer(source.text):
            yield MutantEdit("dependency removed", f"{match[1]} {match[2]}", *match.span(), "")
    elif name.endswith(_YAML):
        yield from _yaml_changes(source)
    elif name.endswith((".sdf", ".world")) and "topics" in families:
        yield from _world_changes(source)
    yield from _name_edits(source, names)


def _name_edits(source: Source, names: Iterable[ComparedName]) -> MutantEdits:
    """Yield the changes of the compared names that are in a file."""
    for fact, edit in names:
        if edit.path == source.path:
            start = source.start_offset(edit)
            mutation = "name misspelt" if isinstance(fact, Use) else "definition renamed"
            yield MutantEdit(mutation, edit.old, start, start + len(edit.old), edit.new)


def _world_changes(source: Source) -> MutantEdits:
    """Yield that a system or sensor of a world is missing, or another one."""
    for mutant in mutants(source.text):
        place = mutant.id.partition(": ")[2]
        element = basename(place).partition(" ")[0]
        if element in ("plugin", "sensor", "topic") and mutant.mutation in (
            "element deleted",
            "text misspelt",
            "attribute deleted",
        ):
            mutation = f"world {mutant.mutation}"
            yield MutantEdit(mutation, place, mutant.start, mutant.end, mutant.new)


def _bridge_changes(source: Source, root: YamlNode) -> MutantEdits:
    """Yield that a row of a bridge is missing, or has the other direction."""
    rows = [row for row in root.items if isinstance(row.value, dict) and row.value]
    starts = [_start_of_item(source, row) for row in rows]
    if not rows:
        return
    for row, start, end in zip(rows, starts, [*starts[1:], len(source.text)], strict=True):
        topic = row.get("ros_topic_name") or row.get("topic_name")
        if not topic or not topic.text:
            continue
        if start is not None and end is not None:
            yield MutantEdit("bridge row removed", topic.text, start, end, "")
        direction = row.get("direction")
        if direction and direction.text in _DIRECTIONS:
            other = _DIRECTIONS[direction.text]
            yield MutantEdit("bridge direction reversed", topic.text, *direction.span, other)


def _start_of_item(source: Source, row: YamlNode) -> int | None:
    """Return the offset of the dash before a table in a list; None if it is written in braces."""
    at = row.key_location(str(next(iter(row.value))))
    first = source.start_offset(at)
    dash = source.text.rfind("-", 0, first)
    return dash if dash >= 0 and not source.text[dash + 1 : first].strip() else None


def _yaml_changes(source: Source) -> MutantEdits:
    root = yaml_root(source)
    if root:
        yield from _bridge_changes(source, root)
        yield from _node_changes(source, "", root, set())


def _node_changes(source: Source, label: str, node: YamlNode, seen: set[YamlNode]) -> MutantEdits:
    """Yield that each value is another one, and each key of a table misspelt; of an anchor once."""
    if node in seen:
        return
    seen.add(node)
    if node.text is not None:
        yield from _scalar_changes(source, label.removesuffix("."), node)
    for number, item in enumerate(node.items, 1):
        yield from _node_changes(source, f"{label}{number}.", item, seen)
    for key, inner in node.value.items() if isinstance(node.value, dict) else ():
        start = source.start_offset(node.key_location(key))
        if isinstance(inner.value, dict) and source.text.startswith(key, start):
            yield MutantEdit(
                "name misspelt", f"{label}{key}", start, start + len(key), misspelt(key)
            )
        yield from _node_changes(source, f"{label}{key}.", inner, seen)


def _scalar_changes(source: Source, label: str, node: YamlNode) -> MutantEdits:
    """Yield the change of a text.

    A truth value is reversed, a number is ten times as large, a word is misspelt.
    """
    (start, end), text = node.span, node.text or ""
    if node.quoted:
        yield MutantEdit(
            "text misspelt", label, start + 1, end - 1, misspelt(source.text[start + 1 : end - 1])
        )
    elif text in _REVERSED:
        yield MutantEdit("boolean reversed", label, start, end, _REVERSED[text])
    elif _NUMBER.fullmatch(text):
        larger = f"{float(text) * 10:.12g}"
        is_short = not text.lstrip("+-").isdigit() and larger.lstrip("-").isdigit()
        yield MutantEdit("number x10", label, start, end, f"{larger}.0" if is_short else larger)
        if is_short:
            yield MutantEdit("value type changed", label, start, end, str(round(float(text))))
    elif text:
        yield MutantEdit("text misspelt", label, start, end, misspelt(source.text[start:end]))
