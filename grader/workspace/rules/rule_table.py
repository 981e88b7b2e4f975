"""The rules of a workspace, by which reports, settings and `grader explain` name them.

An entry stands beside the function that finds what breaks the rule. rules.json has all entries, for
what needs no finder; `python docs/make.py` writes it.
"""

import json
from collections.abc import Iterator, Mapping
from functools import cache, partial
from pathlib import Path
from typing import Any, Literal, get_args

from grader.base.grouping import Strings
from grader.base.problems import Kind, Problem, kinds_in
from grader.base.records import Named
from grader.base.source import Location
from grader.ros.known.output_rows import OutputPlace

Family = Literal[
    "files",
    "frames",
    "controllers",
    "parameters",
    "arguments",
    "programs",
    "topics",
    "dependencies",
    "services",
    "interfaces",
    "code",
    "values",
    "transforms",
]
FAMILIES: tuple[Family, ...] = get_args(Family)
# The families that are added here have only warnings, and no rubric can ask for them.
AnyFamily = (
    Family
    | Literal["wiring", "machine", "moveit", "words", "messages", "effects", "keys", "builds"]
)
DefinedKind = Literal[
    "frame",
    "link",
    "joint",
    "group",
    "controller",
    "plugin section",
    "parameter",
    "launch argument",
    "xacro argument",
    "node",
    "topic",
]

_error = partial(Kind, severity="error", effect="other")
_warning = partial(Kind, severity="warning", effect="other")

NO_FILE = _error("REF001", "File that a build does not install")
NO_FRAME = _error("REF002", "Frame, link or joint that does not exist")
NO_CONTROLLER = _error("REF003", "Controller or interface that does not exist")
NO_PARAMETER = _error("REF004", "Parameters that no node gets, or that a node does not accept")
NO_ARGUMENT = _error("REF005", "Argument that nothing declares")
NO_PROGRAM = _error("REF006", "Program, entry point or node that does not exist")
NO_TOPIC = _error("REF007", "Topic with another name, type or quality of service")
NO_DEPENDENCY = _warning("REF008", "Package that package.xml does not declare")
SIMILAR = _warning("REF009", "Name, type or file that may be wrong")
UNUSED = _warning("REF010", "File that no other file names")
OTHER_RELEASE = _warning("REF011", "Name of another release of ROS 2")
UNCOMPARED = Kind("REF012", "Names that are not compared", severity="note", effect="other")
NO_SERVICE = _error("REF013", "Service or action with another name or type")
NO_INTERFACE = _error("REF014", "Message, service, action or field that does not exist")
NO_RUN = _error("REF015", "Node that certainly stops, or does nothing")
MAY_WAIT = _warning("REF016", "Node that may stop or wait")
WRONG_VALUE = _error("REF017", "Number that contradicts the robot")
OTHER_VALUE = _warning("REF018", "Number that is not that of the robot")
WRONG_TRANSFORM = _error("REF019", "Frames that are no tree")
_OTHER_TRANSFORM = _warning("REF020", "Transform that two programs publish")
NO_COMPANION = _warning("REF021", "Node that does not fit the others")
ONE_MACHINE = _warning("REF022", "What only one machine has")
OTHER_MOVEIT = _warning("REF023", "Description for MoveIt that does not fit the robot")
NO_WORD = _warning("REF024", "Word that a program ignores")
NO_MESSAGE = _warning("REF025", "Messages that their reader cannot use")
MOVES_NOTHING = _warning("REF026", "Controller that moves nothing")
NO_SUCH_PARAMETER = _warning("REF027", "Parameter that a well-known node does not have")
NO_EFFECT = _warning("REF028", "Parameter that has no effect")
UNCONNECTED = _warning("REF029", "Transform between frames that nothing connects")
BUILT_LATER = _error("REF030", "Package that a build does not find")
NO_PACKAGE = _error("REF031", "Package that does not exist")
_NOWHERE = _warning("REF032", "Package that neither the workspace nor a release has")
NO_KEY = _warning("REF033", "Name that rosdep does not know")
_UNKNOWN_KEY = Kind("REF034", "Name that may be no key of rosdep", severity="note", effect="other")
NOT_COMPILED = _error("REF035", "C++ file that does not compile")
BROUGHT = Kind("REF036", "Library that other packages install", severity="note", effect="other")
NOT_BUILT = _warning("REF037", "Package that colcon does not find")
OTHER_TIME = Kind(
    "REF038", "Node beside a simulation without its time", severity="note", effect="other"
)
FORM = Kind("REF039", "Form of a package of which tools warn or that they ignore", "note", "other")
NO_BUILD = _warning("REF040", "Package that colcon does not build")
UNREAD = Kind("REF041", "Parameter or argument that nothing reads", severity="note", effect="other")
LENT = _warning("REF042", "Package that package.xml declares only indirectly")
NAME_CATALOGUE = kinds_in(globals().values())
_OF_NAMES = (
    *(NO_FILE, NO_FRAME, NO_CONTROLLER, NO_PARAMETER, NO_ARGUMENT),
    *(NO_PROGRAM, NO_TOPIC, NO_SERVICE, NO_INTERFACE),
)
# The kinds of what is not certain, where they are others.
_DOUBTFUL = {
    **dict.fromkeys(_OF_NAMES, SIMILAR),
    NO_RUN: MAY_WAIT,
    WRONG_VALUE: OTHER_VALUE,
    WRONG_TRANSFORM: _OTHER_TRANSFORM,
    NO_KEY: _UNKNOWN_KEY,
    NO_PACKAGE: _NOWHERE,
}


class Symptom(Named):
    """What the terminal prints where a rule is broken."""

    name: str  # of the message, which rules may share
    pattern: str  # which is searched in the message, whose white space is single spaces
    source: str  # repository, file and line
    sentence: str  # what it means
    example: str  # a message that has the pattern, for pages: people search for it
    within: Strings = ()  # the groups that must be in the lines of the finding
    follows: bool = False  # whether another message before it says the cause
    place: OutputPlace = ""  # where the files say why, besides the findings


class Rule(Named):
    """What agrees in a correct workspace: one entry, beside the function that finds what does not.

    A finding is of `kind` if something certainly fails at run time, and otherwise of `doubtful`,
    which fails no criterion.

    >>> rule = RULES["topic-type"]
    >>> rule.name, rule.kind.code, rule.doubtful.code
    ('topic-type', 'REF007', 'REF009')
    """

    name: str  # which never changes; no check and no criterion has it
    family: AnyFamily  # of names_agree
    kind: Kind
    sentence: str  # what is right
    is_of_type: bool = False  # whether a value or a topic has another type
    why: str = ""  # what happens where it is broken
    symptoms: tuple[Symptom, ...] = ()
    wrong: str = ""  # an example, which is text in the frame or the whole file
    right: str = ""
    frame: str = "rover.launch.py"  # a row of docs/examples/frames.toml, or a file of its own
    beside: Mapping[str, str] = {}  # other files of the example, by their frames
    at: str = ""  # the path of the file with the finding, where it is another one
    doubtful_kind: Kind | None = None  # if it is not that which belongs to the kind

    @property
    def doubtful(self) -> Kind:
        """The kind of a finding that is not certain."""
        return self.doubtful_kind or _DOUBTFUL.get(self.kind, self.kind)

    def __hash__(self) -> int:
        """Return one number for each name: the files of an example have no hash."""
        return hash(self.name)

    def has(self, kind: Kind) -> bool:
        """Return whether a kind of problem is one of the rule.

        That a name is similar to another one, any rule may say.
        """
        return kind == self.kind or (kind == self.doubtful and kind != SIMILAR)

    def problem(
        self, message: str, at: Location, subject: str = "", *, is_certain: bool = True
    ) -> Problem:
        """Return what does not agree as a problem of a file."""
        kind = self.kind if is_certain else self.doubtful
        return Problem(kind, message, at, subject or self.family, self.name)


@cache
def _table() -> dict[str, Any]:
    """Return the file with all entries."""
    table: dict[str, Any] = json.loads(Path(__file__).with_name("rules.json").read_text("utf-8"))
    return table


def reload_rules() -> None:
    """Read the file again, which was written anew."""
    _table.cache_clear()


def list_readers() -> list[str]:
    """Return the functions that yield what files define and use, as "module.function"."""
    readers: list[str] = _table()["readers"]
    return readers


def public_findings(name: str) -> str:
    """Return how often findings of a rule in public workspaces were true; empty if not known."""
    finding: str = _table()["public"].get(name, "")
    return finding


class _Rules(Mapping[str, Rule]):
    """The rules by their names, each made when it is asked for: most never are."""

    def __getitem__(self, name: str) -> Rule:
        """Return a rule as its entry has it."""
        row = dict(_table()["rules"][name])
        kinds = {kind.code: kind for kind in NAME_CATALOGUE}
        for key in {"kind", "doubtful_kind"} & row.keys():
            row[key] = kinds[row[key]]
        symptoms = [Symptom(**each) for each in row.get("symptoms", ())]
        row["symptoms"] = tuple(each._replace(within=tuple(each.within)) for each in symptoms)
        return Rule(name, **row)

    def __iter__(self) -> Iterator[str]:
        """Yield the names, in the order of modules and entries."""
        return iter(_table()["rules"])

    def __len__(self) -> int:
        """Return how many rules there are."""
        return len(_table()["rules"])


RULES: Mapping[str, Rule] = _Rules()
