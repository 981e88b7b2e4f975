"""Whether the file as a whole loads."""

import pytest

from grader.checks.loading import urdf_loads
from tests.checks.asking import ask, fails, passes
from tests.checks.cases import BASE, LIDAR, WHEEL, mounted
from tests.checks.robots import Scene, joint, link, mesh, scene, visual


def test_notes_and_warnings_do_not_keep_a_file_from_loading() -> None:
    """What ROS 2 only warns of, or drops, is no failure here: the checks of the parts see what is left."""
    scene_ = scene(link("base", visual("<cone/>")), LIDAR, joint("j", "fixed", "base", "lidar"))
    assert scene_.reading.verdict == "degraded"
    passes(urdf_loads, scene_)


def test_all_roots_are_named() -> None:
    """Every link that is left without a joint is named at once."""
    message = fails(urdf_loads, scene(BASE, LIDAR, WHEEL), at='name="lidar"')
    assert "'lidar'" in message and "'wheel'" in message and "'base'" in message


def test_further_problems_are_counted() -> None:
    """The first reason is told in full, and how many more there are."""
    one = joint("a", "Fixed", "base", "lidar")
    two = scene(BASE, LIDAR, WHEEL, one, joint("b", "Fixed", "base", "wheel"))
    assert fails(urdf_loads, two).endswith(" (and 1 more problem that keeps it from loading)")
    three = scene(
        BASE, LIDAR, WHEEL, link("x"), one, joint("b", "Fixed", "base", "wheel"), joint("c", "Fixed", "base", "x")
    )
    assert fails(urdf_loads, three).endswith(" (and 2 more problems that keep it from loading)")


def test_a_single_problem_is_not_counted() -> None:
    """Nothing is said of further problems where there are none."""
    assert "more problem" not in fails(urdf_loads, scene(BASE, LIDAR, joint("a", "Fixed", "base", "lidar")))


def test_notes_are_not_counted_as_further_problems() -> None:
    """Only what keeps the file from loading is counted, not what it comes with."""
    zero = joint("a", "continuous", "base", "lidar", axis="0 0 0")
    message = fails(
        urdf_loads, scene(BASE, LIDAR, WHEEL, zero, joint("b", "Fixed", "base", "wheel")), at='type="Fixed"'
    )
    assert "more problem" not in message


@pytest.mark.parametrize(
    ("scene_", "at"),
    [
        (scene(BASE, LIDAR, joint("a", "fixed", "base", "lidar", xyz="0 0")), 'xyz="0 0"/>'),
        (scene(BASE, LIDAR, joint("a", "fixd", "base", "lidar")), 'type="fixd"'),
        (scene(BASE, LIDAR, joint("a", "fixed", "base", "lydar")), 'link="lydar"'),
        (scene(BASE, LIDAR, joint("a", "fixed", "base", "lidar"), joint("b", "fixed", "lidar", "base")), None),
        (scene(BASE, joint("a", "fixed", "base", "base")), None),
        (scene(), "<robot"),
    ],
    ids=["unreadable-origin", "unknown-type", "unknown-link", "loop", "joint-to-itself", "no-links"],
)
def test_what_ros_rejects_does_not_load(scene_: Scene, at: str | None) -> None:
    """A file that ROS 2 rejects fails at the place of its first fault."""
    assert scene_.reading.verdict == "rejected"
    fails(urdf_loads, scene_, at=at)


def test_links_on_a_loop_of_their_own_are_not_in_the_tree() -> None:
    """ROS 2 loads a robot with a detached loop of joints, but leaves its links out: not every link is in the tree."""
    loop = (joint("a", "fixed", "lidar", "wheel"), joint("b", "fixed", "wheel", "lidar"))
    scene_ = scene(BASE, LIDAR, WHEEL, *loop)
    assert scene_.reading.verdict == "degraded"
    assert "loop" in fails(urdf_loads, scene_)


def test_text_that_is_no_xml_fails() -> None:
    """A file that is no XML at all is a failure with a place, not an error."""
    for text in ("", "hello", "<robot", '<robot name="r"><link></robot>', "\x00"):
        outcome = ask(urdf_loads, Scene(text))
        assert outcome.status == "failed"
        assert outcome.location is not None
        assert outcome.message


def test_meshes_and_movable_joints_load() -> None:
    """Nothing is asked of the content: meshes that nobody has, wheels without an axis, a lidar in the ground."""
    passes(urdf_loads, mounted((0.0, 0.0, -9.0)).with_shape(mesh("nowhere.stl")))
    passes(urdf_loads, scene(BASE, WHEEL, joint("j", "continuous", "base", "wheel")))
