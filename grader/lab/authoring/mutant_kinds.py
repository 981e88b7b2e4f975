"""The kinds of mutants.

They are for the score of each, to draw a sample over all of them, and for why some may survive.
"""

from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import chain, zip_longest
from random import Random
from typing import NamedTuple

from grader.base.patterns import on_use
from grader.lab.authoring.mutants import Mutant

# The kinds, by how their mutations begin; the first that fits counts.
_KINDS = {
    "numbers": ("number", "value type changed"),
    "code": (
        "spin",
        "callback",
        "response",
        "message",
        "init",
        "constructor",
        "declaration",
        "quality of service",
        "call awaited",
    ),
    "interfaces": ("field", "separator", "interface"),
    "bridges": ("bridge",),
    "worlds": ("world",),
    "builds": ("data_files", "install", "dependency", "import"),
    "files": ("file",),
    "launch": ("action",),
    "RViz": ("display", "fixed frame"),
    "recordings": ("record",),
    "elements": ("element", "attribute", "visual", "type"),
    "names": ("name", "definition", "text", "string", "parameter", "boolean"),
}
_OTHER = "others"
_FREE_NAMES = on_use(r"(?:^|/)(ros2_control|transmission|actuator) [^/]*name$")
_FREE_OF_ROBOT = on_use(r"transmission [^/]*/(actuator) [^/]*name$")  # not in <ros2_control>


class KindScore(NamedTuple):
    """How many mutants of a kind lose points, of how many that were graded."""

    kind: str
    caught: int
    graded: int


def find_kind(mutation: str) -> str:
    """Return the kind of a mutation.

    >>> find_kind("number x10")
    'numbers'
    """
    for kind, starts in _KINDS.items():
        if mutation.startswith(starts):
            return kind
    return _OTHER


def draw(mutants: Sequence[Mutant], most: int, seed: int) -> list[Mutant]:
    """Return at most so many mutants, in their order.

    Each mutation has as many, as far as there are so many, and the seed draws them.
    """
    if len(mutants) <= most:
        return list(mutants)
    mutations: dict[str, list[Mutant]] = {}
    for mutant in mutants:
        mutations.setdefault(mutant.mutation, []).append(mutant)
    random = Random(seed)
    shuffled = [random.sample(places, len(places)) for places in mutations.values()]
    in_turn = chain.from_iterable(zip_longest(*shuffled))
    chosen = set([mutant for mutant in in_turn if mutant is not None][:most])
    return [mutant for mutant in mutants if mutant in chosen]


def scores_by_kind(outcomes: Iterable[tuple[str, str]]) -> list[KindScore]:
    """Return the score of each kind.

    `outcomes` are the mutations of mutants with what became of them: caught, survived, or what
    counts for neither.
    """
    caught = Counter[str]()
    counts = Counter[str]()
    for mutation, fate in outcomes:
        if fate in ("caught", "survived"):
            kind = find_kind(mutation)
            counts[kind] += 1
            caught[kind] += fate == "caught"
    order = [*_KINDS, _OTHER]
    return [KindScore(kind, caught[kind], counts[kind]) for kind in order if kind in counts]


def why_right(mutant: Mutant) -> str:
    """Return why ROS 2 does the same with a mutant that survives; empty where nothing says so."""
    place = mutant.id.partition(": ")[2]
    if mutant.mutation == "file renamed" and ".launch." in mutant.path:
        return "ROS 2 starts a launch file of any name"
    if mutant.mutation in ("name misspelt", "name exchanged"):
        match = _FREE_NAMES.search(place.partition(" -> ")[0])
        if match:
            return f"nothing refers to the name of <{match[1]}>"
    if mutant.mutation == "attribute deleted" and _FREE_OF_ROBOT.match(place):
        return "ROS 2 reads no <transmission> outside of <ros2_control>"
    if mutant.mutation == "string misspelt" and place.endswith((" output", " screen", " log")):
        return "it says only where a node prints"
    return ""
