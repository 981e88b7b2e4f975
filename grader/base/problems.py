"""Problems of files: their kinds, each with a stable code, and one problem with its fixes."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from typing import Literal

from grader.base.grouping import Strings
from grader.base.records import Named
from grader.base.source import Edits, Location

Severity = Literal["error", "warning", "note"]
Effect = Literal["rejects", "undetermined", "drops", "loads", "other"]


class Kind(Named):
    """One kind of problem. docs/examples/ says how to fix the file.

    The effect of a URDF's problems decides the verdict: ROS 2 rejects the file, drops content of
    it, or loads all of it. The effect of a problem of another file is `other`.
    """

    code: str  # which never changes
    title: str
    severity: Severity
    effect: Effect
    is_consequence: bool = False  # another problem of the same file usually causes it
    detaches_links: bool = False  # ROS 2 loads the file without links that are apart from the tree
    is_before_ros: bool = False  # xacro stops at it, before ROS 2 gets the file


class Fix(Named):
    """The edits after which a problem is gone, and what they assume."""

    edits: Edits
    assumption: str  # "<colision> is read as <collision>"
    is_certain: bool = True  # whether nothing else can be meant


class Fixes:
    """The fixes of a problem, which are computed when they are first asked for: most never are.

    What finds a problem makes them; hints and editors read them. They take no part in comparison:
    all are equal, and a copy in another process has none.

    >>> fixes = Fixes(lambda: [Fix((), "<colision> is read as <collision>")])
    >>> [fix.assumption for fix in fixes]
    ['<colision> is read as <collision>']
    >>> fixes == NO_FIXES
    True
    """

    __slots__ = ("_compute", "_computed")

    def __init__(self, compute: Callable[[], Iterable[Fix]]) -> None:
        """`compute` returns the fixes; it is called once at most."""
        self._compute = compute
        self._computed: tuple[Fix, ...] | None = None

    def __iter__(self) -> Iterator[Fix]:
        """Iterate over the fixes: the one that is most likely meant comes first."""
        if self._computed is None:
            self._computed = tuple(self._compute())
        return iter(self._computed)

    def __eq__(self, other: object) -> bool:
        """Return that fixes are equal, whatever they are."""
        return isinstance(other, Fixes)

    def __hash__(self) -> int:
        """Return one number for all."""
        return 0

    def __repr__(self) -> str:
        """Return nothing of what they are."""
        return "Fixes()"

    def __reduce__(self) -> tuple[type["Fixes"], tuple[Callable[[], tuple[Fix, ...]]]]:
        """Return how a copy without fixes is made: those that are not computed need the files."""
        return Fixes, (tuple,)


NO_FIXES = Fixes(tuple)


class Problem(Named):
    """One problem of one file."""

    kind: Kind
    message: str  # a sentence
    location: Location
    # what it is about: the link that loses content with it, a tag, or a few words
    subject: str = ""
    rule: str = ""  # the name of the rule of a workspace that found it
    related: Location | None = None  # of what it is compared with
    fixes: Fixes = NO_FIXES
    # the call or element in which its location is, whose first line comments are beside
    around: Location | None = None
    cause: str = ""  # what it has in common with others that one mistake makes
    names: Strings = ()  # by which a message of a log may mean it

    @property
    def code(self) -> str:
        """The stable code of its kind, such as URDF012."""
        return self.kind.code

    @property
    def label(self) -> str:
        """Its code and the name of its rule: REF003 controller-defined."""
        return f"{self.code} {self.rule}".rstrip()

    @property
    def severity(self) -> Severity:
        """The severity of its kind: an error keeps ROS 2 from loading the file."""
        return self.kind.severity

    def is_meant_by(self, word: str) -> bool:
        """Return whether a word is the name of its rule, its code or the beginning of this."""
        return self.code.startswith(word) or word == self.rule


rejects = partial(Kind, severity="error", effect="rejects")  # ROS 2 loads nothing of the file
drops = partial(
    Kind, severity="warning", effect="drops"
)  # ROS 2 loads the file without part of its content
warns = partial(
    Kind, severity="warning", effect="loads"
)  # ROS 2 loads everything, but it deserves a warning
notes = partial(Kind, severity="note", effect="loads")


def kinds_in(namespace: Iterable[object]) -> tuple[Kind, ...]:
    """Return the kinds among the values of a module, sorted by code."""
    return tuple(
        sorted(
            (value for value in namespace if isinstance(value, Kind)), key=lambda kind: kind.code
        )
    )


def in_order(problems: Iterable[Problem]) -> tuple[Problem, ...]:
    """Return problems in the order of their locations."""
    return tuple(
        sorted(
            problems,
            key=lambda problem: (problem.location.line, problem.location.column, problem.code),
        )
    )


def causes(problems: Iterable[Problem]) -> list[Problem]:
    """Return the problems for which ROS 2 rejects a file.

    Returns only those of xacro if xacro stops before.
    """
    rejecting = [problem for problem in problems if problem.kind.effect == "rejects"]
    independent = [problem for problem in rejecting if not problem.kind.is_consequence]
    return (
        [problem for problem in independent if problem.kind.is_before_ros]
        or independent
        or rejecting
    )
