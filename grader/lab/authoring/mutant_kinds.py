"""The kinds of mutants.

They are for the score of each, to draw a sample over all of them, and for why some may survive.
"""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from itertools import chain, zip_longest
from random import Random
from typing import NamedTuple

from grader.lab.authoring.mutants import Mutant

# The kinds, by how the families of their mutants begin; the first that fits counts.
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
    "elements": ("element", "attribute", "visual", "type"),
    "names": ("name", "definition", "text", "string", "parameter", "boolean"),
}
_OTHER = "others"
_FREE_NAMES = re.compile(r"(?:^|/)(ros2_control|transmission|actuator) [^/]*name$")
_FREE_OF_ROBOT = re.compile(r"transmission [^/]*/(actuator) [^/]*name$")  # not in <ros2_control>


class KindScore(NamedTuple):
    """How many mutants of a kind lose points, of how many that were graded."""

    kind: str
    caught: int
    graded: int


def find_kind(family: str) -> str:
    """Return the kind of a family of mutants.

    >>> find_kind("number x10")
    'numbers'
    """
    for kind, starts in _KINDS.items():
        if family.startswith(starts):
            return kind
    return _OTHER


def draw(mutants: Sequence[Mutant], most: int, seed: int) -> list[Mutant]:
    """Return at most so many mutants, in their order.

    Of each family as many, as far as there are so many, drawn by the seed.
    """
    if len(mutants) <= most:
        return [*mutants]
    families: dict[str, list[Mutant]] = {}
    for mutant in mutants:
        families.setdefault(mutant.family, []).append(mutant)
    random = Random(seed)
    shuffled = [random.sample(places, len(places)) for places in families.values()]
    in_turn = chain.from_iterable(zip_longest(*shuffled))
    drawn = [mutant for mutant in in_turn if mutant is not None][:most]
    chosen = set(drawn)
    return [mutant for mutant in mutants if mutant in chosen]


def scores_by_kind(outcomes: Iterable[tuple[str, str]]) -> list[KindScore]:
    """Return the score of each kind.

    `outcomes` are the families of mutants with what became of them: caught, survived, or what
    counts for neither.
    """
    caught, counts = Counter[str](), Counter[str]()
    for family, fate in outcomes:
        if fate in ("caught", "survived"):
            kind = find_kind(family)
            counts[kind] += 1
            caught[kind] += fate == "caught"
    order = [*_KINDS, _OTHER]
    return [KindScore(kind, caught[kind], counts[kind]) for kind in order if kind in counts]


def why_right(mutant: Mutant) -> str:
    """Return why ROS 2 does the same with a mutant that survives; empty where nothing says so."""
    place = mutant.id.partition(": ")[2]
    if mutant.family == "file renamed" and ".launch." in mutant.path:
        return "ROS 2 starts a launch file of any name"
    if mutant.family in ("name misspelt", "name exchanged"):
        match = _FREE_NAMES.search(place.partition(" -> ")[0])
        if match is not None:
            return f"nothing refers to the name of <{match[1]}>"
    if mutant.family == "attribute deleted" and _FREE_OF_ROBOT.match(place):
        return "ROS 2 reads no <transmission> outside of <ros2_control>"
    if mutant.family == "string misspelt" and place.endswith((" output", " screen", " log")):
        return "it says only where a node prints"
    return ""
