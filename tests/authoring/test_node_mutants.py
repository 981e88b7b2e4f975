"""Mutants of the code of nodes, and of interfaces."""

from collections import Counter

from grader.base.source import Source
from grader.lab.authoring.node_mutants import node_changes
from grader.ros.workspace.names import Family
from tests.workspace.carts import cart
from tests.workspace.test_nodes import laundry_files

TOPICS: tuple[Family, ...] = ("topics",)


def test_interfaces_and_code_have_mutants() -> None:
    """Fields and separators of files, and what nodes import, use and do."""
    submission = cart(laundry_files())
    found = Counter[str]()
    for path, text in laundry_files().items():
        for change in node_changes(submission, Source(path, text), path, ("interfaces", "code")):
            assert text[change.start : change.end] != change.new
            found[change.family] += 1
    assert found == {
        "field renamed": 10,
        "separator removed": 3,
        "name misspelt": 31,
        "spin removed": 3,
        "callback called": 5,
        "response not returned": 1,
    }


def test_a_family_that_is_not_compared_has_no_mutants() -> None:
    """A criterion has to look at it."""
    submission = cart(laundry_files())
    for path, text in laundry_files().items():
        assert [*node_changes(submission, Source(path, text), path, TOPICS)] == []
