"""Mutants of a text: the families, their ids, their places; and the sample of them that is graded."""

from collections import Counter
from random import Random

import pytest

from grader.mutation.elements import elements
from grader.mutation.mutants import Mutant, mutants
from grader.mutation.mutation_test import sampled
from grader.mutation.result import diff
from tests.mutation.robots import ARM, CHANGES

FOUND = {mutant.id: mutant for mutant in mutants(ARM, "birch.urdf")}


@pytest.mark.parametrize("change", CHANGES["robot"], ids=lambda change: change["id"])
def test_a_mutant_makes_one_change(change: dict[str, str]) -> None:
    """The family and the place by names say what the mutant changes."""
    assert FOUND[change["id"]].applied(ARM) == ARM.replace(change["old"], change["new"], 1)


def test_a_link_that_must_show_nothing_gets_a_visual() -> None:
    """Whether its tag is empty or not; other links do not."""
    box = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    text = '<robot><link name="a"/><link name="b"></link><link name="c"/></robot>'
    found = [it for it in mutants(text, "a.urdf", ["a", "b", "nowhere"]) if it.family == "visual added"]
    assert [mutant.id for mutant in found] == ["visual added: link a", "visual added: link b"]
    assert [mutant.applied(text) for mutant in found] == [
        text.replace('"a"/>', f'"a">{box}</link>'),
        text.replace('"b">', f'"b">{box}'),
    ]


def test_ids_are_unique_and_do_not_depend_on_lines() -> None:
    """Other lines, comments and elements above do not change an id, so a pattern goes on to match."""
    assert len(FOUND) == len(list(mutants(ARM)))
    longer = ARM.replace('<link name="base">', '<!-- a -->\n\n<link name="new"/>\n<link name="base">', 1)
    assert {name for name in FOUND if "exchanged" not in name} <= {mutant.id for mutant in mutants(longer)}


def test_equal_siblings_are_counted() -> None:
    """The second visual of a link has a place of its own."""
    labels = [
        found.label for found in elements("<robot><link name='a'><visual/><visual/></link><link/><link/></robot>")
    ]
    assert labels == ["robot", "link a", "link a/visual", "link a/visual 2", "link", "link 2"]


@pytest.mark.parametrize(
    "text", ["", "<robot", "</robot>", "<a></b></a>", "<a><b></a>", "no markup", "<robot name='a'>"]
)
def test_broken_markup_has_mutants_or_none(text: str) -> None:
    """A text with open or stray tags is no reason to stop."""
    assert all(mutant.applied(text) != text for mutant in mutants(text))


def _of(**counts: int) -> list[Mutant]:
    return [Mutant(f"{family} {i}", family, "", i) for family, count in counts.items() for i in range(count)]


def test_a_sample_has_the_same_number_of_each_family() -> None:
    """As far as a family has as many; the order stays, and the seed decides which."""
    every = _of(a=100, b=3, c=50)
    chosen = sampled(every, 43, Random(1))
    assert Counter(mutant.family for mutant in chosen) == {"a": 20, "b": 3, "c": 20}
    assert chosen == [mutant for mutant in every if mutant in chosen] == sampled(every, 43, Random(1))
    assert chosen != sampled(every, 43, Random(2))
    assert sampled(every, 1000, Random(1)) == every
    assert sampled(every, 0, Random(1)) == []


def test_a_diff_has_two_lines_around_the_change() -> None:
    """And the ranges of lines as diff writes them."""
    before = "".join(f"{number}\n" for number in range(1, 8))
    assert diff("a.urdf", before, before.replace("4\n", "x\ny\n")).split("\n") == [
        "--- a.urdf", "+++ a.urdf", "@@ -2,5 +2,6 @@", " 2", " 3", "-4", "+x", "+y", " 5", " 6",
    ]  # fmt: skip
    assert diff("a", "", "x\n") == "--- a\n+++ a\n@@ -0,0 +1 @@\n+x"
