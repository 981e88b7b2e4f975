"""What the grader makes of random documents equals what xacro makes of them."""

import pytest

from tests.examples import spread
from tests.xacro import grammar, oracle
from tests.xacro.compare import compared, summary

PARTS = 10
PART = 100


@pytest.mark.parametrize("part", spread(range(PARTS), 1))
def test_random_documents(part: int) -> None:
    """A thousand random documents are expanded, or refused, as xacro does."""
    counted, *differences = summary(map(compared, range(part * PART, (part + 1) * PART)))
    assert differences == [], counted


def test_random_documents_are_the_same_in_every_run_and_mostly_accepted() -> None:
    """A seed gives one document; xacro accepts most of them and refuses some."""
    documents = [grammar.document(seed) for seed in range(25)]
    assert documents == [grammar.document(seed) for seed in range(25)]
    accepted = sum(isinstance(oracle.expand(document), oracle.Accepted) for document in documents)
    assert 15 < accepted < 25


def test_random_documents_use_every_tag() -> None:
    """Every tag of xacro is in some random document."""
    text = "".join(grammar.document(seed).text for seed in range(100))
    tags = ("property", "macro", "call", "if", "unless", "insert_block", "include", "arg", "element", "attribute")
    assert [tag for tag in tags if f"<xacro:{tag} " not in text] == []


def test_summary() -> None:
    """Differences are counted, and shown with their seeds in order."""
    assert summary([(2, True, None), (1, True, "b"), (0, False, "a")]) == [
        "1 of 3 documents agree; xacro accepts 2",
        "seed 0: a",
        "seed 1: b",
    ]
