"""Components, and the containers that a launch file starts for them, as launch_ros does.

Components are classes that a launch file loads into a container.
"""

from collections.abc import Mapping, Sequence
from contextlib import suppress

from grader.base.grouping import group_values
from grader.base.source import Location
from grader.ros.launch.call_arguments import items_in
from grader.ros.launch.launch_classes import COMPONENT, LIFECYCLE_COMPONENT
from grader.ros.launch.launch_model import (
    Container,
    Context,
    Findings,
    LoadedComponent,
    StartedNode,
    When,
)
from grader.ros.launch.node_parameters import (
    TO_ALL,
    evaluate_parameters,
    parameters_in_words,
    remap_rules,
)
from grader.ros.launch.started_nodes import (
    REMAPS,
    evaluate_remaps,
    find_description,
    namespace_below,
    read_frame_prefix,
)
from grader.ros.launch.substitutions import (
    CONDITIONS,
    PART_UNKNOWN,
    condition_holds,
    known_text,
)
from grader.ros.python.values import Call, EvaluationSignal, Value

_DESCRIPTIONS = "composable_node_descriptions"
# The options of ros2 component load and standalone, and whose they have a word each:
# ros2component/ros2component/api/__init__.py of jazzy.
_NAME = ("-n", "--node-name")
_BELOW = ("--node-namespace",)
_REMAP = ("-r", "--remap-rule")
_PARAMETER = ("-p", "--parameter")
_OF_NODE = (*_NAME, *_BELOW, *_REMAP, *_PARAMETER)
_OF_NO_NODE = ("--log-level", "-e", "--extra-argument", "-c", "--container-node-name")


def start_container(findings: Findings, call: Call, context: Context, when: When) -> None:
    """Add a container, and the components that are loaded into it."""
    try:
        namespace = namespace_below(call.kwargs["namespace"] or "", context)
        name = known_text(call.kwargs["name"], context)
    except EvaluationSignal:
        full = None
    else:
        full = _absolute(f"{namespace}/{name}")
    findings.containers.append(Container(full, when, findings.locate(call.at)))
    _add_components(findings, call, context, when, "")


def load_components(findings: Findings, call: Call, context: Context, when: When) -> None:
    """Add the components that are loaded into a container that is started elsewhere."""
    target = call.kwargs["target_container"]
    container: str | None = ""
    if not (isinstance(target, Call) and target.short == "ComposableNodeContainer"):
        try:
            # The node of launch itself asks for the service: no namespace is put before it.
            container = _absolute(known_text(target, context))
        except EvaluationSignal:
            container = None
    _add_components(findings, call, context, when, container)


def load_by_command(findings: Findings, call: Call, words: list[str], when: When) -> bool:
    """Add the component that `ros2 component load` or `standalone` loads, if a command is one.

    The latter starts a container, whose name has a number. What a launch file gives to all of its
    nodes does not reach them.
    """
    at = findings.locate(call.at)
    match words:
        case ["ros2", "component", "standalone", package, plugin, *options]:
            findings.containers.append(Container(None, when, at))
            container: str | None = ""
        case ["ros2", "component", "load", target, package, plugin, *options]:
            container = None if PART_UNKNOWN in target else _absolute(target)
        case _:
            return False
    component = LoadedComponent(None, None, when, at, at, container)
    if not any(word.startswith("-") or PART_UNKNOWN in word for word in (package, plugin)):
        loaded = StartedNode(package, plugin.removeprefix("::"), when, at, is_component=True)
        node = _with_options(loaded, options)
        component = component._replace(package=package, plugin=plugin, node=node)
    findings.components.append(component)
    return True


def _with_options(node: StartedNode, options: list[str]) -> StartedNode | None:
    """Return a node with what the options of its command give it; None if they are not known."""
    given = _words_by_option(options)
    if given is None:
        return None
    rules = remap_rules(_list_option_words(given, _REMAP))
    parameters = parameters_in_words(_list_option_words(given, _PARAMETER), node.location)
    return node._replace(
        node_name=(_list_option_words(given, _NAME) or [""])[-1],
        namespace=(_list_option_words(given, _BELOW) or [""])[-1],
        remaps=tuple((old, new) for old, _, new in rules),
        parameters=tuple(parameters),
        arguments=(),
    )


def _words_by_option(options: list[str]) -> dict[str, list[str]] | None:
    """Return what is behind each option; None if they are not known."""
    names = options[::2]
    words = options[1::2]
    is_known = len(names) == len(words) and {*names} <= {*_OF_NODE, *_OF_NO_NODE}
    if not is_known or any(PART_UNKNOWN in word for word in words):
        return None
    return group_values(zip(names, words, strict=True))


def _list_option_words(given: Mapping[str, Sequence[str]], options: Sequence[str]) -> list[str]:
    """Return the words behind some options, each behind the first of these."""
    words: list[str] = []
    for option in options:
        for word in given.get(option, ()):
            words += (options[0], word)
    return words


def _absolute(name: str) -> str:
    return f"/{name.lstrip('/')}"


def _add_components(
    findings: Findings, call: Call, context: Context, when: When, container: str | None
) -> None:
    loaded_at = findings.locate(call.at)
    unknown = LoadedComponent(None, None, when, loaded_at, loaded_at, container)
    try:
        described = items_in(call.kwargs.get(_DESCRIPTIONS) or ()) or ()
    except EvaluationSignal:
        findings.components.append(unknown)
        return
    for item in described:
        if not isinstance(item, Call) or item.name not in (COMPONENT, LIFECYCLE_COMPONENT):
            findings.components.append(unknown)
            continue
        is_loaded = _is_loaded(item, context, when)
        package = _text_if_known(item.kwargs["package"], context)
        plugin = _text_if_known(item.kwargs["plugin"], context)
        at = findings.locate(item.at)
        node = _as_node(item, package, plugin, is_loaded, context, at)
        if node and node.is_state_publisher:
            node = node._replace(frame_prefix=read_frame_prefix(item, context))
            if is_loaded is not False:
                # The process of its container may have a file of parameters for it.
                given = {"ros_arguments": (), **item.kwargs}
                find_description(findings, Call(item.name, [], given, item.at), context)
        findings.components.append(
            LoadedComponent(
                package,
                plugin,
                is_loaded,
                at,
                loaded_at,
                container,
                node=node,
            )
        )


def _as_node(
    item: Call,
    package: str | None,
    plugin: str | None,
    when: When,
    context: Context,
    at: Location,
) -> StartedNode | None:
    """Return the node that a component becomes in its container; None where its class is not known.

    The process of the container gives it neither its namespace nor its remappings.
    """
    if package is None or plugin is None:
        return None
    context = context.copy()
    context.faults, context.reads = [], []  # those of the action are noted by who visits it
    given, _ = evaluate_parameters(item, context, at)
    node = StartedNode(
        package,
        plugin.removeprefix("::"),
        when,
        at,
        namespace=None,  # until they are known
        remaps=None,
        node_name=_text_if_known(item.kwargs.get("name") or "", context),
        parameters=(*context.to_all.get(TO_ALL, ()), *given),
        included_by=context.included_by,
        is_component=True,
    )
    with suppress(EvaluationSignal):
        namespace = namespace_below(item.kwargs.get("namespace") or "", context)
        node = node._replace(namespace=namespace)
    with suppress(EvaluationSignal):
        remaps = (*context.to_all.get(REMAPS, ()), *evaluate_remaps(item, context))
        known = tuple(rule for rule in remaps if rule is not None)
        if len(known) == len(remaps):
            node = node._replace(remaps=known)
    return node


def _is_loaded(item: Call, context: Context, when: When) -> When:
    """Return whether a component is loaded by an action that is executed, or not, or perhaps."""
    condition = item.kwargs.get("condition")
    if condition is None or when is False:
        return when
    if not isinstance(condition, Call) or condition.short not in CONDITIONS:
        return None
    try:
        holds = condition_holds(condition, context)
    except EvaluationSignal:
        return None
    return when if holds else False


def _text_if_known(value: Value, context: Context) -> str | None:
    try:
        return known_text(value, context)
    except EvaluationSignal:
        return None
