"""Gains of controllers: one that computes commands with gains moves nothing if none is given."""

from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import quoted
from grader.ros.known.package_rows import GainsRow
from grader.ros.launch.node_parameters import NodeParameters
from grader.ros.python.values import Unknown
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    warning,
)
from grader.workspace.rules.rule_table import (
    MOVES_NOTHING,
    Rule,
)


class _LackingGains(Named):
    """A joint without gains, the interface of its commands, and where this is asked for."""

    joint: str
    interface: str
    location: Location


def gain_facts(workspace: Workspace) -> Facts:
    """Yield the controllers that are given no gains for a joint, and need them."""
    for controller in defined_controllers(workspace):
        gains = controller.row.gains
        gifts = workspace.parameters.owners.get(controller.name, [])
        if not gains or not gifts or any(given.unknown for given in gifts):
            continue
        workspace.charge(len(gifts))
        yield Compared("effects")
        lacks = [lack for given in gifts if (lack := _find_lack(gains, given))]
        if len(lacks) == len(gifts):
            first = lacks[0]
            message = (
                f"{controller.name} commands the {first.interface} of {quoted(first.joint)} "
                f"without gains, so it moves nothing: give it gains.{first.joint}.p"
            )
            yield warning(_GAIN_SET, message, first.location)


def _find_lack(row: GainsRow, given: NodeParameters) -> _LackingGains | None:
    """Return the first joint without gains; None where there is none, or this is not known."""
    interfaces = _texts(given, row.interfaces)
    if len(interfaces) != 1 or interfaces[0] not in row.of:
        return None
    [interface] = interfaces
    if row.without.get(interface) in given.values:
        return None
    for joint in _texts(given, row.joints):
        gains = [given.values.get(f"gains.{joint}.{name}") for name in row.names]
        if all(not gain or gain.value in (0, 0.0) for gain in gains):
            return _LackingGains(joint, interface, given.values[row.interfaces].location)
    return None


def _texts(given: NodeParameters, name: str) -> list[str]:
    """Return the texts in a list; none where it is not known."""
    parameter = given.values.get(name)
    value = parameter.value if parameter else None
    if isinstance(value, Unknown) or not isinstance(value, list):
        return []
    return [text for text in value if isinstance(text, str)]


_GAIN_SET = Rule(
    "gain-set",
    "effects",
    MOVES_NOTHING,
    "A controller that computes efforts or velocities with gains has gains.",
    why=(
        "All gains are 0 by default, so each command is 0. The controller is active and accepts"
        " trajectories, but nothing moves."
    ),
    wrong="""
joints: [arm_joint]
command_interfaces: [effort]
""",
    right="""
joints: [arm_joint]
command_interfaces: [effort]
gains: {arm_joint: {p: 20.0, d: 1.0}}
""",
    frame="gains/controllers.yaml",
    beside={
        "arm/rover.urdf": "",
        "spawn/rover.launch.py": "",
    },
)
