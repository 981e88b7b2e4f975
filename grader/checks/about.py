"""What a check declares about itself, so that hints, rubrics, mutants and pictures need not know its name."""

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

# The ways in which the text of a robot is rewritten to an equal robot, in the order in which they are tried.
EQUIVALENTS = (
    "order of elements",
    "fixed joints split",
    "frames moved",
    "full turns",
    "axes scaled",
    "links renamed",
    "joints renamed",
    "spelling of numbers",
    "layout of the text",
    "xacro properties",
    "xacro macro",
)
BreaksUnder = Callable[[Mapping[str, Any]], Collection[str]]


def nothing(arguments: Mapping[str, Any]) -> Collection[str]:
    """Break under no equivalent, as most checks do: they are about behaviour."""
    del arguments
    return ()


def everything(arguments: Mapping[str, Any]) -> Collection[str]:
    """Break under every equivalent: the check is about the text."""
    del arguments
    return EQUIVALENTS


class Usual(NamedTuple):
    """Arguments that a new rubric gives all criteria of a check: the project's tolerances, with their unit in words."""

    arguments: Mapping[str, Any]
    unit: str


METRES = Usual({"tolerance": 0.002}, "metres")  # room for rounding, but not for mistakes
DEGREES = Usual({"tolerance": 1.0}, "degrees")
MEASURES = "grader.checks.measures"


@dataclass(frozen=True, slots=True)
class About:
    """What a check declares, in the table `ABOUT` of its module by the name of its function.

    `looks_at`: the files of a package (`setup.py`, `package.xml`, `launch`, `rviz`) on which the result depends, where
    hints propose edits, or the tags of a URDF (`limit`, `visual/origin`, `joint@type`): `rubric test` suggests the
    check for a mutant there. `suggests` ("module:function") yields edits where neither the reference nor the numbers
    that are measured lead to them. `measure` ("module:function") yields what is true of a reference, as facts for a new
    rubric; `usual` are arguments for all of these, `unit` their unit in words. `breaks_under` are the equivalents of a
    robot under which a criterion with such arguments may fail. `picture` is what a failure shows of the reference: the
    outline of the link, also as a wheel that rolls, or its frame.
    """

    looks_at: tuple[str, ...] = ()
    suggests: str = ""
    measure: str = ""
    usual: Usual | None = None
    breaks_under: BreaksUnder = nothing
    picture: Literal["", "outline", "wheel", "frame"] = ""
