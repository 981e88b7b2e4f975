"""How plain the code is to the eye: how much each function decides, and what variables are called."""

import ast
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parent.parent / "grader"
FILES = sorted(ROOT.rglob("*.py"))
MOST, MANY = 20, 10  # no function decides more, and few decide more than the other
SHARE = 0.07  # of the functions, which may be above the other
NAMELESS = {"it", "found", "own"}  # which say nothing of a value


def _functions(blocks: Iterable[Any], inside: str) -> Iterator[tuple[str, int]]:
    """Yield the functions of radon's blocks with their complexity, methods and those in others too."""
    for block in blocks:
        name = f"{inside}.{block.name}"
        if hasattr(block, "closures"):
            yield name, block.complexity
            yield from _functions(block.closures, name)
        else:
            yield from _functions((*block.methods, *block.inner_classes), name)


@pytest.mark.slow
def test_few_functions_decide_much() -> None:
    """By radon's count of branches, in which each `and`, each comprehension and each condition counts."""
    radon = pytest.importorskip("radon.complexity", reason="needs radon: .[dev]")
    complexities: dict[str, int] = {}
    for path in FILES:
        blocks = radon.cc_visit(path.read_text(encoding="utf-8"))
        alone = [block for block in blocks if not getattr(block, "is_method", False)]
        complexities |= _functions(alone, str(path.relative_to(ROOT)))
    assert {name: count for name, count in complexities.items() if count > MOST} == {}
    above = [name for name, count in complexities.items() if count > MANY]
    assert len(above) <= SHARE * len(complexities)


def _bound_names(tree: ast.AST) -> Iterator[tuple[str, int]]:
    """Yield the names that a module gives to values, with their lines."""
    for node in ast.walk(tree):
        match node:
            case ast.Name(id=name, ctx=ast.Store()) | ast.arg(arg=name):
                yield name, node.lineno
            case ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
                yield name, node.lineno
            case ast.ExceptHandler(name=str(name)):
                yield name, node.lineno


def test_variables_say_what_they_hold() -> None:
    """None is called `it`, `found` or `own`."""
    nameless = []
    for path in FILES:
        for name, line in _bound_names(ast.parse(path.read_text(encoding="utf-8"))):
            if name in NAMELESS:
                nameless.append((path.relative_to(ROOT).as_posix(), line, name))
    assert nameless == []
