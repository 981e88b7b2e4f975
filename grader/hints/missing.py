"""Words for the links and joints that a robot lacks: no edit writes them."""

from collections.abc import Mapping
from decimal import Decimal

from grader.grading.criterion import Criterion
from grader.hints.edits import Proposal
from grader.hints.robot.difference import MissingPart, RobotDifference
from grader.hints.trials import FoundHint
from grader.robot.link_tree import texts_in
from grader.text import enumerated

_MAX_SIBLINGS, _MAX_NAMED = 2, 4


def missing_hints(
    difference: RobotDifference | None,
    criteria: Mapping[str, Criterion],
    lost: Mapping[str, Decimal],
) -> dict[str, FoundHint]:
    """Return a hint in words for each missing link with its joint, by the costliest criterion that it costs."""
    if difference is None or difference.draft is difference.reference:
        return {}
    if 2 * sum(map(difference.draft.robot.has_link, difference.names)) < len(difference.names):
        return {}  # another robot, or one that is hardly begun
    _ = difference.pieces
    found: dict[str, FoundHint] = {}
    left = sorted(difference.missing, key=lambda part: part.tag, reverse=True)  # links first, each with its joints
    while left:
        link, is_link = left[0].link, left[0].tag == "link"
        parts = [part for part in left if part.link == link or (is_link and part.parent == link)]
        left = [part for part in left if part not in parts]
        robots = [name for name in lost if name not in found and criteria[name].check.subject == "robot"]
        own = [name for name in robots if criteria[name].arguments.get("link") == link]
        names = own or [name for name in robots if link in texts_in(criteria[name].arguments)]
        if names:
            found[max(names, key=lambda name: lost[name])] = _hint(difference, parts)
    has_link = difference.draft.robot.has_link
    joints = [part for part in difference.missing if has_link(part.link) and has_link(part.parent)]
    loading = [name for name in lost if criteria[name].check.subject == "urdf"]
    if loading and len(joints) == 1:
        return {name: hint for name, hint in found.items() if hint.proposal.link != joints[0].link} | {
            loading[0]: _hint(difference, joints)
        }
    lacking = enumerated([repr(part.link) for part in joints], _MAX_NAMED)
    cause = f"the joints of {lacking} are missing"
    every = FoundHint(Proposal((), cause), {}, words=f"add the joints of {lacking}")
    return found | ({loading[0]: every} if loading and joints else {})


def _hint(difference: RobotDifference, parts: list[MissingPart]) -> FoundHint:
    cause = f"{enumerated([_cause(part) for part in parts])} {'is' if len(parts) == 1 else 'are'} missing"
    words = f"add {enumerated([_words(part) for part in parts])}{_siblings(difference, parts)}"
    return FoundHint(Proposal((), cause, parts[0].link), {}, words=words)


def _cause(part: MissingPart) -> str:
    return f"the link {part.link!r}" if part.tag == "link" else f"the joint of {part.link!r}"


def _words(part: MissingPart) -> str:
    if part.tag == "link":
        return f"a link {part.link!r}"
    return f"a {part.joint_type} joint from {part.parent!r} to {part.link!r}"


def _siblings(difference: RobotDifference, parts: list[MissingPart]) -> str:
    """Return where elements like the missing ones are."""
    draft, lines = difference.draft, []
    for part in parts:
        like = (
            draft.links() if part.tag == "link" else (it for it in draft.joints() if it.get("type") == part.joint_type)
        )
        lines += [str(draft.line(it)) for it, _ in zip(like, range(1), strict=False)]
    numbers = sorted(dict.fromkeys(lines), key=int)[:_MAX_SIBLINGS]
    return f", as in line{'s' if len(numbers) > 1 else ''} {enumerated(numbers)}" if numbers else ""
