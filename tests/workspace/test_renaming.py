"""Laws of names: one that is renamed everywhere still agrees, one that is renamed in one place does not."""

import re
from typing import NamedTuple

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.source import Edit
from grader.workspace.rules.name_fixes import NameFixes
from grader.workspace.rules.names import DEFINED, Use
from grader.workspace.rules.reading import read_facts
from grader.workspace.rules.rule_table import Family
from tests.examples import examples
from tests.hints.trials import applied
from tests.workspace.carts import agreement_of, cart, cart_files, edited, sure


class _Name(NamedTuple):
    """A name, where it is used, and the family that it belongs to; `place` ends the path of the file."""

    name: str
    place: str
    use: str  # {} stands for the name
    family: Family


_NAMES = [
    _Name("right_wheel_joint", "config/controllers.yaml", "right_wheel_names: [{}]", "frames"),
    _Name("camera_link", "config/detector.yaml", "camera_frame: {}", "frames"),
    _Name("base_link", "robot.launch.py", '"--frame-id", "{}"', "frames"),
    _Name("camera_link", "cart.urdf.xacro", '<gazebo reference="{}">', "frames"),
    _Name("wheel_controller", "robot.launch.py", 'arguments=["{}"', "controllers"),
    _Name("threshold", "config/detector.yaml", "{}: 0.5", "parameters"),
    _Name("threshold", "detector.py", 'get_parameter("{}")', "parameters"),
    _Name("volume", "cart.launch.py", '{{"{}": 3}}', "parameters"),
    _Name("obstacle_layer", "config/navigation.yaml", "plugins: [{}]", "parameters"),
    _Name("sim_time", "cart.launch.py", 'launch_arguments={{"{}"', "arguments"),
    _Name("controllers_file", "robot.launch.py", '" {}:="', "arguments"),
    _Name("map_server", "cart.launch.py", '"node_names": ["{}"', "programs"),
    _Name("detector", "cart.launch.py", 'executable="{}"', "programs"),
    _Name("image", "cart.launch.py", 'remappings=[("{}"', "topics"),
    _Name("front_camera", "config/bridge.yaml", "gz_topic_name: {}", "topics"),
    _Name("robot.launch", "cart.launch.py", '"launch", "{}.py"', "files"),
    _Name("hall", "worlds/hall.yaml", "image: {}.pgm", "files"),
    _Name(
        "nav2_controller",
        "cart_bringup/package.xml",
        "<exec_depend>{}</exec_depend>",
        "dependencies",
    ),
]
every_name = pytest.mark.parametrize(
    "name", _NAMES, ids=[f"{it.name} in {it.place}" for it in _NAMES]
)
# Made of letters that are in no name of the workspace, so that none of them is similar.
_others = st.text("jqz", min_size=5, max_size=12)
_SLIP = "?"


@pytest.mark.slow
@every_name
@examples(5)
@given(new=_others)
def test_a_name_that_is_used_in_one_place_only_gives_exactly_one_sure_problem(
    name: _Name, new: str
) -> None:
    """A slip in one use of a name is one mistake of its family, in that file or in the one that needs it."""
    slip = (
        f"{name.name[:2]}{new[0]}{name.name[3:]}"
        if name.family in ("arguments", "topics", "files")
        else new
    )
    found = sure(
        agreement_of(edited((name.place, name.use.format(name.name), name.use.format(slip))))
    )
    assert [it.family for it in found] == [name.family], found


def _uses() -> list[tuple[Use, Edit]]:
    """Return every use of a name that is written as a whole, with the edit that makes a slip in its last letter."""
    facts = {
        (it.location, it.name): it
        for it in read_facts(cart(cart_files()).workspace)
        if isinstance(it, Use)
    }
    name_fixes = NameFixes(cart(cart_files()).workspace)
    return [
        (use, edit)
        for use in facts.values()
        for edit in name_fixes.edits(use.location, use.name, f"{use.name[:-1]}{_SLIP}")[:1]
    ]


@pytest.mark.slow
@examples(20)
@given(used=st.deferred(lambda: st.sampled_from(_uses())), letter=st.sampled_from("jqz"))
def test_a_slip_in_any_use_gives_exactly_one_sure_problem(
    used: tuple[Use, Edit], letter: str
) -> None:
    """Whatever the reader, and wherever the name is written: of its family, and in no other one."""
    use, edit = used
    text = cart_files()[edit.path]
    slip = applied(text.encode(), [edit._replace(new=edit.new.replace(_SLIP, letter))]).decode()
    found = sure(agreement_of({**cart_files(), edit.path: slip}))
    assert [it.family for it in found] == [DEFINED[use.kind].family], found


_RENAMED = [
    "right_wheel_joint",
    "camera_link",
    "base_link",
    "laser",
    "wheel_controller",
    "threshold",
    "volume",
    "obstacle_layer",
    "FollowPath",
    "sim_time",
    "controllers_file",
    "detector",
    "alarm",
    "obstacle",
    "camera/image",
    "front_camera",
    "cart_nodes",
    "cart_bringup",
    "robot.launch",
    "hall",
]


@pytest.mark.slow
@pytest.mark.parametrize("name", _RENAMED)
@examples(3)
@given(new=_others)
def test_a_name_that_is_changed_everywhere_still_agrees(name: str, new: str) -> None:
    """Names are the choice of the student: in files, folders and their names."""
    whole = re.compile(rf"(?<![A-Za-z])(?<!use_){re.escape(name)}(?![A-Za-z])(?!_layer|_wheel)")
    # The sides of the robot are part of a joint's name: xacro makes it.
    texts = {whole.sub(new, path): whole.sub(new, text) for path, text in cart_files().items()}
    texts = {
        path: text.replace("${side}_wheel_joint", _joint_of(name, new))
        for path, text in texts.items()
    }
    found = agreement_of(texts)
    assert (found.mismatches, found.undecided) == ((), {})


def _joint_of(name: str, new: str) -> str:
    """Return the name of a wheel's joint in xacro, where the one on the right has a new name."""
    return (
        f"${{'{new}' if side == 'right' else 'left_wheel_joint'}}"
        if name == "right_wheel_joint"
        else ("${side}_wheel_joint")
    )
