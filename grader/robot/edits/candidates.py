"""The edits of a robot that may undo a mistake, the most plausible first."""

from collections.abc import Iterable, Iterator, Mapping, Sequence

from grader.edits import KNOWN, REWRITTEN, Proposal
from grader.robot.edits.draft import Draft, Edits, child_of
from grader.robot.edits.families import Values, written
from grader.robot.edits.joint_elements import joint_elements
from grader.robot.edits.materials import coloured
from grader.robot.edits.misplaced import misplaced
from grader.robot.edits.poses import Poses
from grader.robot.edits.structure import structure_proposals
from grader.robot.edits.values import joint_values, together, values_of, visual_values, with_values
from grader.source import Location

_NOTHING: Mapping[str, Mapping[str, Values]] = {}
_LARGE = 3.0  # metres: no shape of a robot for a desk is as large


def proposals(
    draft: Draft,
    reference: Draft,
    shown: Sequence[str],
    moved: Sequence[str],
    anchors: Sequence[str],
    places: Iterable[Location] = (),
    given: Mapping[str, Mapping[str, Values]] = _NOTHING,
) -> list[Proposal]:
    """Return edits of what links show, and of the parent joints of the links that are `moved`: those at the places of failures first.

    `anchors` are the links in whose frames poses are measured, and `given` are expected numbers of links, by attribute.
    """
    poses = Poses(draft.robot, reference.robot, anchors, given)
    found: dict[frozenset[object], Proposal] = {}
    for correction in draft.source.corrections():
        found[frozenset(correction.edits)] = Proposal(*correction)
    for proposal in (*misplaced(draft), *other_units(draft)):
        found.setdefault(frozenset(proposal.edits), proposal)
    for link in dict.fromkeys((*moved, *shown)):
        for proposal in _of_link(draft, reference, poses, link, is_moved=link in moved, is_shown=link in shown):
            if any(edit.old.split() != edit.new.split() for edit in proposal.edits):
                found.setdefault(frozenset(proposal.edits), proposal)
    lines = {(place.path, place.line) for place in places}
    return sorted(
        found.values(),
        key=lambda proposal: (
            proposal.rank,
            proposal.rank == KNOWN and (proposal.edits[0].path, proposal.edits[0].line) not in lines,
        ),
    )


def _of_link(
    draft: Draft, reference: Draft, poses: Poses, link: str, *, is_moved: bool, is_shown: bool
) -> Iterator[Proposal]:
    if is_moved:
        yield from joint_values(draft, reference, poses, link)
        yield from joint_elements(draft, reference, poses, link)
    if is_shown:
        yield from visual_values(draft, reference, poses, link)
        yield from moved_offsets(draft, poses, link)
        for colour in poses.given(link, "colour") if reference is draft else ():
            yield from coloured(draft, link, colour)
    yield from structure_proposals(draft, reference, link, is_moved=is_moved)
    if is_moved:
        yield from together(draft, reference, poses, link)
        yield from as_in_reference(draft, reference, link)


def other_units(draft: Draft) -> Iterator[Proposal]:
    """Convert all lengths to metres: a robot in centimetres or millimetres."""
    slots = [
        (element, name, values_of(element.get(name) or ""))
        for element in draft.root.iter("origin", "box", "cylinder", "sphere")
        for name in ("xyz", "size", "radius", "length")
        if element.get(name) is not None
    ]
    if not any(value >= _LARGE for element, _, values in slots for value in values if element.tag != "origin"):
        return
    for factor, unit in ((100.0, "centimetres"), (1000.0, "millimetres")):
        edits: Edits = ()
        for element, name, values in slots:
            ways = draft.set(element, name, written(tuple(value / factor for value in values))) if any(values) else []
            edits += ways[0] if ways else ()
        if edits:
            yield Proposal(edits, f"the unit of all lengths: {unit}, not metres", "convert all lengths to metres")


def moved_offsets(draft: Draft, poses: Poses, link: str) -> Iterator[Proposal]:
    """Move an offset from the visual to the joint: a lidar whose picture is right, and whose frame is not."""
    joint, own = draft.joint_of(link), draft.link(link)
    visual = child_of(own, "visual") if own is not None else None
    if joint is None or visual is None:
        return
    frames = list(poses.joint(link, "origin", "xyz"))[:1] if poses.is_shown_right(link) else []
    for frame in frames:
        for placed in with_values(draft, joint, "origin", {"xyz": frame}):
            for shown in with_values(draft, visual, "origin", {"xyz": poses.shown_offset(link)}):
                cause = "the offset{}, which belongs in the joint"
                yield Proposal(
                    (*placed, *shown), cause, "move the offset{} to the joint", f"the visual of {link!r}", link
                )


def as_in_reference(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Place a link as the reference does: the origin and axis of its joint, and the origin of its visual together."""
    joint, other = draft.joint_of(link), reference.joint_of(link)
    if joint is None or other is None or draft.link(link) is None:
        return
    yield Proposal(
        draft.replace(joint, reference.text(other)),
        "the joint",
        "correct the joint{}",
        f"the link {link!r}",
        link,
        REWRITTEN,
    )
    own, wanted = draft.link(link), reference.link(link)
    if own is not None and wanted is not None:
        edits = (*draft.replace(joint, reference.text(other)), *draft.replace(own, reference.text(wanted)))
        yield Proposal(
            edits,
            "the joint and what it moves",
            "correct the joint and the visual{}",
            f"the link {link!r}",
            link,
            REWRITTEN,
        )
