"""Code: what stops own nodes, or keeps them from doing anything."""

from collections.abc import Iterator, Mapping

from grader.ros.launch.valid_names import is_node_name, why_no_topic
from grader.ros.nodes.node_facts import CodeRule, NodeFacts
from grader.ros.package.found_problems import syntax_fixes
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import Compared, Fact, Mismatch, Undecided, warning
from grader.workspace.rules.rule_table import (
    ACTION_RESULT,
    BUFFER_LISTENER,
    CALL_ARGUMENTS,
    CALLBACK_CALL,
    CALLBACK_PARAMETERS,
    CALLBACK_SLEEP,
    CALLBACK_WAIT,
    CODE_SYNTAX,
    COMPONENT_CONSTRUCTOR,
    COMPONENT_MACRO,
    CONSTRUCTOR_ORDER,
    ENTITY_KEPT,
    GOAL_STATE,
    NAME_BINDING,
    NAME_VALID,
    NODE_SPINS,
    PROGRAM_MAIN,
    PUBLISHER_ACTIVATED,
    RCLCPP_INIT,
    RCLPY_INIT,
    ROTATION_SET,
    SERVICE_RESPONSE,
    Rule,
)

_RULES: Mapping[CodeRule, Rule] = {
    "undefined name": NAME_BINDING,
    "callback is called": CALLBACK_CALL,
    "callback parameters": CALLBACK_PARAMETERS,
    "wrong call": CALL_ARGUMENTS,
    "no goal state": GOAL_STATE,
    "rejects goals": GOAL_STATE,
    "no result": ACTION_RESULT,
    "no response": SERVICE_RESPONSE,
    "used too early": CONSTRUCTOR_ORDER,
    "nothing spins": NODE_SPINS,
    "no rclpy.init": RCLPY_INIT,
    "waits in a callback": CALLBACK_WAIT,
    "sleeps in a callback": CALLBACK_SLEEP,
    "destroyed at once": ENTITY_KEPT,
    "no listener": BUFFER_LISTENER,
    "no rotation": ROTATION_SET,
    "not registered": COMPONENT_MACRO,
    "no main": PROGRAM_MAIN,
    "no rclcpp::init": RCLCPP_INIT,
    "no constructor": COMPONENT_CONSTRUCTOR,
    "not activated": PUBLISHER_ACTIVATED,
}


def code_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield what is wrong in the code of nodes."""
    for package, nodes in workspace.code.by_package.items():
        if nodes.has_more_faults:
            yield Undecided("code", f"the code of {package!r} is too long to search")
        if nodes.nodes or nodes.programs:  # a script may use rclpy without a node of its own
            yield Compared("code")
        for program in nodes.programs:
            if program.syntax is not None:
                at = program.syntax.location
                if program.syntax.is_certain:
                    message = f"Python cannot read the file: {program.syntax.message}"
                    fixes = syntax_fixes(program.syntax.source)
                    yield Mismatch(CODE_SYNTAX, message, at, fixes=fixes)
                else:
                    message = f"the file is not read: {program.syntax.message}"
                    yield warning(CODE_SYNTAX, message, at)
                    yield Undecided("code", f"{at.path} is not read")
        for node in nodes.nodes:
            workspace.charge(1 + len(node.endpoints))
            yield from _invalid_names(node)
        for fault in nodes.faults:
            rule = _RULES[fault.rule]
            at, related = fault.location, fault.related
            yield Mismatch(rule, fault.message, at, related, fault.is_certain, fixes=fault.fixes)


def _invalid_names(node: NodeFacts) -> Iterator[Mismatch]:
    """Yield the names of a node, and of what it opens, that ROS 2 refuses.

    They are checked as they are written in the code, before a launch file gives others.
    """
    if node.name and not is_node_name(node.name):
        message = (
            f"the name of the node, {node.name!r}, is not valid, so it stops: use letters, digits "
            "and _"
        )
        yield Mismatch(NAME_VALID, message, node.named_at or node.location)
    for endpoint in node.endpoints:
        reason = why_no_topic(endpoint.name) if endpoint.name else ""
        if reason and not endpoint.is_caught:
            name = f"the name {endpoint.name!r} of the {endpoint.kind}"
            message = f"{name} is not valid, so the node stops: {reason}"
            yield Mismatch(NAME_VALID, message, endpoint.location)
