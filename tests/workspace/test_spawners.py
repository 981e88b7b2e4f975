"""Spawners: the controllers and managers that they name, types that nobody is given, and controllers that none starts."""

import pytest

from tests.workspace.carts import Edit, agreement_of, edited, sure

pytestmark = pytest.mark.slow

_LAUNCH, _CONTROLLERS = "launch/robot.launch.py", "config/controllers.yaml"
_FIRST = 'Node(package="controller_manager", executable="spawner", arguments=["joint_state_broadcaster"]),\n        '
_SECOND = """Node(
            package="controller_manager",
            executable="spawner",
            arguments=["wheel_controller", "--param-file", controllers],
        ),
        """
_AT = "cart_bringup/config/controllers.yaml"


def with_manager(given: str, *more: Edit) -> list[str]:
    """Return what is certainly wrong if the launch file also starts a controller manager, with more edits."""
    manager = (
        f'Node(package="controller_manager", executable="ros2_control_node"{given}),\n        '
    )
    edits = [(_LAUNCH, _FIRST, manager + _FIRST), *more]
    return [it.message for it in sure(agreement_of(edited(*edits)))]


GIVEN = ", parameters=[controllers]"
NO_TYPE = "the controller manager is not given the parameters with the type of"


@pytest.mark.parametrize(
    ("given", "more", "found"),
    [
        (GIVEN, [], []),
        (
            ", parameters=[{'joint_state_broadcaster.type': 'a/A', 'wheel_controller': {'type': 'b/B'}}]",
            [],
            [],
        ),
        (", parameters=[LaunchConfiguration('sim_time')]", [], []),  # a file that is not known
        ("", [], [f"{NO_TYPE} 'joint_state_broadcaster' and 'wheel_controller' ({_AT}:4)"]),
        (
            "",
            [(_LAUNCH, '["joint_state_broadcaster"', '["joint_state_broadcaster", "-t", "a/A"')],
            [f"{NO_TYPE} 'wheel_controller' ({_AT}:6)"],
        ),
        (
            "",
            [
                (
                    _CONTROLLERS,
                    "left_wheel_names:",
                    "type: diff_drive_controller/DiffDriveController\n    left_wheel_names:",
                )
            ],
            [f"{NO_TYPE} 'joint_state_broadcaster' ({_AT}:4)"],
        ),
        (
            GIVEN,
            [(_LAUNCH, '"--param-file"', '"-c", "/controller_managr", "--param-file"')],
            [
                (
                    "spawner: there is no controller manager 'controller_managr'; did you mean 'controller_manager'"
                    " (cart_bringup/launch/robot.launch.py:22)?"
                )
            ],
        ),
        (
            GIVEN,
            [(_LAUNCH, '"--param-file"', '"-c", "/cart/controller_manager", "--param-file"')],
            [],
        ),
        (
            GIVEN,
            [(_LAUNCH, '"--param-file"', '"-c", "/driver", "--param-file"')],
            [],
        ),  # of something else
    ],
)
def test_a_manager_knows_the_controllers(given: str, more: list[Edit], found: list[str]) -> None:
    """It has the type of each from its own parameters, or from the spawner; the spawner waits for the manager it names."""
    assert with_manager(given, *more) == found


@pytest.mark.parametrize(
    ("more", "found"),
    [
        ([(_LAUNCH, _FIRST, "")], ["no spawner starts 'joint_state_broadcaster'"]),
        ([(_LAUNCH, _SECOND, "")], ["no spawner starts 'wheel_controller'"]),
        ([(_LAUNCH, _SECOND, "*more_nodes(),\n        ")], []),
        (
            [
                (_LAUNCH, _SECOND, ""),
                (
                    _LAUNCH,
                    "    return",
                    '    load = "ros2 control load_controller wheel"\n    return',
                ),
            ],
            [],
        ),
        (
            [(_LAUNCH, '["wheel_controller"', '["wheel_controler"')],
            [
                f"spawner: there is no controller 'wheel_controler'; did you mean 'wheel_controller' ({_AT}:6)?"
            ],
        ),
    ],
)
def test_a_controller_that_nothing_starts(more: list[Edit], found: list[str]) -> None:
    """Of those that publish, and of those that move joints, one is started, unless that may be done elsewhere."""
    assert with_manager(GIVEN, *more) == found


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("controller_manager", []),
        (
            "controlle_manager",
            [
                (
                    "the controller manager does not read the types below 'controlle_manager'; did you mean"
                    " 'controller_manager'?"
                )
            ],
        ),
        ("driver", []),  # a name that a driver may have
    ],
)
def test_a_misspelt_section_of_types(name: str, found: list[str]) -> None:
    edit = (_CONTROLLERS, "controller_manager:", f"{name}:")
    assert [it.message for it in sure(agreement_of(edited(edit)))] == found
