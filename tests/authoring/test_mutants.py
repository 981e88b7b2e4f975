"""Mutants of a text: the mutations, their ids, their places."""

import pytest

from grader.lab.authoring.mutants import mutants
from tests.authoring.robots import ARM, CHANGES

pytestmark = pytest.mark.slow

FOUND = {mutant.id: mutant for mutant in mutants(ARM, "birch.urdf")}


@pytest.mark.parametrize("change", CHANGES["robot"], ids=lambda change: change["id"])
def test_a_mutant_makes_one_change(change: dict[str, str]) -> None:
    """The mutation and the place by names say what the mutant changes."""
    assert FOUND[change["id"]].applied(ARM) == ARM.replace(change["old"], change["new"], 1)


def test_a_link_that_must_show_nothing_gets_a_visual() -> None:
    """Whether its tag is empty or not; other links do not."""
    box = '<visual><geometry><box size="0.1 0.1 0.1"/></geometry></visual>'
    text = '<robot><link name="a"/><link name="b"></link><link name="c"/></robot>'
    found = [
        it for it in mutants(text, "a.urdf", ["a", "b", "nowhere"]) if it.mutation == "visual added"
    ]
    assert [mutant.id for mutant in found] == ["visual added: link a", "visual added: link b"]
    assert [mutant.applied(text) for mutant in found] == [
        text.replace('"a"/>', f'"a">{box}</link>'),
        text.replace('"b">', f'"b">{box}'),
    ]


def test_ids_are_unique_and_do_not_depend_on_lines() -> None:
    """Other lines, comments and elements above do not change an id, so a pattern goes on to match."""
    assert len(FOUND) == len(list(mutants(ARM)))
    longer = ARM.replace(
        '<link name="base">', '<!-- a -->\n\n<link name="new"/>\n<link name="base">', 1
    )
    assert {name for name in FOUND if "exchanged" not in name} <= {
        mutant.id for mutant in mutants(longer)
    }


def test_equal_siblings_are_counted() -> None:
    """The second visual of a link has a place of its own."""
    found = mutants("<robot><link name='a'><visual/><visual/></link><link/><link/></robot>")
    labels = [
        mutant.id.partition(": ")[2] for mutant in found if mutant.mutation == "element deleted"
    ]
    assert labels == ["link a", "link a/visual", "link a/visual 2", "link", "link 2"]


def test_markup_that_only_ros_2_reads_has_mutants() -> None:
    """TinyXML2 allows white space before the declaration."""
    assert [
        mutant.line for mutant in mutants("\n<?xml version='1.0'?><robot><link name='a'/></robot>")
    ] == [2, 2, 2]


@pytest.mark.parametrize(
    "text", ["", "<robot", "</robot>", "<a></b></a>", "<a><b></a>", "no markup", "<robot name='a'>"]
)
def test_broken_markup_has_mutants_or_none(text: str) -> None:
    """A text with open or stray tags is no reason to stop."""
    assert all(mutant.applied(text) != text for mutant in mutants(text))
