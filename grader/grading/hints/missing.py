"""Words for the links and joints that a robot lacks: no edit writes them."""

from collections.abc import Mapping
from decimal import Decimal

from grader.edits import Proposal
from grader.grading.criterion import Criterion
from grader.grading.hints.trials import FoundHint, Results
from grader.robot.edits.difference import MissingPart, RobotDifference
from grader.robot.selectors import texts_in
from grader.text import enumerated

_MAX_SIBLINGS = 2


def missing_hints(
    difference: RobotDifference | None,
    criteria: Mapping[str, Criterion],
    results: Results,
    lost: Mapping[str, Decimal],
    *,
    is_readable: bool,
) -> dict[str, FoundHint]:
    """Return a hint in words for each missing link with its joint, by the costliest criterion that it costs."""
    if difference is None or not is_readable or difference.draft is difference.reference:
        return {}
    if 2 * sum(map(difference.draft.robot.has_link, difference.names)) < len(difference.names):
        return {}  # another robot, or one that is hardly begun
    _ = difference.pieces
    found: dict[str, FoundHint] = {}
    for link in dict.fromkeys(part.link for part in difference.missing):
        parts = [part for part in difference.missing if part.link == link]
        names = [name for name in lost if name not in found and _is_about(criteria[name], results, link, parts)]
        if names:
            name = max(names, key=lambda it: (criteria[it].check.subject == "urdf", lost[it]))
            cause = " and ".join(_cause(part) for part in parts) + (
                " is missing" if len(parts) == 1 else " are missing"
            )
            words = f"add {' and '.join(_words(part) for part in parts)}{_siblings(difference, parts)}"
            found[name] = FoundHint(Proposal((), cause, "", link), {}, words=words)
    return found


def _is_about(criterion: Criterion, results: Results, link: str, parts: list[MissingPart]) -> bool:
    """Return whether a failure is that a link is missing, or that no joint connects it."""
    if criterion.check.subject == "urdf":
        return not any(part.tag == "link" for part in parts)
    return criterion.check.subject == "robot" and link in texts_in(criterion.arguments) and bool(results)


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
