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


def equivalents(rubric: Rubric, root: Element, robot: Robot, kept: set[str], seed: int) -> Iterator[Equivalent]:
    """Yield rewritings of a robot, of each family some; what `kept` names is renamed nowhere."""
    named = kept | words_of_foreign(root)
    has_places = any(name.startswith("@") for name in names_in(rubric))

    def may_move(link: str) -> bool:
        """Return whether nothing refers to the frame of a link; @root, @tip and @moved:2 name links by structure."""
        parents = [joint for joint in robot.joints if joint.child == link]
        if link in named or len(parents) != 1:
            return False
        is_tip = all(joint.parent != link for joint in robot.joints)
        return not has_places or (parents[0].type == "fixed" and not is_tip)

    rules = RewritingRules(named, may_move)
    for family in FAMILIES:
        for number in range(1, (_OF_SEVERAL if family == SEVERAL else _OF_EACH) + 1):
            random = Random(f"{seed} {family} {number}")
            found = _rewritten(random, root, rules, family)
            if found is not None:
                steps = f": {', '.join(found.families)}" if family == SEVERAL else ""
                yield found._replace(name=f"{family} {number}{steps}")


def _rewritten(random: Random, root: Element, rules: RewritingRules, family: str) -> Equivalent | None:
    tree = copied(root)
    names = [family] if family != SEVERAL else _several(random)
    done = tuple(name for name in names if STEPS[name](random, tree, rules))
    if not done:
        return None
    text = text_of(tree, random.choice(_INDENTS)) if LAYOUT in done else text_of(tree)
    return Equivalent(family, done, family, text, text_of(copied(root)), not set(done).isdisjoint(AS_XACRO))


def _several(random: Random) -> list[str]:
    chosen = random.sample([name for name in STEPS if name not in AS_XACRO], random.randint(2, _MOST_STEPS))
    return chosen + ([random.choice(AS_XACRO)] if random.random() < 0.3 else [])
