"""The states to which the events of a launch file lead its nodes with a lifecycle.

Sources: launch_ros/events/lifecycle/change_state.py and event_handlers/on_state_transition.py of
ros2/launch_ros, lifecycle_msgs/msg/Transition.msg of ros2/rcl_interfaces, branches jazzy.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from grader.ros.python.values import Call, QualifiedName

_FIRST = "unconfigured"
_ACTIVE = "active"
_CONFIGURE = (_FIRST, "configuring", "inactive")
_ACTIVATE = ("inactive", "activating", _ACTIVE)
_STEPS = {1: _CONFIGURE, 3: _ACTIVATE, "CONFIGURE": _CONFIGURE, "ACTIVATE": _ACTIVATE}
_OTHER_CONDITIONS = {"transition", "matcher"}  # of an OnStateTransition


class StateEvent(NamedTuple):
    """An event that leads a node from a state over a second one to a third."""

    node: Call
    steps: tuple[str, str, str]
    event: Call
    handler: Call | None  # the OnStateTransition that emits it


def read_event(event: Call, handler: Call | None) -> StateEvent | None:
    """Return what a ChangeState changes; None where that is not known."""
    transition, matcher = (
        event.kwargs.get(name) for name in ("transition_id", "lifecycle_node_matcher")
    )
    if isinstance(transition, QualifiedName):
        transition = transition.name.rpartition("TRANSITION_")[2]
    steps = _STEPS.get(transition) if isinstance(transition, int | str) else None
    node = matcher.argument(0, "action") if isinstance(matcher, Call) else None
    if steps is None or not isinstance(node, Call) or "autostart" in node.kwargs:
        return None
    if handler and not _OTHER_CONDITIONS.isdisjoint(handler.kwargs):
        return None
    return StateEvent(node, steps, event, handler)


def find_stuck(events: Sequence[StateEvent | None]) -> Iterator[tuple[StateEvent, str]]:
    """Yield an event of each node that is not activated, with the state that it stays in.

    It is one that never comes, if there is one. There are none where an event is not known.
    """
    pending = [event for event in events if event]
    if len(pending) < len(events):
        return
    states: dict[Call, str] = {}
    happened: list[tuple[Call, str, str]] = []
    for _ in events:
        for event in list(pending):
            start, between, goal = event.steps
            if states.get(event.node, _FIRST) == start and _is_emitted(event.handler, happened):
                states[event.node] = goal
                happened += [(event.node, start, between), (event.node, between, goal)]
                pending.remove(event)
    for node, event in _by_node(events, pending).items():
        if states.get(node) != _ACTIVE:
            yield event, states.get(node, _FIRST)


def _by_node(
    events: Iterable[StateEvent | None], pending: Iterable[StateEvent]
) -> dict[Call, StateEvent]:
    """Return an event of each node, one that is pending if there is one."""
    by_node = {event.node: event for event in events if event}
    return by_node | {event.node: event for event in pending}


def _is_emitted(handler: Call | None, happened: Sequence[tuple[Call, str, str]]) -> bool:
    """Return whether a handler has seen the change for which it waits."""
    if not handler:
        return True
    names = ("target_lifecycle_node", "start_state", "goal_state")
    wanted = [handler.kwargs.get(name) for name in names]
    for change in happened:
        if all(one in (None, other) for one, other in zip(wanted, change, strict=True)):
            return True
    return False
