"""What a rubric asks of the nodes that a launch file starts: which not, their remappings, arguments
and topics.

What cannot be determined is a fault that is not sure.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from grader.base.names import did_you_mean
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.ros.build.places import PREFIX
from grader.ros.xml.urdf_format import numbers_in

if TYPE_CHECKING:
    from grader.lab.submission.submission import Submission
    from grader.ros.launch.launch_model import Launch, StartedNode
    from grader.ros.package.python_nodes import Endpoint
    from grader.ros.workspace.workspace import Workspace

_MAX_NAMED = 5
_VERBS = {"publisher": "publishes", "subscription": "subscribes to"}
_Topics = Sequence[str] | Mapping[str, str] | None  # a table has their types


class Wanted(NamedTuple):
    """What a rubric asks besides the nodes that are started: the arguments of the check
    node_runs.
    """

    absent: Sequence[str] | None
    remap: Mapping[str, str] | None
    arguments: Sequence[str] | None
    includes: Sequence[str] | None
    publishes: _Topics
    subscribes: _Topics


class Fault(NamedTuple):
    """What is not as a rubric asks; or, if it is not `is_sure`, what may not be so, after
    "whether".
    """

    message: str
    at: Location | None = None
    detail: str = ""
    is_sure: bool = True


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
    named = [
        replace(node, node_name=workspace.name_of(node))
        for node in launch.nodes
        if node.when is not False
    ]
    launch = replace(launch, nodes=tuple(named))
    found = [*_started_although(launch, wanted.absent or ())]
    if wanted.remap or wanted.arguments:
        found += filter(None, (_ill_started(launch, names, wanted) for names in choices))
    found += filter(None, (_not_included(launch, end) for end in wanted.includes or ()))
    opened = _Opened(launch, workspace)
    for kind, topics in (("publisher", wanted.publishes), ("subscription", wanted.subscribes)):
        types = topics if isinstance(topics, Mapping) else dict.fromkeys(topics or (), "")
        found += filter(None, (opened.fault_of(kind, name, of) for name, of in types.items()))
    return found


def _started_although(launch: "Launch", names: Iterable[str]) -> Iterator[Fault]:
    """Yield the nodes that are started, or may be, and should not."""
    for name in names:
        found = sorted(
            (node for node in launch.nodes if node.name == name), key=lambda node: node.when is None
        )
        if found and found[0].when:
            yield Fault(f"the launch file starts {name}; it should not", found[0].location)
        elif found or launch.unknown:
            yield Fault(f"{name} is started", is_sure=False)


def _ill_started(launch: "Launch", names: Sequence[str], wanted: Wanted) -> Fault | None:
    """Return what is wrong with a node, if it is started, and none of its name has the remappings
    and arguments.
    """
    found = [(node, _fault_of(node, wanted)) for node in launch.nodes if node.name in names]
    faults = [fault for node, fault in found if fault is not None]
    if not found or any(fault is None and node.when for node, fault in found):
        return None
    is_sure = (
        not launch.unknown and len(faults) == len(found) and all(fault.is_sure for fault in faults)
    )
    if is_sure:
        return faults[0]
    return Fault(f"{' or '.join(names)} has these remappings and arguments", is_sure=False)


def _fault_of(node: "StartedNode", wanted: Wanted) -> Fault | None:
    """Return what is wrong with the remappings and arguments of a node."""
    if node.arguments is None:  # what launch files of other packages give their nodes is not listed
        return Fault("", is_sure=False)
    for name, to in (wanted.remap or {}).items():
        actual, expected = node.topic(name), node.full_name(to)
        if actual != expected:
            message = (
                f"{node.executable} has the name {actual} for {quoted(name)}; it should be "
                f"{expected}"
            )
            return Fault(message, node.location, is_sure=actual is not None and "~" not in actual)
    words = [word for given in node.arguments for word in _words_of(given)]
    for phrase in _phrases(wanted.arguments or ()):
        if not any(_is_phrase(words[at:], phrase) for at in range(len(words))):
            message = f"{node.executable} does not get the arguments {quoted(' '.join(phrase))}"
            shown = (word.removeprefix(f"{PREFIX}/share/") for word in words if word is not None)
            detail = f"; it gets {' '.join(shown) or 'none'}"
            return Fault(message, node.location, detail, is_sure=None not in words)
    return None


def _words_of(word: str | None) -> Sequence[str | None]:
    """Return the option and the value of --option=value; else the word."""
    if word is not None and word.startswith("--"):
        return word.split("=", 1)
    return [word]


def _phrases(arguments: Iterable[str]) -> Iterator[Sequence[str]]:
    """Yield each option with the words behind it; before the first option, each word."""
    phrase: list[str] = []
    for word in filter(None, (word for given in arguments for word in _words_of(given))):
        is_option = word.startswith("-") and not numbers_in(word)
        if phrase and (is_option or not phrase[0].startswith("-")):
            yield phrase
            phrase = []
        phrase.append(word)
    yield phrase


def _is_phrase(words: Sequence[str | None], phrase: Sequence[str]) -> bool:
    return len(words) >= len(phrase) and all(map(_is_word, words, phrase))


def _is_word(word: str | None, wanted: str) -> bool:
    """Return whether a word is another one: numbers by their value, paths by their ends."""
    own, other = numbers_in(word or ""), numbers_in(wanted)
    is_path = word is not None and word.startswith(PREFIX) and word.endswith(f"/{wanted}")
    return word == wanted or is_path or (bool(own) and own == other)


def _not_included(launch: "Launch", end: str) -> Fault | None:
    """Return that a launch file is not included."""
    found = [it for it in launch.passed if f"/{it.path}".endswith(f"/{end.removeprefix('/')}")]
    if any(it.when for it in found):
        return None
    # Which files are included by one that is not submitted does not count.
    places = {it.location for it in launch.passed}
    if found or any(it.location not in places for it in launch.unknown):
        return Fault(f"{end} is included", is_sure=False)
    paths = [it.path.removeprefix("share/") for it in launch.passed]
    detail = f"; it includes {enumerated(paths[:_MAX_NAMED])}" if paths else "; it includes none"
    return Fault(
        f"the launch file does not include {end}",
        launch.passed[0].location if paths else None,
        detail,
    )


class _Opened:
    """The topics of the nodes of a workspace that a launch file starts."""

    def __init__(self, launch: "Launch", workspace: "Workspace") -> None:
        self._topics: list[tuple[str, Endpoint, StartedNode]] = []
        self._is_open = bool(launch.unknown)
        for node in launch.nodes:
            package, own = workspace.package_of(node), workspace.python_node(node)
            if package is not None:
                is_read = (
                    own is not None
                    and not own.doubts
                    and not workspace.python_nodes[package.name].doubts
                )
                self._is_open = self._is_open or not is_read
            for endpoint in (
                [it for it in own.endpoints if it.kind in _VERBS] if own is not None else ()
            ):
                topic = node.topic(endpoint.name) if endpoint.name is not None else None
                self._is_open = self._is_open or topic is None or "~" in topic
                self._topics.append((topic or "", endpoint, node))

    def fault_of(self, kind: str, name: str, of: str) -> Fault | None:
        """Return that no node publishes a topic, or subscribes to it, with a type."""
        full, type_ = f"/{name.removeprefix('/')}", re.sub("[/:]+", ".", of)
        own = [it for it in self._topics if it[1].kind == kind]
        found = [it for it in own if it[0] == full]
        if any(
            node.when and endpoint.type == (type_ or endpoint.type) for _, endpoint, node in found
        ):
            return None
        is_sure = not self._is_open and all(
            endpoint.type not in (None, type_) for _, endpoint, node in found
        )
        if not is_sure:
            return Fault(
                f"a node {_VERBS[kind]} {full}{f' with {of}' if of else ''}", is_sure=False
            )
        if found:
            actual = (found[0][1].type or "").replace(".", "/")
            return Fault(
                f"a node {_VERBS[kind]} {full} with {actual}; it should be {of}",
                found[0][1].location,
            )
        names = [topic for topic, *_ in own]
        detail = did_you_mean(full, names)
        at = next((endpoint.location for topic, endpoint, _ in own if repr(topic) in detail), None)
        return Fault(f"no node {_VERBS[kind]} {full}", at, detail)
