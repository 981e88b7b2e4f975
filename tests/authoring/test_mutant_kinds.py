"""The kinds of mutants: samples over all of them, scores, and why some may survive."""

import pytest

from grader.lab.authoring.mutant_kinds import draw, find_kind, scores_by_kind, why_right
from grader.lab.authoring.mutants import Mutant

pytestmark = pytest.mark.slow


def many(**counts: int) -> list[Mutant]:
    """Return mutants of families, so many of each."""
    made = []
    for family, count in counts.items():
        name = family.replace("_", " ")
        made += [Mutant(f"{name}: {number}", name, "a.urdf", number) for number in range(count)]
    return made


def test_a_sample_has_mutants_of_all_families() -> None:
    """A rare family has as many as a common one, in the order of all mutants; another seed draws others."""
    mutants = many(number_zero=500, name_misspelt=300, spin_removed=3)
    drawn = draw(mutants, 63, 0)
    assert len(drawn) == 63
    assert [it.family for it in drawn].count("spin removed") == 3
    assert [it.family for it in drawn].count("number zero") == 30
    assert drawn == sorted(drawn, key=mutants.index)
    assert (draw(mutants, 63, 0) == drawn, draw(mutants, 63, 1) == drawn) == (True, False)
    assert draw(mutants, 803, 0) == mutants


def test_every_family_has_a_kind() -> None:
    """By how its name begins."""
    assert find_kind("world element deleted") == "worlds"
    assert find_kind("bridge row removed") == "bridges"
    assert find_kind("spin removed") == "code"
    assert find_kind("anything else") == "others"


def test_the_score_of_a_kind_counts_what_should_be_caught() -> None:
    """Mutants that are the same robot count for nothing."""
    outcomes = [("number zero", "caught"), ("number x10", "survived"), ("number zero", "same")]
    [score] = scores_by_kind(outcomes)
    assert score == ("numbers", 1, 2)


def test_a_free_name_may_survive_with_a_reason() -> None:
    """That of a launch file or of <ros2_control>, but not that of a joint."""
    launch = "my/launch/view.launch.py"
    assert "any name" in why_right(Mutant(f"file renamed: {launch}", "file renamed", launch, 1))
    system = "name misspelt: xacro:macro control/ros2_control the_system name"
    assert "ros2_control" in why_right(Mutant(system, "name misspelt", "a.xacro", 1))
    joint = "name misspelt: ros2_control the_system/joint left name"
    assert why_right(Mutant(joint, "name misspelt", "a.xacro", 1)) == ""
    assert why_right(Mutant("number zero: x", "number zero", "a.urdf", 1)) == ""
