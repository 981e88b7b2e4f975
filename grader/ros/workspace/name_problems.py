"""The kinds of problems of names: one for each family, for similar names, for unused
files, and for names of other releases.

docs/examples/ref.toml explains each.
"""

from collections.abc import Mapping
from functools import partial

from grader.base.problems import Kind, Problem, kinds_in
from grader.ros.workspace.names import (
    NO_EFFECT,
    OF_OTHER_RELEASE,
    UNCONNECTED,
    UNKNOWN_PARAMETER,
    Agreement,
    AnyFamily,
)

_error = partial(Kind, severity="error", effect="other")
_warning = partial(Kind, severity="warning", effect="other")

_NO_FILE = _error("REF001", "File that a build does not install")
_NO_FRAME = _error("REF002", "Frame, link or joint that does not exist")
_NO_CONTROLLER = _error("REF003", "Controller or interface that does not exist")
_NO_PARAMETER = _error("REF004", "Parameters that no node gets, or that a node does not accept")
_NO_ARGUMENT = _error("REF005", "Argument that nothing declares")
_NO_PROGRAM = _error("REF006", "Program, entry point or node that does not exist")
_NO_TOPIC = _error("REF007", "Topic with another name, type or quality of service")
_NO_DEPENDENCY = _warning("REF008", "Package that package.xml does not declare")
_SIMILAR = _warning("REF009", "Name that is similar to one that is defined")
_UNUSED = _warning("REF010", "File that no other file names")
OTHER_RELEASE = _warning("REF011", "Name of another release of ROS 2")
_NO_SERVICE = _error("REF013", "Service or action with another name or type")
_NO_INTERFACE = _error("REF014", "Message, service, action or field that does not exist")
_NO_RUN = _error("REF015", "Node that certainly stops, or does nothing")
_MAY_WAIT = _warning("REF016", "Node that may stop or wait")
_WRONG_VALUE = _error("REF017", "Number that contradicts the robot")
OTHER_VALUE = _warning("REF018", "Number that is not that of the robot")
_WRONG_TRANSFORM = _error("REF019", "Frames that are no tree")
_OTHER_TRANSFORM = _warning("REF020", "Transform that two programs publish")
_NO_COMPANION = _warning("REF021", "Node that does not fit the others")
_ONE_MACHINE = _warning("REF022", "What only one machine has")
_OTHER_MOVEIT = _warning("REF023", "Description for MoveIt that does not fit the robot")
_NO_WORD = _warning("REF024", "Word that a program ignores")
_NO_MESSAGE = _warning("REF025", "Messages that their reader cannot use")
_MOVES_NOTHING = _warning("REF026", "Controller that moves nothing")
_NO_SUCH_PARAMETER = _warning("REF027", "Parameter that a well-known node does not have")
_NO_EFFECT = _warning("REF028", "Parameter that has no effect")
_UNCONNECTED = _warning("REF029", "Transform between frames that nothing connects")
UNCOMPARED = Kind("REF012", "Names that are not compared", severity="note", effect="other")

_KINDS: Mapping[AnyFamily, Kind] = {
    "files": _NO_FILE,
    "frames": _NO_FRAME,
    "controllers": _NO_CONTROLLER,
    "parameters": _NO_PARAMETER,
    "arguments": _NO_ARGUMENT,
    "programs": _NO_PROGRAM,
    "topics": _NO_TOPIC,
    "dependencies": _NO_DEPENDENCY,
    "services": _NO_SERVICE,
    "interfaces": _NO_INTERFACE,
    "code": _NO_RUN,
    "values": _WRONG_VALUE,
    "transforms": _WRONG_TRANSFORM,
    "wiring": _NO_COMPANION,
    "machine": _ONE_MACHINE,
    "moveit": _OTHER_MOVEIT,
    "words": _NO_WORD,
    "messages": _NO_MESSAGE,
    "effects": _MOVES_NOTHING,
}
# Of what is not certain; of other families it is a similar name.
_UNCERTAIN: Mapping[AnyFamily, Kind] = {
    "code": _MAY_WAIT,
    "values": OTHER_VALUE,
    "transforms": _OTHER_TRANSFORM,
    "wiring": _NO_COMPANION,
    "machine": _ONE_MACHINE,
    "moveit": _OTHER_MOVEIT,
    "words": _NO_WORD,
    "messages": _NO_MESSAGE,
    "effects": _MOVES_NOTHING,
}
# Of what is not certain, by its rule.
_BY_RULE = {
    UNKNOWN_PARAMETER: _NO_SUCH_PARAMETER,
    NO_EFFECT: _NO_EFFECT,
    OF_OTHER_RELEASE: OTHER_RELEASE,
    UNCONNECTED: _UNCONNECTED,
}
NAME_CATALOGUE = kinds_in(globals().values())


def name_problems(agreement: Agreement) -> tuple[Problem, ...]:
    """Return what does not agree as problems, in the order of files and lines."""
    problems = []
    for wrong in agreement.mismatches:
        uncertain = _BY_RULE.get(wrong.rule) or _UNCERTAIN.get(wrong.family, _SIMILAR)
        kind = _KINDS[wrong.family] if wrong.is_certain else uncertain
        problems.append(Problem(kind, wrong.message, wrong.location, wrong.family))
    for at in agreement.unused:
        message = "no other file of the workspace names this file"
        problems.append(Problem(_UNUSED, message, at, "files"))
    # Of a macro of xacro that several robots call, each place once.
    by_place: dict[tuple[object, ...], Problem] = {}
    for problem in problems:
        at = problem.location
        by_place.setdefault((problem.message, at.path, at.line, at.column), problem)
    return tuple(by_place.values())
