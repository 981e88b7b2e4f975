"""What the grader makes of random documents equals what xacro makes of them."""

import pytest

from tests.differential.compared import summary
from tests.differential.xacros import compare
from tests.examples import spread
from tests.xacro import collisions, grammar, oracle

pytestmark = pytest.mark.slow

PARTS = 10
PART = 200


@pytest.mark.parametrize("part", spread(range(PARTS), 1))
def test_random_documents(part: int) -> None:
    """Two thousand random documents are expanded, or refused, as xacro does."""
    counted, *differences = summary(compare(range(part * PART, (part + 1) * PART)))
    assert differences == [], counted


@pytest.mark.parametrize(("write", "accepted"), [(grammar.document, 15), (collisions.document, 2)])
def test_random_documents_are_the_same_in_every_run_and_often_accepted(
    write: type, accepted: int
) -> None:
    """A seed gives one document; xacro accepts some of them and refuses some."""
    documents = [write(seed) for seed in range(25)]
    assert documents == [write(seed) for seed in range(25)]
    found = sum(isinstance(oracle.expand(document), oracle.Accepted) for document in documents)
    assert accepted < found < 25


@pytest.mark.parametrize("write", [grammar.document, collisions.document])
def test_random_documents_use_every_tag(write: type) -> None:
    """Every tag of xacro is in some random document."""
    text = "".join(write(seed).text for seed in range(100))
    tags = (
        "property",
        "macro",
        "call",
        "if",
        "unless",
        "insert_block",
        "include",
        "arg",
        "element",
    )
    assert [tag for tag in tags if f"<xacro:{tag} " not in text] == []
