"""The ways to read what is written in the files of a robot.

Each choice is one slip, with all that it may stand for.
"""

from collections.abc import Iterator, Sequence

from grader.base.slips import Slip
from grader.base.source import Source
from grader.ros.slips.element_forms import element_slips
from grader.ros.slips.loose_text import early_end_slips, loose_tag_slips
from grader.ros.slips.macro_ends import macro_end_slips
from grader.ros.slips.nodes import read_elements
from grader.ros.slips.roots import root_slips
from grader.ros.slips.sdf_words import gazebo_slips
from grader.ros.slips.xacro_syntax import expression_slips, list_names
from grader.ros.slips.xacro_words import (
    attribute_slips,
    child_slips,
    list_macros,
    nameless_slips,
)
from grader.ros.xacro.xacro_nodes import XacroNode, walk

Choice = tuple[Slip, ...]  # what one slip may stand for


def list_choices(sources: Sequence[Source]) -> Iterator[Choice]:
    """Yield the slips in the texts of a robot, the first of which is the file that is loaded."""
    roots: list[tuple[Source, XacroNode]] = []
    for source in sources:
        yield from _choices_of_text(source)
        root = read_elements(source)
        if root is not None:
            roots.append((source, root))
    names = {"pi"}  # and those of properties and parameters
    macros: dict[str, list[str]] = {}  # their parameters
    named: set[str] = set()  # among them the links, which a macro may make
    has_gazebo = any("<gazebo" in source.text for source, _ in roots)
    for source, root in roots:
        if "xacro:" in source.text:
            names |= list_names(root)
            macros |= list_macros(root)
        if has_gazebo:
            named |= {node.attributes.get("name", "") for node in walk(root)}
    for source, root in roots:
        yield from _alone(element_slips(root))
        if has_gazebo:
            yield from _alone(gazebo_slips(root, named))
        if "xacro:" in source.text:
            yield from _alone(attribute_slips(root))
            yield from _alone(nameless_slips(source, macros))
            yield from _alone(child_slips(root, macros))
        if "$" in source.text or "{" in source.text or "xacro:" in source.text:
            yield from expression_slips(root, names)


def _choices_of_text(source: Source) -> Iterator[Choice]:
    """Yield the slips by which a text is no tree of elements, or another one."""
    yield from _alone(root_slips(source))
    yield from _alone(early_end_slips(source))
    yield from _alone(loose_tag_slips(source))
    if "<xacro:macro" in source.text:
        yield macro_end_slips(source)


def _alone(slips: Iterator[Slip]) -> Iterator[Choice]:
    """Yield slips that can be read in one way only."""
    for slip in slips:
        yield (slip,)
