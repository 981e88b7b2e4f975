"""What a rubric asks of the nodes that a launch file starts.

This is which are not started, their remappings, arguments and topics.

What cannot be determined is a fault that is not sure.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

from grader.base.grouping import StringsByName
from grader.base.names import closest, last_part
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import MAX_NAMED, enumerated, quoted
from grader.ros.installation.places import PREFIX
from grader.ros.xml.urdf_format import numbers_in

if TYPE_CHECKING:
    from grader.lab.submission.submission import Submission
    from grader.ros.launch.launch_model import Launch, StartedNode
    from grader.ros.nodes.node_facts import EndpointKind, Qos
    from grader.workspace.model.workspace import Workspace

_VERBS = {
    "publisher": "publishes",
    "subscription": "subscribes to",
    "service": "serves",
    "action server": "serves",
    "client": "calls",
    "action client": "calls",
}
# Faults in the code of a node that do not keep it from opening what it opens.
_HARMLESS = frozenset({"service-response", "entity-kept"})
_Topics = Sequence[str] | StringsByName | None  # a table has their types
_Names = Sequence[str] | None


class Wanted(Named):
    """What a rubric asks besides the nodes that are started.

    These are the arguments of the check node_runs.
    """

    absent: _Names
    remap: StringsByName | None
    arguments: _Names
    includes: _Names
    publishes: _Topics
    subscribes: _Topics
    serves: _Topics = None
    calls: _Topics = None
    spawns: _Names = None
    active: _Names = None
    qos: StringsByName | None = None


class Fault(Named):
    """What is not as a rubric asks.

    If it is not `is_certain`, it says what may not be so, after "whether".
    """

    message: str
    at: Location | None = None
    detail: str = ""
    is_certain: bool = True
    cause: str = "given"  # one of those of the check node_runs


def find_faults(
    submission: "Submission", launch: "Launch", choices: Sequence[Sequence[str]], wanted: Wanted
) -> list[Fault]:
    """Return what is not as it is wanted in a launch file.

    Args:
        submission: The submission.
        launch: The launch file.
        choices: The nodes that should be started, each with the names that it may have.
        wanted: What else is wanted.
    """
    workspace = submission.workspace
    launch = _with_node_names(launch, workspace)
    faults: list[Fault | None] = list(_started_although(launch, wanted.absent or ()))
    if wanted.remap or wanted.arguments:
        faults += [_ill_started(launch, names, wanted) for names in choices]
    faults += [_not_included(launch, end) for end in wanted.includes or ()]
    faults += _not_spawned(launch, wanted.spawns or ())
    faults += _not_opened(launch, workspace, wanted)
    faults += _not_active(launch, workspace, wanted.active or ())
    return [fault for fault in faults if fault]


def _with_node_names(launch: "Launch", workspace: "Workspace") -> "Launch":
    """Return a launch file with the nodes that may start, named as their programs name them."""
    named = []
    for node in launch.nodes:
        has_several = len(workspace.code.find_nodes(node)) > 1  # each with a name of its own
        if node.when is not False and has_several:
            named.append(node)
        elif node.when is not False:
            named.append(node._replace(node_name=workspace.code.find_name(node)))
    return launch._replace(nodes=tuple(named))


def _not_active(launch: "Launch", workspace: "Workspace", names: Sequence[str]) -> Iterator[Fault]:
    """Yield the nodes with a lifecycle that nothing activates."""
    if not names:
        return
    from grader.workspace.api import (
        LIFECYCLE_MANAGERS,
        are_nodes_activated,
        find_stuck_nodes,
        managed_nodes,
    )

    wanted = {last_part(name) for name in names}
    named = {node.location: node.node_name or "" for node in launch.nodes}
    for stuck in find_stuck_nodes(workspace, launch):
        name = named.get(stuck.node, "")
        if name in wanted:
            message = f"no event activates the node {quoted(name)}, which stays {stuck.state}"
            yield Fault(message, stuck.waiting)
    are_activated = are_nodes_activated(workspace)
    if are_activated:
        return
    managers = [node for node in launch.nodes if node.executable in LIFECYCLE_MANAGERS]
    managed, is_known = managed_nodes(workspace, managers)
    is_known = is_known and are_activated is False
    for name in names:
        if last_part(name) in managed:
            continue
        at = managers[0].location if managers else None
        if is_known and not launch.unknown:
            yield Fault(f"nothing activates the node {quoted(name)}", at)
        else:
            yield Fault(f"something activates the node {quoted(name)}", is_certain=False)


def _not_opened(launch: "Launch", workspace: "Workspace", wanted: Wanted) -> Iterator[Fault | None]:
    """Yield what nodes should open, and do not."""
    topics = _NodeTopics(launch, workspace)
    for verb, names in (
        ("publishes", wanted.publishes),
        ("subscribes to", wanted.subscribes),
        ("serves", wanted.serves),
        ("calls", wanted.calls),
    ):
        typed = names if isinstance(names, Mapping) else dict.fromkeys(names or (), "")
        for name, kind in typed.items():
            yield topics.find_fault(verb, name, kind)
    for name, others in (wanted.qos or {}).items():
        yield topics.find_quality_fault(name, others)


def _started_although(launch: "Launch", names: Iterable[str]) -> Iterator[Fault]:
    """Yield the nodes that are started, or may be, and should not."""
    for name in names:
        nodes = [node for node in launch.nodes if node.name == name]
        certain = next((node for node in nodes if node.when), None)
        if certain:
            yield Fault(f"the launch file starts {name}; it should not", certain.location, cause="")
        elif nodes or launch.unknown:
            yield Fault(f"{name} is started", is_certain=False)


def _ill_started(launch: "Launch", names: Sequence[str], wanted: Wanted) -> Fault | None:
    """Return what is wrong with a node that is started.

    None of its name has the remappings and arguments.
    """
    findings = [(node, _find_fault(node, wanted)) for node in launch.nodes if node.name in names]
    if not findings or any(not fault and node.when for node, fault in findings):
        return None
    faults = [fault for _, fault in findings if fault]
    # Whether a node without a fault is started is not known.
    is_complete = len(faults) == len(findings) and not launch.unknown
    if is_complete and all(fault.is_certain for fault in faults):
        return faults[0]
    return Fault(f"{' or '.join(names)} has these remappings and arguments", is_certain=False)


def _find_fault(node: "StartedNode", wanted: Wanted) -> Fault | None:
    """Return what is wrong with the remappings and arguments of a node."""
    if node.arguments is None:  # what launch files of other packages give their nodes is not listed
        return Fault("", is_certain=False)
    for name, to in (wanted.remap or {}).items():
        actual = node.topic(name)
        expected = node.full_name(to)
        if actual != expected:
            message = (
                f"{node.executable} has the name {actual} for {quoted(name)}; it should be "
                f"{expected}"
            )
            return Fault(
                message, node.location, is_certain=actual is not None and "~" not in actual
            )
    words = [word for given in node.arguments for word in _split_option(given)]
    for phrase in _phrases(wanted.arguments or ()):
        if not any(_is_phrase(words[at:], phrase) for at in range(len(words))):
            message = f"{node.executable} does not get the arguments {quoted(' '.join(phrase))}"
            shown = (word.removeprefix(f"{PREFIX}/share/") for word in words if word is not None)
            detail = f"; it gets {' '.join(shown) or 'none'}"
            return Fault(message, node.location, detail, is_certain=None not in words)
    return None


def _split_option(word: str | None) -> Sequence[str | None]:
    """Return the option and the value of --option=value; else the word."""
    if word is not None and word.startswith("--"):
        return word.split("=", 1)
    return [word]


def _phrases(arguments: Iterable[str]) -> Iterator[Sequence[str]]:
    """Yield each option with the words behind it; before the first option, each word."""
    phrase: list[str] = []
    for word in filter(None, (word for given in arguments for word in _split_option(given))):
        is_option = word.startswith("-") and not numbers_in(word)
        if phrase and (is_option or not phrase[0].startswith("-")):
            yield phrase
            phrase = []
        phrase.append(word)
    if phrase:
        yield phrase


def _is_phrase(words: Sequence[str | None], phrase: Sequence[str]) -> bool:
    return len(words) >= len(phrase) and all(map(_is_word, words, phrase))


def _is_word(word: str | None, wanted: str) -> bool:
    """Return whether a word is another one: numbers by their value, paths by their ends."""
    numbers = numbers_in(word or "")
    other = numbers_in(wanted)
    is_path = word is not None and word.startswith(PREFIX) and word.endswith(f"/{wanted}")
    return word == wanted or is_path or (bool(numbers) and numbers == other)


def _not_included(launch: "Launch", end: str) -> Fault | None:
    """Return that a launch file is not included."""
    ending = f"/{end.removeprefix('/')}"
    included = [passed for passed in launch.passed if f"/{passed.path}".endswith(ending)]
    if any(passed.when for passed in included):
        return None
    # Which files are included by one that is not submitted does not count.
    places = {passed.location for passed in launch.passed}
    if included or any(unknown.location not in places for unknown in launch.unknown):
        return Fault(f"{end} is included", is_certain=False)
    message = f"the launch file does not include {end}"
    if not launch.passed:
        return Fault(message, detail="; it includes none")
    paths = [passed.path.removeprefix("share/") for passed in launch.passed[:MAX_NAMED]]
    return Fault(message, launch.passed[0].location, f"; it includes {enumerated(paths)}")


def stopping_mistakes(workspace: "Workspace") -> "Mapping[str, Fault]":
    """Return by file the first mistake for which its node certainly ends."""
    from grader.workspace.rules.reading import read_agreement  # late: few rubrics ask for it

    faults: dict[str, Fault] = {}
    for mistake in read_agreement(workspace).mismatches:
        is_of_code = mistake.family in ("code", "interfaces")
        if is_of_code and mistake.is_certain and mistake.rule.name not in _HARMLESS:
            message = f"a node cannot run: {mistake.message}"
            faults.setdefault(mistake.location.path, Fault(message, mistake.location))
    return faults


def fault_of_syntax(workspace: "Workspace", node: "StartedNode", package: str) -> Fault | None:
    """Return why Python cannot read the program of a node of a package; None if it can."""
    code = workspace.code.by_package.get(package)
    for program in code.programs if code else ():
        syntax = program.syntax if program.name == node.executable else None
        if syntax is not None and syntax.is_certain:
            return Fault(f"Python cannot read the file: {syntax.message}", syntax.location)
    return None


def _not_spawned(launch: "Launch", controllers: Sequence[str]) -> Iterator[Fault]:
    """Yield the controllers that spawners do not start, in the order in which they are wanted."""
    if not controllers:
        return
    from grader.workspace.api import spawned_by  # late: as above

    spawned = spawned_by(launch)
    shown = enumerated(map(quoted, sorted(spawned.names))) or "none"
    for name in controllers:
        if name in spawned.names:
            continue
        if spawned.is_known:
            message = f"no spawner starts {quoted(name)}"
            yield Fault(message, spawned.first, f"; spawners start {shown}")
        else:
            yield Fault(f"a spawner starts {quoted(name)}", is_certain=False)


class _NodeTopic(Named):
    """What a node opens; `name` is empty where it is not known, and `type` None."""

    name: str
    verb: str
    type: str | None
    location: Location
    node: "StartedNode"
    qos: "Qos"
    written: str = ""  # its name in the code, before remapping
    is_unused: bool = False


_OpenedTopics = Sequence[_NodeTopic]


class _NodeTopics:
    """The topics, services and actions of own nodes and bridges that a launch file starts."""

    def __init__(self, launch: "Launch", workspace: "Workspace") -> None:
        from grader.workspace.api import (  # late: few rubrics ask for it
            opened_by_bridge,
            unread_includes,
        )
        from grader.workspace.graph.code_ends import opened_by

        self._topics = []
        self._is_open = bool(launch.unknown) or any(unread_includes(workspace, launch))
        self._unread: list[Fault] = []  # of programs that cannot run, and so open nothing
        self._stopping = stopping_mistakes(workspace)
        for node in launch.nodes:
            package = workspace.find_package(node)
            bridged = opened_by_bridge(workspace, node)
            if bridged is not None:
                ends, is_known = bridged
                self._is_open = self._is_open or not is_known
            elif package and self._may_run(node, workspace, package.name):
                ends = list(opened_by(workspace, node))
            else:
                continue
            for end in ends:
                self._is_open = self._is_open or not end.is_known
                name = end.name or "" if end.is_known else ""
                verb = _VERBS[end.endpoint.kind]
                opened = end.endpoint
                topic = _NodeTopic(name, verb, opened.type, opened.location, node, opened.qos)
                topic = topic._replace(written=opened.name or "", is_unused=opened.is_unused)
                self._topics.append(topic)

    def _may_run(self, node: "StartedNode", workspace: "Workspace", package: str) -> bool:
        """Return whether a node is read and may run; note why not, and what is not known of it."""
        code = workspace.code.by_package.get(package)
        doubts = list(code.doubts) if code else []
        syntax = fault_of_syntax(workspace, node, package)
        own_nodes = workspace.code.find_all_nodes(node)
        paths = [own_node.location.path for own_node in own_nodes]
        for own_node in own_nodes:  # its base class may be in another file
            paths += [end.location.path for end in own_node.endpoints]
        mistake = next((self._stopping[path] for path in paths if path in self._stopping), None)
        runs = bool(own_nodes)
        if syntax:
            self._unread.append(syntax)
            at = syntax.at
            doubts = [doubt for doubt in doubts if not at or doubt.location.path != at.path]
        elif not own_nodes or any(own_node.doubts for own_node in own_nodes):
            self._is_open = True
        elif mistake:
            self._unread.append(mistake)
            runs = False
        elif paths[0].endswith(".py") and workspace.code.has_other_nodes(node):
            self._is_open = True  # in C++, any class of another package would count
        self._is_open = self._is_open or bool(doubts)
        return runs

    def find_quality_fault(self, name: str, others: str) -> Fault | None:
        """Return that an end of a topic does not connect to nodes of another quality of service."""
        from grader.workspace.api import fault_with_others  # late: few rubrics ask

        full_name = f"/{name.removeprefix('/')}"
        ends = [topic for topic in self._topics if topic.name == full_name and topic.node.when]
        for topic in ends:
            kind: EndpointKind = "publisher" if topic.verb == "publishes" else "subscription"
            fault = fault_with_others(kind, topic.qos, others)
            if fault:
                message = (
                    f"{full_name} does not connect to nodes whose quality of service is "
                    f"{quoted(others)}"
                )
                return Fault(message, topic.location, f": {fault}", cause="quality")
        if ends:
            return None
        message = f"{'a' if self._is_open else 'no'} node opens {full_name}"
        return Fault(message, is_certain=not self._is_open, cause="topic")

    def find_fault(self, verb: str, name: str, message_type: str) -> Fault | None:
        """Return that no node publishes, subscribes to, serves or calls a name with a type."""
        full_name = f"/{name.removeprefix('/')}"
        python_type = re.sub("[/:]+", ".", message_type)
        of_kind = [topic for topic in self._topics if topic.verb == verb]
        same, unused = _split_unused(of_kind, full_name, python_type)
        for topic in same:
            if topic.node.when and python_type in (topic.type, ""):
                return None
        if self._is_open or any(topic.type in (None, python_type) for topic in same):
            typed = f" with {message_type}" if message_type else ""
            return Fault(f"a node {verb} {full_name}{typed}", is_certain=False)
        if same or unused:
            return _fault_of_other(same, unused, message_type)
        if self._unread:
            return self._unread[0]
        for topic in of_kind:
            if topic.written.removeprefix("/") == full_name.removeprefix("/") and topic.name:
                place = topic.node.location
                detail = f": line {place.line} of {place.path} remaps it to {topic.name}"
                return Fault(f"no node {verb} {full_name}", place, detail, cause="topic")
        return _find_similar_topic(f"no node {verb} {full_name}", full_name, of_kind)


def _split_unused(
    topics: _OpenedTopics, name: str, python_type: str
) -> tuple[list[_NodeTopic], list[_NodeTopic]]:
    """Return the topics of a name, and apart from them publishers of a type that are not used."""
    same = []
    unused = []
    for topic in topics:
        if topic.name != name:
            continue
        if topic.is_unused and python_type in (topic.type, ""):
            unused.append(topic)
        else:
            same.append(topic)
    return same, unused


def _fault_of_other(same: _OpenedTopics, unused: _OpenedTopics, message_type: str) -> Fault:
    """Return that a topic of the wanted name has another type, or an unused publisher."""
    if unused:
        [topic, *_] = unused
        message = f"a node opens a publisher of {topic.name}, and its code never uses it"
        return Fault(message, topic.location, cause="topic")
    [topic, *_] = same
    shown = (topic.type or "").replace(".", "/")
    message = f"a node {topic.verb} {topic.name} with {shown}; it should be {message_type}"
    return Fault(message, topic.location, cause="type")


def _find_similar_topic(message: str, full_name: str, topics: _OpenedTopics) -> Fault:
    """Return a fault with the topic whose name is like the missing one, if there is one."""
    meant = closest(full_name, [topic.name for topic in topics])
    for topic in topics:
        if topic.name == meant:
            return Fault(message, topic.location, f"; there is {quoted(meant)}", cause="topic")
    return Fault(message, cause="topic")
