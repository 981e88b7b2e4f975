"""A name that is used has to be defined: definitions and uses made by hand."""

from grader.base.source import Location
from grader.workspace.rules.names import (
    JOINT_DEFINED,
    Agreement,
    Compared,
    Correction,
    Definition,
    Fact,
    Mismatch,
    Open,
    Undecided,
    Use,
    agreement,
)
from grader.workspace.rules.rule_table import RULES

_HERE, _THERE, _LATER = (
    Location("a.yaml", 3, 5),
    Location("robot.urdf", 7, 2),
    Location("a.yaml", 9, 1),
)
_WHEEL = Definition("joint", "left_wheel_joint", _THERE)


def _use(name: str, *, optional: bool = False, at: Location = _HERE) -> Use:
    return Use("joint", name, at, "wheels", optional=optional)


def test_a_name_that_is_defined_agrees() -> None:
    """A use of a defined name is no mismatch, and its family is compared."""
    assert agreement([_WHEEL, _use("left_wheel_joint")]) == Agreement(
        (), {}, frozenset({"frames"}), frozenset(), {}
    )


def test_a_name_that_is_not_defined_is_wrong_and_the_similar_one_is_named() -> None:
    """The message says where it is used and where the similar name is defined; either is corrected."""
    [found] = agreement([_WHEEL, _use("wheel_left_joint")]).mismatches
    said = "wheels: there is no joint 'wheel_left_joint'; did you mean 'left_wheel_joint' (robot.urdf:7)?"
    use = Correction(_HERE, "wheel_left_joint", "left_wheel_joint")
    assert found == Mismatch(
        JOINT_DEFINED,
        said,
        _HERE,
        _THERE,
        corrections=(use, Correction(_THERE, use.new, use.old)),
        word="wheel_left_joint",
    )


def test_a_name_like_no_other_is_wrong_where_everything_was_read() -> None:
    """Without a similar name there is no suggestion."""
    [found] = agreement([_WHEEL, _use("elbow")]).mismatches
    assert found == Mismatch(
        JOINT_DEFINED, "wheels: there is no joint 'elbow'", _HERE, word="elbow"
    )


def test_an_open_kind_makes_a_near_name_a_warning_and_says_nothing_of_others() -> None:
    """Where names may be defined elsewhere, only one slip is a mismatch, and it is not sure."""
    found = agreement([_WHEEL, Open("joint"), _use("left_weel_joint"), _use("elbow")])
    assert [it.is_certain for it in found.mismatches] == [False]
    assert found.undecided == {}


def test_what_was_not_evaluated_leaves_the_family_undecided() -> None:
    """The reason of the first opening that has one is given, but only if a name is not found."""
    facts: list[Fact] = [
        Open("joint"),
        Open("joint", reason="line 4 is not evaluated"),
        Open("joint", reason="nor is line 5"),
    ]
    assert agreement([_WHEEL, *facts, _use("elbow")]).undecided == {
        "frames": "line 4 is not evaluated"
    }
    assert agreement([_WHEEL, *facts, _use("left_wheel_joint")]).undecided == {}


def test_only_a_similar_name_makes_an_optional_use_wrong() -> None:
    """An argument that nobody declares may be passed; a similar one is meant."""
    [found] = agreement(
        [_WHEEL, _use("elbow", optional=True), _use("left_weel_joint", optional=True)]
    ).mismatches
    assert (found.is_certain, found.related) == (True, _THERE)


def test_names_of_one_owner_do_not_define_those_of_another() -> None:
    """The arguments of one launch file are not those of another one."""
    facts: list[Fact] = [
        Definition("launch argument", "gui", _THERE, "a"),
        Use("launch argument", "gui", _HERE, "include", "b"),
    ]
    assert [it.family for it in agreement(facts).mismatches] == ["arguments"]


def test_mismatches_are_in_the_order_of_their_places_and_once() -> None:
    """What two readers find is listed once; the first reason for which a family is undecided is kept."""
    wrong = Mismatch(RULES["topic-type"], "not alike", _LATER)
    facts: list[Fact] = [
        wrong,
        wrong,
        _use("elbow"),
        Undecided("topics", "one"),
        Undecided("topics", "two"),
        Compared("files"),
    ]
    found = agreement(facts)
    assert [it.location for it in found.mismatches] == [_HERE, _LATER]
    assert found.undecided == {"topics": "one"}
    assert found.families == {"topics", "frames", "files"}
