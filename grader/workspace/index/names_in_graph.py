"""The topics, services and actions of a workspace, at the last part of each name.

They are those of the graph of each launch file, and those that own code opens without one. A name
is the same wherever it is written: `scan` in code, `/robot/scan` in a file of RViz, the second
name of a remapping. Its owner is the full name, or the program in which a remapping replaces it.
"""

import re
from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain
from string import ascii_letters, digits
from typing import NamedTuple

from grader.base.names import last_part
from grader.base.source import Location, Source, SourceOf
from grader.ros.launch.launch_model import StartedNode
from grader.ros.nodes.node_facts import NodeFacts, NodeFrame
from grader.workspace.graph.bridge_rows import BridgeRow, bridge_rows
from grader.workspace.graph.code_ends import End, opened_by_code
from grader.workspace.graph.gazebo_topics import gazebo_topics
from grader.workspace.graph.graph import make_graph
from grader.workspace.graph.launch_graph import CARRIES, OFFERS, PART_UNKNOWN, GraphEnd, LaunchGraph
from grader.workspace.graph.rviz_ends import ends_of_displays, ends_of_tools, list_rviz_files
from grader.workspace.graph.started_controllers import defined_controllers
from grader.workspace.index.written_names import (
    Role,
    Span,
    WrittenName,
    call_end,
    find_written,
    span_of_name,
    written_name,
)
from grader.workspace.model.launches import SPAWNERS, list_spawned
from grader.workspace.model.text_files import CODE_ENDINGS
from grader.workspace.model.workspace import Workspace

_RVIZ = "rviz2"  # the program
_GAZEBO = "Gazebo"  # owns the topics on the other side of a bridge
_QUOTE = "[\"']"
_OF_NAMES = f"{ascii_letters}{digits}_~/-"
_MAX_BEFORE = 200  # characters of a name


class ComputedName(NamedTuple):
    """A name that something opens, and that is written nowhere: a rename cannot change it.

    PART_UNKNOWN stands for what is not known of it.
    """

    kind: str
    name: str  # in full
    location: Location
    reason: str


class _EndPlace(NamedTuple):
    """Where a name of the graph is written: the candidates for its text, the longest first."""

    kind: str
    full: str
    location: Location
    texts: Sequence[str]
    role: Role
    owner: str
    reason: str  # why it is not written there


_Names = Iterator[WrittenName | ComputedName]


class GraphNames:
    """Reads the names of topics, services and actions of a workspace."""

    def __init__(self, workspace: Workspace, source_of: SourceOf) -> None:
        self._workspace = workspace
        self._source_of = source_of

    @cached_property
    def graphs(self) -> Sequence[LaunchGraph]:
        """The graph of each launch file that no other one includes."""
        return make_graph(self._workspace).launched

    @cached_property
    def _nodes(self) -> Mapping[str, str]:
        """The full names of nodes, each with whether it is a node or a controller."""
        kinds = {}
        for graph in self.graphs:
            for node in graph.nodes:
                if node.name:
                    kinds[node.name] = "controller" if node.kind == "controller" else "node"
        for controller in defined_controllers(self._workspace):
            kinds.setdefault(f"/{controller.name}", "controller")
        return kinds

    @cached_property
    def _carriers(self) -> Mapping[str, Sequence[str]]:
        """What there is by a full name: a topic, a service, an action."""
        carriers: dict[str, dict[str, None]] = {}
        for graph in self.graphs:
            for end in chain.from_iterable(node.ends for node in graph.nodes):
                carriers.setdefault(end.name, {})[end.carrier] = None
        return {name: list(kinds) for name, kinds in carriers.items()}

    def names(self) -> _Names:
        """Yield the names, and those that are not written. Raises NotDecided."""
        read = {row.location for row in bridge_rows(self._workspace)}
        for node, facts, launch in self._own_nodes():
            for end in opened_by_code(self._workspace, node, facts, launch):
                read.add(end.location)
                yield from self._end_of_code(end, facts)
        yield from self._remappings()
        for graph in self.graphs:
            for graph_node in graph.nodes:
                for graph_end in graph_node.ends:
                    # What its tools publish is in its file.
                    is_of_tool = graph_node.program == _RVIZ and graph_end.kind == "publisher"
                    if graph_end.location not in read and not is_of_tool:
                        yield from self._end_of_program(graph_end, graph_node.label)
        yield from self._in_rviz_files()
        yield from self._bridges()

    def _in_rviz_files(self) -> _Names:
        """Yield the topics that displays and tools name in the files of RViz."""
        for rviz in list_rviz_files(self._workspace):
            node = StartedNode("rviz2", "rviz2", True, Location(rviz.source.path, 1, 1))
            if not rviz.fault:
                ends = list(ends_of_displays(rviz, node))
                for end in (*ends, *ends_of_tools(rviz, node, is_placed=True)):
                    yield from self._end_of_program(end, "RViz")

    def nodes(self) -> Iterator[WrittenName]:
        """Yield the names of nodes, where launch files and code give them."""
        for _, facts, _ in self._own_nodes():
            source = self._source_of(facts.location.path)
            span = _span_in_code(source, facts) if source else None
            if source and span is not None:
                yield written_name(source, span, "node", facts.name or "", "definition")
        for _, node in self._workspace.launches.launched:
            if node.node_name:
                source = self._source_of(node.location.path)
                yield from find_written(source, node.location, "node", node.node_name, "definition")

    def parameters(self) -> Iterator[WrittenName]:
        """Yield the parameters that nodes declare and are given, also in a section for every node.

        Such a section is one place of the parameters of several nodes.
        """
        for node, facts, launch in self._own_nodes():
            declared = {parameter.name for parameter in facts.parameters}
            if launch < 0 or not declared:
                continue
            package, _ = self._workspace.launches.roots[launch]
            given = self._workspace.parameters.given_in_code(package, node, facts.name)
            for parameter, value in given.values.items():
                if parameter in declared:
                    at = value.name_location
                    owner = node.program_path
                    yield from self._written(at, "parameter", parameter, "use", owner)

    def _written(
        self, at: Location, kind: str, name: str, role: Role, owner: str = ""
    ) -> Iterator[WrittenName]:
        """Yield a name if what begins at a place has it, and not an expression that makes it."""
        for written in find_written(self._source_of(at.path), at, kind, name, role, owner):
            if not written.is_made:
                yield written

    def frames(self) -> _Names:
        """Yield the frames that code names, and those that it makes of parts."""
        for code in self._workspace.code.by_package.values():
            frames = list(code.loose_frames)
            for facts in code.nodes:
                frames += facts.frames
                for sent in facts.transforms:
                    frames += (sent.parent, sent.child)
            for frame in frames:
                yield from self._frame(frame)

    def _frame(self, frame: NodeFrame) -> _Names:
        """Yield a frame that code names, or that it makes of parts of which one is known."""
        if frame.name is None:
            texts = [part.text if part.kind == "text" else PART_UNKNOWN for part in frame.parts]
            if any(text.strip(PART_UNKNOWN) for text in texts):
                reason = "code makes a frame of parts"
                yield ComputedName("frame", "".join(texts), frame.location, reason)
            return
        role: Role = "definition" if frame.use == "publishes" else "use"
        yield from self._written(frame.location, "frame", frame.name.removeprefix("/"), role)

    def _own_nodes(self) -> Iterator[tuple[StartedNode, NodeFacts, int]]:
        """Yield the nodes of own code as they are started, also where no launch file does so."""
        code = self._workspace.code
        launched = set()
        for number, node in self._workspace.launches.launched:
            owner = self._workspace.find_package(node)
            if owner:
                launched.add((owner.name, node.executable))
            for facts in code.find_nodes(node):
                yield node, facts, number
        for package, nodes in code.by_package.items():
            for program in nodes.programs:
                if (package, program.name) not in launched:
                    started = StartedNode(package, program.name, True, program.location)
                    for facts in program.nodes:
                        yield started, facts, -1

    def _end_of_code(self, end: End, facts: NodeFacts) -> _Names:
        """Yield the name of an end where code writes it, or the parameter that has it."""
        kind = CARRIES[end.kind]
        endpoint = end.endpoint
        reason = f"a {end.kind} of {end.owner} has a name that is computed"
        if endpoint.name is None:
            yield from self._computed_end(end, facts, reason)
            return
        node = end.node if end.node.node_name else end.node._replace(node_name=facts.name)
        before = node.full_name(endpoint.name)
        owner = "" if before == end.name else _owner_in_program(node, before)
        if not end.is_known and not owner:
            yield ComputedName(kind, end.name, endpoint.location, reason)
        role = "definition" if owner else _role(end.kind)
        at = endpoint.location
        texts = (endpoint.name,)
        yield from self._names_at(_EndPlace(kind, before, at, texts, role, owner, reason))

    def _computed_end(self, end: End, facts: NodeFacts, reason: str) -> _Names:
        """Yield the name of an end that code makes of parts."""
        kind = CARRIES[end.kind]
        full = end.name
        span = self._span_of_end(end)
        source = self._source_of(end.location.path)
        if span is not None and source:
            yield from _last_part(source, span, kind, full, _role(end.kind), full)
            return
        at = self._place_of_parameter(end, facts)
        if not at or not end.is_known:
            yield ComputedName(kind, full, at or end.location, reason)
            return
        place = _EndPlace(kind, full, at, _texts(full), _role(end.kind), "", reason)
        yield from self._names_at(place)

    def _span_of_end(self, end: End) -> Span | None:
        """Return the span of the text in which a computed name ends, with a slash: f"{name}/state".

        A remapping may replace a name that is computed.
        """
        parts = end.endpoint.parts
        at = end.location
        source = self._source_of(at.path)
        last = parts[-1] if len(parts) > 1 else None
        if not source or not last or last.kind != "text" or not end.is_known:
            return None
        name = f"/{end.name.rpartition('/')[2]}"
        if not last.text.endswith(name):
            return None
        start = source.start_offset(at)
        written = re.compile(rf"{re.escape(last.text)}(?={_QUOTE})")
        match = written.search(source.text, start, call_end(source, start))
        return (match.end() - len(name) + 1, match.end()) if match else None

    def _place_of_parameter(self, end: End, facts: NodeFacts) -> Location | None:
        """Return where the value of the only part of a name is written, if that is a parameter."""
        parts = end.endpoint.parts
        package = self._workspace.find_package(end.node)
        if len(parts) != 1 or parts[0].kind != "parameter" or not package:
            return None
        given = self._workspace.parameters.given_in_code(package, end.node, facts.name)
        if parts[0].text in given.values:
            return given.values[parts[0].text].location
        for parameter in facts.parameters:
            if parameter.is_declared and parameter.name == parts[0].text:
                return parameter.location
        return None

    def _remappings(self) -> _Names:
        """Yield both names of the remappings of nodes."""
        for node in self._remapped_nodes():
            for rule in node.remaps or ():
                if len(rule) > 1 and not rule[0].startswith("__") and ":" not in rule[0]:
                    yield from self._remapping(node, rule)
            if node.remaps is None:
                at = node.location
                reason = f"the remappings of {node.name} are computed"
                yield ComputedName("topic", PART_UNKNOWN, at, reason)

    def _remapped_nodes(self) -> Iterator[StartedNode]:
        """Yield the nodes and the controllers that spawners start, with their remappings."""
        for _, node in self._workspace.launches.launched:
            yield node
            yield from list_spawned(node)

    def _remapping(self, node: StartedNode, rule: Sequence[str]) -> _Names:
        if not node.node_name:
            node = node._replace(node_name=self._workspace.code.find_name(node) or "")
        before = node.full_name(rule[0])
        after = node.full_name(rule[1])
        kinds = self._carriers.get(after, ["topic"])
        source = self._source_of(node.location.path)
        spans = _spans_of_rule(source, node.location, rule) if source else []
        if not source or not spans:
            for kind in kinds:
                reason = f"a remapping of {node.name} is computed"
                yield ComputedName(kind, after, node.location, reason)
            return
        for first, second in spans:
            for kind in kinds:
                # Those of a spawner itself are of no use to its controllers.
                is_spawner = node.executable in SPAWNERS and node.arguments != ()
                owner = before if is_spawner else _owner_in_program(node, before)
                yield from _last_part(source, first, kind, before, "use", owner)
                yield from _last_part(source, second, kind, after, "use", after)
            yield from self._nodes_in(source, first, before)
            yield from self._nodes_in(source, second, after)

    def _end_of_program(self, end: GraphEnd, opened_by: str) -> _Names:
        """Yield the name of an end of the graph where a file other than code writes it."""
        role = _role(end.kind)
        texts = _texts(end.name)
        if end.location in self._started:
            texts = ()
        before = self._remapped.get(end.name, {})
        if end.location in before or f"{opened_by}/" in before.values():
            return
        reason = f"{opened_by} has a {end.kind} of this name, and no file writes it"
        yield from self._names_at(
            _EndPlace(end.carrier, end.name, end.location, texts, role, "", reason)
        )

    @cached_property
    def _started(self) -> Collection[Location]:
        """Where nodes are started."""
        return {node.location for _, node in self._workspace.launches.launched}

    @cached_property
    def _remapped(self) -> Mapping[str, Mapping[Location, str]]:
        """The full names that remappings give, each with the nodes and the namespaces before."""
        names: dict[str, dict[Location, str]] = {}
        for node in self._remapped_nodes():
            for rule in node.remaps or ():
                if len(rule) > 1:
                    space = node.full_name(rule[0]).rpartition("/")[0]
                    names.setdefault(node.full_name(rule[1]), {})[node.location] = f"{space}/"
        return names

    def _bridges(self) -> _Names:
        """Yield the topics of bridges on both sides, and those of Gazebo."""
        for row in bridge_rows(self._workspace):
            yield from self._row(row)
        for topic in gazebo_topics(self._workspace):
            owner = f"{_GAZEBO} /{topic.name}"
            reason = "Gazebo makes this topic of another one"
            role: Role = "use" if topic.is_input else "definition"
            place = _EndPlace(
                "topic", f"/{topic.name}", topic.location, _texts(topic.name), role, owner, reason
            )
            yield from self._names_at(place)

    def _row(self, row: BridgeRow) -> _Names:
        role: Role = "definition" if row.is_published else "use"
        ros = f"/{row.ros}"
        gz = f"/{row.gz}"
        source = self._source_of(row.location.path)
        reason = "a bridge is given a topic that is computed"
        if source and row.location == row.ros_type_location:
            span = _span_in_argument(source, row)
            if span is None:
                yield ComputedName("topic", ros, row.location, reason)
                return
            yield from _last_part(source, span, "topic", ros, role, ros)
            yield from _last_part(source, span, "topic", gz, role, f"{_GAZEBO} {gz}")
            return
        at = row.ros_location
        texts = _texts(row.ros)
        yield from self._names_at(_EndPlace("topic", ros, at, texts, role, "", reason))
        owner = f"{_GAZEBO} {gz}"
        texts = _texts(row.gz)
        yield from self._names_at(_EndPlace("topic", gz, row.location, texts, "use", owner, reason))

    def _names_at(self, place: _EndPlace) -> _Names:
        """Yield a name at the last part of its text, and the nodes in the parts before."""
        source = self._source_of(place.location.path)
        span = _written_span(source, place) if source else None
        if not source or span is None:
            yield ComputedName(place.kind, place.owner or place.full, place.location, place.reason)
            return
        owner = place.owner or place.full
        yield from _last_part(source, span, place.kind, place.full, place.role, owner)
        yield from self._nodes_in(source, span, place.full)

    def _nodes_in(self, source: Source, span: Span, full: str) -> Iterator[WrittenName]:
        """Yield the nodes and controllers in the parts of a name before the last one."""
        text = source.text[slice(*span)]
        parts = text.split("/")
        every = full.split("/")
        start = span[0]
        for number, part in enumerate(parts[:-1]):
            above = "/".join(every[: len(every) - len(parts) + number + 1])
            kind = self._nodes.get(above)
            if kind is not None and part == last_part(above):
                yield written_name(source, (start, start + len(part)), kind, part, "use")
            start += len(part) + 1


def _span_in_code(source: Source, facts: NodeFacts) -> Span | None:
    """Return the span of the name that the code of a node gives it."""
    if not facts.name:
        return None
    start = source.start_offset(facts.location)
    name = re.escape(facts.name)
    given = re.compile(
        rf"(?:\b__init__|\b(?:Lifecycle)?Node|\bcreate_node|\bmake_shared<[\w:]++>)\s*+[({{]"
        rf"(?:\s*+self\s*+,)?(?:\s*+node_name\s*+=)?\s*+{_QUOTE}(?P<name>{name}){_QUOTE}"
    )
    match = given.search(source.text, start)
    return match.span("name") if match else None


def _role(kind: str) -> Role:
    return "definition" if kind in OFFERS else "use"


def _owner_in_program(node: StartedNode, name: str) -> str:
    """Return what owns a name that a remapping replaces: the program, and the name."""
    return f"{node.name} {name}"


def _texts(full: str) -> Sequence[str]:
    """Return how a name may be written: in full, or without namespaces."""
    parts = full.strip("/").split("/")
    return [f"/{'/'.join(parts)}", *("/".join(parts[first:]) for first in range(len(parts)))]


def _written_span(source: Source, place: _EndPlace) -> Span | None:
    """Return the span of a name in what begins at its place."""
    first = source.start_offset(place.location)
    for text in place.texts:
        span = span_of_name(source, place.location, "topic", text, place.role)
        if span is None or (span[0] < first and not source.path.endswith(CODE_ENDINGS)):
            continue  # a key of YAML, and not the constant of a call
        start, end = span
        is_whole = source.text[slice(*span)].strip("/") == text.strip("/")
        if is_whole and source.text[end : end + 1] != "/":
            before = source.text[max(0, start - _MAX_BEFORE) : start]
            return start - len(before) + len(before.rstrip(_OF_NAMES)), end
    return None


def _last_part(
    source: Source, span: Span, kind: str, full: str, role: Role, owner: str
) -> Iterator[WrittenName]:
    """Yield a name at the last part of its text."""
    name = last_part(full)
    if name and last_part(source.text[slice(*span)]) == name:
        yield written_name(source, (span[1] - len(name), span[1]), kind, name, role, owner)


def _span_in_argument(source: Source, row: BridgeRow) -> Span | None:
    """Return the span of the topic in the argument of a bridge: /scan@sensor_msgs/..."""
    start = source.start_offset(row.location)
    argument = re.compile(rf"{_QUOTE}(?P<topic>/?{re.escape(row.ros)})@")
    match = argument.search(source.text, start, call_end(source, start))
    return match.span("topic") if match else None


def _spans_of_rule(source: Source, where: Location, rule: Sequence[str]) -> list[tuple[Span, Span]]:
    """Return the spans of both names of a remapping.

    They are those in the call or element that starts the node; without any, all in its file.
    """
    first, second = (re.escape(name) for name in rule[:2])
    if source.path.endswith(".py"):
        pattern = (
            rf"(?P<a>{_QUOTE})(?P<from>{first})(?P=a)\s*+,\s*+(?:\w++\s*+=\s*+)?"
            rf"(?P<b>{_QUOTE})(?P<to>{second})(?P=b)"
        )
        in_words = rf"(?<![\w/~:.])(?P<from>{first}):=(?P<to>{second})(?![\w/])"
        if re.search(in_words, source.text):  # of a command line
            pattern = in_words
    elif source.path.endswith((".yaml", ".yml")):
        from_key = rf"from:\s*+{_QUOTE}?(?P<from>{first}){_QUOTE}?\s*+"
        pattern = rf"{from_key}to:\s*+{_QUOTE}?(?P<to>{second})(?![\w/])"
    else:
        start_tag = rf"<remap\s++from\s*+=\s*+{_QUOTE}(?P<from>{first}){_QUOTE}\s++"
        pattern = rf"{start_tag}to\s*+=\s*+{_QUOTE}(?P<to>{second}){_QUOTE}"
    start = source.start_offset(where)
    matches = list(re.finditer(pattern, source.text))
    end = call_end(source, start)
    inside = [match for match in matches if start <= match.start() < end]
    return [(match.span("from"), match.span("to")) for match in inside or matches]
