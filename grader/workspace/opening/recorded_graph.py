"""The topics of a recording beside those of a launch: what was heard of what nodes publish."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from grader.ros.nodes.node_facts import EndpointKind
from grader.ros.recording.recorded_topics import RecordedTopic
from grader.ros.recording.recording import Recording
from grader.workspace.graph.launch_graph import GraphEnd, GraphNode, LaunchGraph
from grader.workspace.graph.message_ways import is_named, may_open, why_end_is_open

_SENDS: Sequence[EndpointKind] = ("publisher",)
_HIDDEN = frozenset({"/rosout", "/parameter_events", "/events/write_split", "/tf", "/tf_static"})


class HeardTopic(NamedTuple):
    """What was heard on a topic, the nodes that publish it, and how the two differ."""

    topic: RecordedTopic  # without types if it was not recorded
    publishers: Sequence[str]
    differences: Sequence[str]


def compare_recording(graph: LaunchGraph, recording: Recording) -> list[HeardTopic]:
    """Return the topics that were recorded, or that nodes certainly publish."""
    is_whole = not graph.unread and not any(may_open(node, _SENDS) for node in graph.nodes)
    ends = [(node, end) for node in graph.nodes for end in node.ends if end.kind in _SENDS]
    certain = {end.name for node, end in ends if not why_end_is_open(node, end)}
    heard: list[HeardTopic] = []
    for name in sorted({*certain, *recording.topics} - _HIDDEN):
        topic = recording.topics.get(name) or RecordedTopic(name, ())
        publishers = [(node, end) for node, end in ends if is_named(end.name, name)]
        differences = list(_list_differences(topic, publishers))
        if not publishers and is_whole:
            differences.append("nothing here publishes it")
        labels = dict.fromkeys(node.label for node, _ in publishers)
        heard.append(HeardTopic(topic, list(labels), differences))
    return heard


def _list_differences(
    topic: RecordedTopic, publishers: Sequence[tuple[GraphNode, GraphEnd]]
) -> Iterator[str]:
    """Yield how a topic differs from what nodes publish, as far as both are known."""
    if not topic.count:
        yield "never heard" if topic.types else "not recorded"
        return
    for node, end in publishers:
        if why_end_is_open(node, end):
            continue
        if end.type and end.type not in topic.types:
            yield f"{node.label} publishes {end.type}"
        for meant in _list_other_qualities(end, topic):
            yield f"{node.label} publishes {meant.replace('_', ' ')}"


def _list_other_qualities(end: GraphEnd, topic: RecordedTopic) -> Iterator[str]:
    """Yield the qualities of service of an end that a recording has otherwise."""
    for meant, recorded in zip(end.qos[1:], topic.qos, strict=True):
        if meant and recorded and meant != recorded:
            yield str(meant)
