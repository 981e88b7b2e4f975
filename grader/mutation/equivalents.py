"""Equivalents of a reference: the same robot in another file, also rewritten as xacro. Each must keep full marks."""

from collections.abc import Iterable, Iterator
from random import Random
from typing import NamedTuple

from grader.checks.check import EQUIVALENTS
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.mutation.rewritings import AS_XACRO, LAYOUT, STEPS, RewritingRules
from grader.mutation.trees import copied, text_of, words_of_foreign
from grader.mutation.trial import names_in
from grader.robot.model import Robot
from grader.xml.parsing import Element

_INDENTS = ("", "\t", "      ")
SEVERAL = "several at once"
FAMILIES = (*EQUIVALENTS, SEVERAL)
_OF_EACH, _OF_SEVERAL = 4, 12  # rewritings of a family
_MOST_STEPS = 4


class Equivalent(NamedTuple):
    """Another text for the robot: how it was rewritten, also in words, and the text with only its layout changed."""

    family: str
    families: tuple[str, ...]
    name: str
    text: str
    before: str
    is_xacro: bool


def breaking(criterion: Criterion, families: Iterable[str]) -> bool:
    """Return whether a criterion may fail under one of these families, as its check declares."""
    return not set(criterion.check.about.breaks_under(criterion.arguments)).isdisjoint(families)


class Equivalents:
    """The rewritings of a robot; what `kept` names is renamed nowhere."""

    def __init__(self, rubric: Rubric, root: Element, robot: Robot, kept: set[str], seed: int) -> None:
        self._root, self._robot, self._seed = root, robot, seed
        self._named = kept | words_of_foreign(root)
        self._is_structural = any(name.startswith("@") for name in names_in(rubric))

    def all(self) -> Iterator[Equivalent]:
        """Yield the rewritings, of each family some."""
        for family in FAMILIES:
            for number in range(_OF_SEVERAL if family == SEVERAL else _OF_EACH):
                found = self._make(family, number)
                if found is not None:
                    yield found

    def _make(self, family: str, number: int) -> Equivalent | None:
        random = Random(f"{self._seed} {family} {number}")
        tree = copied(self._root)
        before = text_of(copied(self._root))
        rules = RewritingRules(self._named, self._may_move)
        names = [family] if family != SEVERAL else self._several(random)
        done = tuple(name for name in names if STEPS[name](random, tree, rules))
        if not done:
            return None
        text = text_of(tree, random.choice(_INDENTS)) if LAYOUT in done else text_of(tree)
        name = f"{family} {number + 1}" + (f": {', '.join(done)}" if family == SEVERAL else "")
        return Equivalent(family, done, name, text, before, not set(done).isdisjoint(AS_XACRO))

    def _several(self, random: Random) -> list[str]:
        chosen = random.sample([name for name in STEPS if name not in AS_XACRO], random.randint(2, _MOST_STEPS))
        return chosen + ([random.choice(AS_XACRO)] if random.random() < 0.3 else [])

    def _may_move(self, link: str) -> bool:
        """Return whether nothing refers to the frame of a link; @root, @tip and @moved:2 name links by structure."""
        parents = [joint for joint in self._robot.joints if joint.child == link]
        if link in self._named or len(parents) != 1:
            return False
        is_tip = all(joint.parent != link for joint in self._robot.joints)
        return not self._is_structural or (parents[0].type == "fixed" and not is_tip)
