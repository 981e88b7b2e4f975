"""The share of single mistakes for which hints are found that undo them."""

from random import Random

import pytest

from tests.hints.measure import of_samples, of_students, verdicts
from tests.hints.students import MISTAKES
from tests.hints.trials import BASES, hints_for
from tests.samples import SAMPLES

pytestmark = pytest.mark.slow

REFERENCE = BASES["reference"]
# The extra credit of the rubric rover, whose samples have no recording: hints write none.
_OF_RECORDINGS = {"recorded", "drove-ahead", "recorded-robot", "recorded-wheels"}
_MUTANTS = 8  # of each correct robot; all of them take minutes: python -m tests.hints.measure


@pytest.mark.exhaustive
def test_single_mistakes_get_hints_that_undo_them() -> None:
    """At least 95 % of the mutants have a verified hint, and 90 % become a robot that behaves like the correct one."""
    found = [verdict for base in BASES.values() for verdict in verdicts(base, _MUTANTS, Random(14))]
    assert len(found) >= 100
    assert sum(verdict.marks.has_hint for verdict in found) >= 0.95 * len(found)
    assert sum(verdict.marks.is_same for verdict in found) >= 0.90 * len(found)
    values = [verdict for verdict in found if not verdict.mutation.startswith("element")]
    assert sum(verdict.marks.is_there for verdict in values) >= 0.90 * len(values)


@pytest.mark.exhaustive
def test_sample_mistakes_get_hints_that_lead_to_full_marks() -> None:
    """All but those in which a file, link, joint, macro or name is missing: hints never write one."""
    left = {verdict.label for verdict in of_samples() if {*verdict.hints.left} - _OF_RECORDINGS}
    without_a_file = {
        "empty-urdf",
        "no-launch-folder",
        "no-package-xml",
        "raw-xacro",
        "truncated-file",
    }
    without_a_part = {
        *(
            "footprint-missing",
            "footprint-without-joint",
            "lidar-missing",
            "lidar-without-joint",
            "links-without-joints",
        ),
        *(
            "right-wheel-missing",
            "arm/world-missing",
            "sensors/imu-commented-out",
            "sensors/macro-never-called",
        ),
        *("sensors/no-xacro", "sensors/nothing-included", "sensors/properties-unused"),
    }
    # Names of which several places would have to change, or that are written nowhere.
    of_names = {
        *(
            "dependency-forgotten",
            "velocities-unstamped",
            "program-misspelt",
            "config-not-installed",
        ),
        *("remapping-forgotten", "interface-of-position", "wheels-exchanged"),
    }
    of_several_numbers = {"rover/base-on-the-ground"}  # of any height that the rubric leaves open
    of_diffdrive = {f"diffdrive/{name}" for name in of_names}
    assert left == without_a_file | without_a_part | of_diffdrive | of_several_numbers


def test_mistakes_of_students_get_hints_that_lead_to_full_marks() -> None:
    """At least 95 % of mistakes that cost points lose nothing with all edits, and 90 % become the correct robot."""
    found = list(of_students())
    costly = [verdict for verdict in found if verdict.hints.lost]
    assert len(costly) >= 75
    assert sum(verdict.marks.has_hint for verdict in costly) >= 0.95 * len(costly)
    assert sum(verdict.marks.is_full for verdict in costly) >= 0.95 * len(costly)
    assert sum(verdict.marks.is_same for verdict in costly) >= 0.90 * len(costly)


def test_a_link_without_name_gets_its_name() -> None:
    """The name that a joint uses is added to the link; the link is not copied."""
    changed = REFERENCE.text.replace('<link name="lidar">', "<link>")
    hints = hints_for(REFERENCE.changed(changed))
    assert [(edit.old, edit.new) for found in hints.found for edit in found.edits] == [
        ("<link", '<link name="lidar"')
    ]
    assert hints.is_full


@pytest.mark.parametrize(
    "written",
    [
        'xyz="0.15 0 0.225 0"',
        'xyz="0.15 0"',
        'xyz=""',
        'rpy="0 0 0 0 0"',
        'rpy="1"',
        'xyz="0.15, 0, 0.225"',
    ],
)
def test_a_wrong_count_of_numbers_is_corrected(written: str) -> None:
    """A vector with too many or too few numbers, or none, is replaced."""
    changed = REFERENCE.text.replace('xyz="0.15 0 0.225" rpy="0 0 0"', written)
    hints = hints_for(REFERENCE.changed(changed))
    assert ("urdf-loads" if "," in written else "lidar-frame") in hints.lost
    assert hints.is_full


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("outer-face-y", ('xyz="-0.15 0.25 0"', 'xyz="-0.15 -0.25 0"')),
        ("mount-of-the-wheel-wrong-side", ('xyz="-0.15 -0.2 0"', 'xyz="-0.15 0.2 0"')),
        ("mount-wrong-x", ('xyz="0.3 0 0.2"', 'xyz="0.15 0 0.2"')),
        ("mount-typo", ('link="rigth_mount"', 'link="right_mount"')),
        ("pasted-joint-keeps-child", ('link="left_wheel"', 'link="right_wheel"')),
        ("both-wheels-one-name", ('name="left_wheel"', 'name="right_wheel"')),
        ("colour-called-colour", ("<colour", "<color")),
        ("xacro-macro-outward", ('outward="1"', 'outward="-1"')),
        ("centres-left-at-the-box", ('xyz="-0.15 0.2 0"', 'xyz="-0.15 0.225 0"')),
        ("centres-in-centimetres", ('xyz="-15 22.5 0"', 'xyz="-0.15 0.225 0"')),
        ("mount-of-the-wheel-turned", ('rpy="1.57 0 0"', 'rpy="-1.57 0 0"')),
    ],
)
def test_the_mistake_is_corrected_and_not_hidden_by_another(
    name: str, change: tuple[str, str]
) -> None:
    """A frame in the wrong place is corrected there, not by a picture far from it or by the next joint."""
    mistake = MISTAKES[name]
    hints = hints_for(mistake.base.changed(mistake.text))
    assert [[(edit.old, edit.new) for edit in found.edits] for found in hints.found] == [[change]]


@pytest.mark.parametrize("written", ["0.0025", "0.0225", "0.0275", "0.0279", "0.0221"])
def test_a_number_near_the_expected_one_becomes_the_expected_one(written: str) -> None:
    """Nothing else that is nearly right is proposed, such as half of a length more; and 2.5 mm are not nothing."""
    changed = REFERENCE.text.replace('xyz="0 0 0.025"', f'xyz="0 0 {written}"')
    hints = hints_for(REFERENCE.changed(changed))
    assert hints.lost
    assert [[edit.new for edit in found.edits] for found in hints.found] == [['xyz="0 0 0.025"']]


@pytest.mark.parametrize(
    ("name", "link"), [("arm/diameter-for-radius", "shoulder"), ("arm/box-lying", "forearm")]
)
def test_an_inertia_is_not_fitted_to_a_wrong_shape(name: str, link: str) -> None:
    """The only hint corrects the shape, with which the inertia is correct."""
    hints = hints_for(SAMPLES[name].open(), SAMPLES[name].rubric)
    assert [set(found.gains) for found in hints.found] == [{f"{link}-inertia", f"{link}-shape"}]
    assert hints.is_full
