"""The difference between two Python files: functions, calls and their arguments, as edits of the text."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import NamedTuple

from grader.difference import Node, Step, steps
from grader.edits import Proposal
from grader.package.edits.task import Verb, change
from grader.package.edits.wording import slip
from grader.source import Edit, Source

_VERBS: Mapping[str, Verb] = {"set": "set", "add": "add", "move": "add"}  # others: rename

Span = tuple[int, int]


class TreePlace(NamedTuple):
    """Where a node is in its text, and the edits that add a value or a node to it; `code` is how to write it elsewhere.

    `codes` and `spans` are those of its values, and `names` the offsets of their names.
    """

    label: str
    code: str
    codes: Mapping[str, str]
    spans: Mapping[str, Span]
    names: Mapping[str, Span]
    with_value: Callable[[str, str], Edit | None]
    with_child: Callable[[str], Edit | None]


def tree_proposals(
    source: Source,
    trees: tuple[Node | None, Node | None],
    what: str,
    needs: Callable[[str], Iterable[Edit]] = lambda _: (),
) -> Iterator[Proposal]:
    """Yield the edits that undo one difference each to another tree.

    The `of` of each node returns its place, and `needs` the edits that a text needs in the file.
    """
    own, like = trees
    found = steps(own, like) if own is not None and like is not None else []
    found += [*_others(own, found)] if own is not None else []

    alike: dict[tuple[object, ...], list[Proposal]] = {}  # missing in one place; a mistake that is made everywhere
    for step in found:
        code, edit = _edit(source, step)
        if edit is not None:
            made = change([*needs(code), edit], _VERBS.get(step.verb, "rename"), _words(step), what)
            is_new = not edit.old
            yield made._replace(rank=int(_is_whole(step)))
            key = (step.own.of,) if is_new else (edit.old.rpartition("/")[0], edit.new.rpartition("/")[0])
            alike.setdefault(key, []).append(made)
    for (old, *_), several in alike.items():
        if old and len(several) > 1:
            yield several[0]._replace(edits=tuple(dict.fromkeys(edit for it in several for edit in it.edits)))


def _others(root: Node, found: Iterable[Step]) -> Iterator[Step]:
    """Yield steps that add what other steps make of a node: it may be missing beside it."""
    for step in found:
        new = step.like.values[step.name] if step.verb == "set" and step.like is not None else ""
        if step.like and new and new in step.like.keys and not slip(step.own.values.get(step.name, ""), [new]):
            above = (it for it in root.walk() if it.of and any(child is step.own for child in it.children))
            yield from (Step("add", it, step.like) for it in above)


def _is_whole(step: Step) -> bool:
    """Return whether a value is replaced that is a node in both trees: its own differences come first."""
    nodes = [node for node in (step.own, step.like) if node is not None]
    return all(step.name in [child.tag for child in node.children] for node in nodes)


def _words(step: Step) -> str:
    label = step.own.of().label
    label = label if not step.name or step.name.isdigit() else f"`{step.name}` of {label}"
    return f"the value of {label}" if step.verb == "set" else label


def _edit(source: Source, step: Step) -> tuple[str, Edit | None]:
    """Return the text that a step writes, and its edit; None where it has none."""
    own, like, name = step.own, step.like, step.name
    mine: TreePlace = (step.parent or own).of()
    if like is None:
        return "", None
    its: TreePlace = like.of()
    if step.verb in ("add", "move"):
        return its.code, mine.with_child(its.code)
    if step.verb == "retag":
        return "", None
    if step.verb == "set":
        code = its.codes[name]
        return code, source.edit(*mine.spans[name], code) if name in mine.spans else mine.with_value(name, code)
    others = (it for it, value in like.values.items() if it not in own.values and value == own.values[name])
    new = step.other or next(others, "")  # the same value may have another name
    return "", source.edit(*mine.names[name], new) if new and name in mine.names else None
