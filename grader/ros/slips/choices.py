"""The ways to read what is written in the files of a robot.

Each choice is one place with all that it may stand for: a way that is missing would make a false
certainty. Which one is meant is decided by reading the robot again.
"""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

from grader.base import markup
from grader.base.patterns import on_use
from grader.base.problems import Fix
from grader.base.slips import Slip, Slips
from grader.base.source import Location, Source
from grader.base.text import in_backticks
from grader.ros.slips.element_forms import element_slips
from grader.ros.slips.loose_text import (
    early_end_slips,
    loose_tag_slips,
    nested_robot_slips,
    open_comment_slips,
)
from grader.ros.slips.macro_calls import copied_call_choices, parameter_slips
from grader.ros.slips.macro_ends import macro_end_slips
from grader.ros.slips.nodes import read_elements
from grader.ros.slips.roots import prefix_slips, root_slips, rootless_slips
from grader.ros.slips.sdf_words import gazebo_slips
from grader.ros.slips.xacro_names import (
    command_slips,
    commented_slips,
    foreign_name_slips,
    name_in_braces_slips,
)
from grader.ros.slips.xacro_syntax import (
    decimal_comma_slips,
    expression_slips,
    list_names,
    refused_expression_slips,
    unmarked_slips,
)
from grader.ros.slips.xacro_words import (
    attribute_slips,
    child_slips,
    list_macros,
    nameless_slips,
)
from grader.ros.xacro.corrections import Refusal, respellings
from grader.ros.xacro.macros import MacroError
from grader.ros.xacro.xacro_nodes import XacroNode, walk

_Lists = dict[str, list[str]]

_XACRO = on_use(r"xacro:|\$")
Choice = tuple[Slip, ...]  # what one slip may stand for


def list_choices(
    sources: Sequence[Source], refused: Sequence[Refusal] = (), fixes: Iterable[Fix] = ()
) -> Iterator[Choice]:
    """Yield the slips in the texts of a robot, the first of which is the file that is loaded.

    `refused` is what xacro refuses, and `fixes` are those of words for which ROS 2 rejects the
    robot. What hides other slips comes first: a text that is not read, a name that is not defined.
    """
    roots = []
    for index, source in enumerate(sources):
        yield from _choices_of_text(source)
        if index:
            yield from _alone(rootless_slips(source))
        root = read_elements(source)
        if root:
            roots.append(root)
    of_xacro = [root for root in roots if _XACRO.search(root.place.source.text)]
    names, macros = _list_defined(of_xacro)
    if of_xacro:
        nodes = list(chain.from_iterable(map(walk, of_xacro)))
        yield from _choices_of_xacro(sources, nodes, names, refused)
    for fix in fixes:
        yield (_slip_of_fix("ROS 2 rejects the file for", fix, fix.edits[0].location),)
    named = set()  # among them the links, which a macro may make
    has_gazebo = any("<gazebo" in source.text for source in sources)
    if has_gazebo:
        named = {node.attributes.get("name", "") for node in chain.from_iterable(map(walk, roots))}
    for root in roots:
        yield from _alone(element_slips(root))
        if has_gazebo:
            yield from _alone(gazebo_slips(root, named))
        yield from _choices_of_values(root, names, macros)


def _list_defined(of_xacro: Iterable[XacroNode]) -> tuple[set[str], _Lists]:
    """Return the names of properties and parameters, and the macros with their parameters."""
    names = {"pi"}
    macros: _Lists = {}
    for root in of_xacro:
        names |= list_names(root)
        macros |= list_macros(root)
    return names, macros


_OF_TEXT = (
    prefix_slips,
    open_comment_slips,
    root_slips,
    nested_robot_slips,
    early_end_slips,
    loose_tag_slips,
)


def _choices_of_text(source: Source) -> Iterator[Choice]:
    """Yield the slips by which a text is no tree of elements, or another one."""
    for list_slips in _OF_TEXT:
        yield from _alone(list_slips(source))
    ends = macro_end_slips(source) if "<xacro:macro" in source.text else ()
    if ends:
        yield ends


def _choices_of_xacro(
    sources: Sequence[Source],
    nodes: Sequence[XacroNode],
    names: set[str],
    refused: Sequence[Refusal],
) -> Iterator[Choice]:
    """Yield the slips in names of xacro, and those for which it refuses something."""
    yield from _alone(name_in_braces_slips(nodes))
    yield from _alone(command_slips(nodes))
    yield from _alone(unmarked_slips(nodes, names))
    known = {""}  # the names and macros whose other ways were listed
    for refusal in refused:
        error = refusal.error
        place = refusal.place
        name = ""
        if isinstance(error, MacroError):
            source, start = place.written
            name = source.text[start + 1 : markup.name_end(source.text, start)]
        elif refusal.unknown:
            name = refusal.unknown.name
        ways = list(refused_expression_slips(*place.written, refusal.attribute, name))
        if not ways:
            ways += _slips_of_refusal(refusal)
        if name not in known:
            ways += parameter_slips(nodes, name.rpartition(":")[2])
            ways += foreign_name_slips(nodes, names)
            ways += commented_slips(sources, name)
        known.add(name)
        if ways:
            yield tuple(ways)
    yield from _alone(decimal_comma_slips(nodes))
    yield from copied_call_choices(nodes)


def _slips_of_refusal(refusal: Refusal) -> Slips:
    """Yield the correction of what xacro refuses, or the near names of one that is not known."""
    unknown = refusal.unknown
    if refusal.correction:
        fix, at, _ = refusal.correction
        yield _slip_of_fix("xacro refuses", fix, at)
    elif unknown:
        for edits, assumption in respellings(refusal, unknown, unknown.meant):
            yield _slip_of_fix("xacro refuses", Fix(edits, assumption), edits[0].location)


def _choices_of_values(root: XacroNode, names: set[str], macros: _Lists) -> Iterator[Choice]:
    """Yield the slips in attributes and expressions of xacro."""
    text = root.place.source.text
    if "xacro:" in text:
        yield from _alone(attribute_slips(root))
        yield from _alone(nameless_slips(root.place.source, macros))
        yield from _alone(child_slips(root, macros))
    if "$" in text or "{" in text or "xacro:" in text:
        yield from expression_slips(root, names)


def _slip_of_fix(verb: str, fix: Fix, at: Location) -> Slip:
    """Return the slip that the fix of what is refused corrects."""
    texts = in_backticks(edit.old for edit in fix.edits)
    return Slip(fix.edits, f"{verb} {texts or 'this'}", fix.assumption, at, is_refused=True)


def _alone(slips: Slips) -> Iterator[Choice]:
    """Yield slips that can be read in one way only."""
    for slip in slips:
        yield (slip,)
