"""The examples in docstrings work as written; each central type has one."""

import ast
import doctest
from importlib import import_module

import pytest

import grader
from tests.test_architecture import MODULES

CENTRAL = {"Outcome", "Package", "Proposal", "StudentGrade", "Submission"}
TEXTS = {name: path.read_text(encoding="utf-8") for name, path in MODULES.items()}


@pytest.mark.parametrize("name", [name for name, text in TEXTS.items() if ">>> " in text])
def test_examples_give_what_they_show(name: str) -> None:
    """Every example of a module gives the output that stands below it."""
    found = doctest.testmod(
        import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS
    )
    assert found.attempted
    assert not found.failed


@pytest.mark.slow
def test_central_types_and_public_names_have_an_example() -> None:
    """What every reader and every user meets shows in its docstring how it is used."""
    classes = (
        node
        for text in TEXTS.values()
        for node in ast.parse(text).body
        if isinstance(node, ast.ClassDef)
    )
    assert {node.name for node in classes if ">>> " in (ast.get_docstring(node) or "")} >= CENTRAL
    assert [
        name for name in grader.__all__ if ">>> " not in (getattr(grader, name).__doc__ or "")
    ] == []
