"""Equivalents of a reference: the same robot in another file, also rewritten as xacro. Each must keep full marks."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from random import Random
from typing import NamedTuple

from grader.checks.check import EQUIVALENTS
from grader.grading.criterion import Criterion
from grader.grading.rubric import Rubric
from grader.mutation import rewritings
from grader.mutation.elements import Element as TextElement
from grader.mutation.elements import elements
from grader.mutation.rewritings import Rewriting, RewritingRules
from grader.mutation.trees import Style, copied, words_of_foreign
from grader.mutation.trial import names_in
from grader.robot.model import Robot
from grader.xml.parsing import Element
from grader.xml.urdf_format import PARTS

_NAMESPACE = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
_NUMBER = re.compile(r"(?<![\w.+-])-?(?:0|[1-9]\d*)(?:\.\d+)?(?![\w.])")  # that xacro writes as it is
_MAX_PROPERTIES = 8
_MAX_DIGITS = 12  # that survive the conversion to a float and back


def with_properties(random: Random, text: str) -> str | None:
    """Return the text with properties for numbers that occur more than once; None where there are none."""
    spans = [
        (found.start() + attribute.value[0], found.end() + attribute.value[0])
        for element in elements(text)
        if not element.is_foreign
        for attribute in element.attributes
        if PARTS.get(attribute.name)
        for found in _NUMBER.finditer(text[slice(*attribute.value)])
        if len(found[0]) <= _MAX_DIGITS
    ]
    counts = Counter(text[start:end] for start, end in spans)
    repeated = [number for number, count in counts.items() if count > 1]
    if not repeated or "$" in text:
        return None
    chosen = random.sample(repeated, min(len(repeated), _MAX_PROPERTIES))
    names = {number: f"number_{index}" for index, number in enumerate(chosen)}
    for start, end in sorted(spans, reverse=True):
        if text[start:end] in names:
            text = f"{text[:start]}${{{names[text[start:end]]}}}{text[end:]}"
    properties = "".join(f'\n  <xacro:property name="{name}" value="{number}"/>' for number, name in names.items())
    return _insert(text, properties)


def with_macro(random: Random, text: str) -> str | None:
    """Return the text with a macro for one of its links; None where it has none."""
    links = [found for found in elements(text) if found.tag == "link" and found.parent == 0 and _name(text, found)]
    if not links or "$" in text:
        return None
    link = random.choice(links)
    start, end = next(attribute.value for attribute in link.attributes if attribute.name == "name")
    body = f"{text[link.start : start]}${{name}}{text[end : link.end]}"
    call = f'<xacro:part name="{text[start:end]}"/>'
    macro = f'\n  <xacro:macro name="part" params="name">\n  {body}\n  </xacro:macro>'
    return _insert(text[: link.start] + call + text[link.end :], macro)


def _name(text: str, link: TextElement) -> str:
    return next((text[slice(*found.value)] for found in link.attributes if found.name == "name"), "")


def _insert(text: str, content: str) -> str:
    """Return the text with content at the start of its root, which declares the namespace of xacro."""
    root = elements(text)[0]
    end = root.head_end - 1
    return f"{text[:end]}{_NAMESPACE}{text[end : root.head_end]}{content}{text[root.head_end :]}"


_OF_TREES: tuple[Rewriting, ...] = (
    rewritings.shuffle,
    rewritings.split_joints,
    rewritings.move_frames,
    rewritings.turn_fully,
    rewritings.scale_axes,
    rewritings.rename_links,
    rewritings.rename_joints,
)
_STEPS = dict(zip(EQUIVALENTS, _OF_TREES, strict=False))
_SPELLING, _LAYOUT, *_XACRO = EQUIVALENTS[len(_STEPS) :]
_AS_XACRO = dict(zip(_XACRO, (with_properties, with_macro), strict=True))
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
        before = Style(Random(0)).text(tree)
        names = [family] if family != SEVERAL else self._several(random)
        rules = RewritingRules(self._named, self._may_move)
        done = [name for name in names if name not in _STEPS or _STEPS[name](random, tree, rules)]
        text = self._restyle(random, tree, done)
        for name in [name for name in done if name in _AS_XACRO]:
            rewritten = _AS_XACRO[name](random, text)
            done = done if rewritten is not None else [other for other in done if other != name]
            text = rewritten if rewritten is not None else text
        if not done:
            return None
        name = f"{family} {number + 1}" + (f": {', '.join(done)}" if family == SEVERAL else "")
        return Equivalent(family, tuple(done), name, text, before, any(name in _AS_XACRO for name in done))

    def _several(self, random: Random) -> list[str]:
        chosen = random.sample(list(_STEPS), random.randint(2, _MOST_STEPS))
        others = [name for name in (_SPELLING, _LAYOUT) if random.random() < 0.5]
        return chosen + others + ([random.choice(list(_AS_XACRO))] if random.random() < 0.3 else [])

    def _restyle(self, random: Random, tree: Element, families: list[str]) -> str:
        if _LAYOUT in families:
            blanks = ("", " ", "\n", "\n\n    ")
            return Style(random, blanks, "\"'", _SPELLING in families, comments=True, orders=True).text(tree)
        return Style(random, numbers=_SPELLING in families).text(tree)

    def _may_move(self, link: str) -> bool:
        """Return whether nothing refers to the frame of a link; @root, @tip and @moved:2 name links by structure."""
        parents = [joint for joint in self._robot.joints if joint.child == link]
        if link in self._named or len(parents) != 1:
            return False
        is_tip = all(joint.parent != link for joint in self._robot.joints)
        return not self._is_structural or (parents[0].type == "fixed" and not is_tip)
