"""Hints of names that do not agree: the edit is made where the mistake is, in every kind of file."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import pytest

from grader.base.source import Edits
from grader.files.tree import overlaid
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.hints.hinting import hinted
from grader.lab.hints.name_edits import name_proposals
from grader.lab.rubric.rubric import Rubric, read_rubric
from tests.hints.trials import applied
from tests.samples import RUBRICS, reference
from tests.workspace.carts import FOLDER, cart, cart_files, edited

_FAMILIES = (
    "files",
    "frames",
    "controllers",
    "parameters",
    "arguments",
    "programs",
    "topics",
    "dependencies",
)
_RUBRIC = """
id = "cart"
title = "A cart"
urdf = "urdf/cart.urdf.xacro"
package = "cart_bringup"
packages = ["cart_bringup", "cart_description", "cart_nodes"]
hints = "edit"
reference = "src"
part = [{ id = "names", title = "Names", needs = "package" }]
"""
_CRITERION = """
[[criterion]]
id = "{0}"
part = "names"
title = "The names of {0} agree"
points = 1
check = "names_agree"
package = "cart_bringup"
with = {{ of = "{0}" }}
"""


@cache
def rubric() -> Rubric:
    """Return a rubric that asks for all families of names, with the workspace as its reference."""
    text = _RUBRIC + "".join(map(_CRITERION.format, _FAMILIES))
    return read_rubric(text.encode(), FOLDER.parent / "rubric.toml")


def found_for(texts: Mapping[str, str]) -> tuple[Report, Edits]:
    """Return the report on a workspace with these files, with hints, and their edits."""
    submission = cart(texts, rubric().lab)
    report = grade(rubric(), submission)
    assert report.score < 8
    found = hinted(report, submission, "edit")
    assert not found.faults
    return found.report, found.edits


def after(texts: Mapping[str, str], edits: Edits) -> dict[str, str]:
    """Return the files with edits."""
    changed = {edit.path: [it for it in edits if it.path == edit.path] for edit in edits}
    return {
        **texts,
        **{path: applied(texts[path].encode(), own).decode() for path, own in changed.items()},
    }


@pytest.mark.slow
@pytest.mark.parametrize(
    ("place", "old", "new"),
    [
        (
            "config/controllers.yaml",
            "right_wheel_names: [right_wheel_joint]",
            "right_wheel_names: [rigth_wheel_joint]",
        ),
        (
            "config/controllers.yaml",
            "\nwheel_controller:\n  ros__parameters",
            "\nwheel_controller:\n  ros__paramters",
        ),
        ("config/detector.yaml", "threshold: 0.5", "treshold: 0.5"),
        ("config/detector.yaml", "detector:", "detecter:"),
        ("config/detector.yaml", "detector:", "vision:"),
        ("config/detector.yaml", "ros__parameters", "ros_parameters"),
        ("config/navigation.yaml", "plugins: [obstacle_layer]", "plugins: [obstcle_layer]"),
        ("config/navigation.yaml", "FollowPath:", "FollwPath:"),
        ("config/bridge.yaml", "gz_topic_name: front_camera", "gz_topic_name: fornt_camera"),
        ("worlds/hall.yaml", "image: hall.pgm", "image: hal.pgm"),
        ("cart_bringup/CMakeLists.txt", "launch config worlds", "launch confg worlds"),
        (
            "cart_bringup/package.xml",
            "<exec_depend>nav2_controller</",
            "<exec_depend>nav2_controler</",
        ),
        ("robot.launch.py", '"base_link"', '"base_lnk"'),
        ("robot.launch.py", '["wheel_controller"', '["wheel_controler"'),
        ("robot.launch.py", " controllers_file:=", " controler_file:="),
        ("robot.launch.py", '"urdf", "cart.urdf.xacro"', '"urdf", "crat.urdf.xacro"'),
        ("cart.launch.py", '{"sim_time"', '{"sim_tme"'),
        ("cart.launch.py", 'executable="detector"', 'executable="detector_node"'),
        ("cart.launch.py", '[("image"', '[("imgae"'),
        ("cart.launch.py", '["map_server"', '["map_sever"'),
        ("cart.launch.py", '{"volume": 3}', '{"volum": 3}'),
        (
            "cart.launch.py",
            'package="cart_nodes", executable="alarm"',
            'package="cart_node", executable="alarm"',
        ),
        ("cart_nodes/setup.py", "cart_nodes.detector:main", "cart_nodes.detector:run"),
        ("cart_nodes/setup.py", '"alarm = ', '"alrm = '),
        ("detector.py", 'get_parameter("threshold")', 'get_parameter("treshold")'),
        (
            "cart.urdf.xacro",
            'left_wheel_joint">\n      <command_interface name="velocity"',
            'left_wheel_joint">\n      <command_interface name="velocty"',
        ),
        ("cart.urdf.xacro", '<gazebo reference="camera_link">', '<gazebo reference="camera_lnk">'),
    ],
)
def test_a_slip_is_undone_where_it_is(place: str, old: str, new: str) -> None:
    """Not by the same slip in the file that the name belongs to, though both agree then."""
    texts = edited((place, old, new))
    _, edits = found_for(texts)
    assert after(texts, edits) == cart_files()


def renamed(name: str, new: str) -> dict[str, str]:
    """Return the files with a name that the reference does not have."""
    return {path: text.replace(name, new) for path, text in cart_files().items()}


def test_of_names_of_the_students_own_the_one_is_kept_that_more_places_write() -> None:
    """The reference does not know either of them; the slip is in the definition."""
    own = renamed("threshold", "limit")
    [path] = [it for it in own if it.endswith("detector.py")]
    texts = {
        **own,
        path: own[path].replace('declare_parameter("limit"', 'declare_parameter("limt"'),
    }
    _, edits = found_for(texts)
    assert after(texts, edits) == own


def test_of_two_names_that_as_many_places_write_both_edits_are_told_and_none_is_made() -> None:
    """A list of plugins, and its section: nothing tells which of the two has the slip."""
    own = renamed("FollowPath", "Pursuit")
    [path] = [it for it in own if it.endswith("navigation.yaml")]
    report, edits = found_for({**own, path: own[path].replace("[Pursuit]", "[Pursit]")})
    assert edits == ()
    [hint] = [it.hint for it in report.results if it.hint is not None]
    assert hint.message.endswith("both work, so look which one is meant.")
    assert "`Pursit` to `Pursuit`" in hint.message
    assert "`Pursuit` to `Pursit`" in hint.message


def test_a_slip_that_makes_two_problems_is_one_edit() -> None:
    """A topic that is remapped under a wrong name is not published, too: with the right name, both are solved."""
    _, edits = found_for(
        edited(("cart.launch.py", '("image", "camera/image")', '("imag", "camera/image")'))
    )
    assert [(edit.old, edit.new) for edit in edits] == [("imag", "image")]


_BACKWARD = (
    '("/diff_drive_controller/cmd_vel", "/cmd_vel")',
    '("/cmd_vel", "/diff_drive_controller/cmd_vel")',
)


@pytest.mark.slow
def test_a_remapping_that_is_written_backward_is_exchanged() -> None:
    """The publisher, whose topic nothing subscribes to then, stays as it is."""
    correct = reference(RUBRICS["diffdrive"])
    path = next(it for it in correct.whole_tree.files if it.endswith("diffdrive.launch.py"))
    text = correct.whole_tree.files[path].read(1 << 20).decode()
    assert _BACKWARD[0] in text
    assert correct.reopen is not None
    wrong = correct.reopen(overlaid(correct.whole_tree, {path: text.replace(*_BACKWARD).encode()}))
    report = grade(RUBRICS["diffdrive"], wrong)
    edits = hinted(report, wrong, "edit").edits
    assert {edit.path for edit in edits} == {path}
    assert applied(text.replace(*_BACKWARD).encode(), edits).decode() == text


@pytest.mark.slow
def test_no_edit_disconnects_what_it_compares() -> None:
    """Another type of a topic stays: a remapping that is exchanged would make the controller deaf."""
    correct = reference(RUBRICS["diffdrive"])
    path = next(it for it in correct.whole_tree.files if it.endswith("drive_circle.py"))
    text = correct.whole_tree.files[path].read(1 << 20).decode()
    text = text.replace("TwistStamped", "Twist").replace(".twist.", ".")
    text = text.replace("        command.header.stamp = self.get_clock().now().to_msg()\n", "")
    assert correct.reopen is not None
    wrong = correct.reopen(overlaid(correct.whole_tree, {path: text.encode()}))
    criteria = [it for it in RUBRICS["diffdrive"].criteria if it.id == "topics-connected"]
    only_topics = replace(RUBRICS["diffdrive"], criteria=tuple(criteria))
    report = grade(only_topics, wrong)
    assert report.score == 0
    assert hinted(report, wrong, "edit").edits == ()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("ending", "text", "expected"),
    [
        (
            "py",
            'Node(remappings=[("a", "/b"), (\'~/c\', "d",)], arguments=[("e", "f")])',
            [('"a"', '"/b"'), ("'~/c'", '"d"')],
        ),
        ("xml", '<node><remap from="a" to="/b"/></node>', [('"a"', '"/b"')]),
        (
            "yaml",
            "remap: [{from: a, to: /b}]\nparam:\n- from: c\n  to: d",
            [("a", "/b"), ("c", "d")],
        ),
    ],
)
def test_each_way_to_write_a_remapping_is_exchanged(
    ending: str, text: str, expected: list[tuple[str, str]]
) -> None:
    """In Python, XML and YAML, each of a list."""
    path = f"cart_bringup/launch/other.launch.{ending}"
    proposals = name_proposals(cart({**cart_files(), path: text}, rubric().lab), "topics", None)
    found = [tuple(edit.old for edit in it.edits) for it in proposals if it.edits[0].path == path]
    assert found == expected
