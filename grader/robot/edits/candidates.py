"""The edits of a robot that may undo a mistake, the most plausible first."""

from collections.abc import Iterable, Iterator, Sequence

from grader.edits import Proposal
from grader.robot.edits.draft import Draft, child_of
from grader.robot.edits.poses import Poses
from grader.robot.edits.structure import structure_proposals
from grader.robot.edits.values import value_proposals, with_values
from grader.source import Location


def proposals(draft: Draft, reference: Draft, links: Sequence[str], places: Iterable[Location] = ()) -> list[Proposal]:
    """Return edits of links, their parent joints and what they show: those at the places of failures first."""
    poses = Poses(draft.robot, reference.robot, links)
    found: dict[frozenset[object], Proposal] = {}
    for correction in draft.source.corrections():
        found[frozenset(correction.edits)] = Proposal(*correction)
    for link in links:
        for proposal in _of_link(draft, reference, poses, link):
            if proposal.edits and all(edit.old != edit.new for edit in proposal.edits):
                found.setdefault(frozenset(proposal.edits), proposal)
    lines = {(place.path, place.line) for place in places}
    return sorted(
        found.values(),
        key=lambda proposal: (proposal.is_rewrite, (proposal.edits[0].path, proposal.edits[0].line) not in lines),
    )


def _of_link(draft: Draft, reference: Draft, poses: Poses, link: str) -> Iterator[Proposal]:
    yield from value_proposals(draft, reference, poses, link)
    yield from moved_offsets(draft, poses, link)
    yield from structure_proposals(draft, reference, link)
    yield from as_in_reference(draft, reference, link)


def moved_offsets(draft: Draft, poses: Poses, link: str) -> Iterator[Proposal]:
    """Move an offset from the visual to the joint: a lidar whose picture is right, and whose frame is not."""
    joint, own = draft.joint_of(link), draft.link(link)
    visual = child_of(own, "visual") if own is not None else None
    if joint is None or visual is None:
        return
    frames = list(poses.joint(link, "origin", "xyz"))[:1]
    for frame in frames:
        for placed in with_values(draft, joint, "origin", {"xyz": frame}):
            for shown in with_values(draft, visual, "origin", {"xyz": poses.shown_offset(link)}):
                cause = "the place of the offset: in the visual, not in the joint"
                yield Proposal(
                    (*placed, *shown), cause, "move the offset to the joint", f"the visual of {link!r}", link
                )


def as_in_reference(draft: Draft, reference: Draft, link: str) -> Iterator[Proposal]:
    """Place a link as the reference does: the origin and axis of its joint, and the origin of its visual together."""
    joint, other = draft.joint_of(link), reference.joint_of(link)
    if joint is None or other is None or draft.link(link) is None:
        return
    yield Proposal(
        draft.replace(joint, reference.text(other)),
        "the joint",
        "correct the joint",
        f"the link {link!r}",
        link,
        is_rewrite=True,
    )
    own, wanted = draft.link(link), reference.link(link)
    if own is not None and wanted is not None:
        edits = (*draft.replace(joint, reference.text(other)), *draft.replace(own, reference.text(wanted)))
        yield Proposal(
            edits,
            "the joint and what it moves",
            "correct the joint and the visual",
            f"the link {link!r}",
            link,
            is_rewrite=True,
        )
