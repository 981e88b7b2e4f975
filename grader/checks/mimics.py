"""The check of a joint that mimics another one."""

from grader.checks.check import About
from grader.checks.comparison import EXACT, compared, expected_numbers, named
from grader.checks.outcome import Outcome, failed, place
from grader.checks.toml_types import NonNegative
from grader.errors import MissingElement
from grader.names import did_you_mean
from grader.robot.kinematics import Configuration
from grader.robot.model import Joint

ABOUT = {"mimics": About(("mimic",))}


def mimics(
    robot: Configuration,
    *,
    link: str,
    leader: str,
    multiplier: float | None = None,
    offset: float | None = None,
    tolerance: NonNegative = EXACT,
) -> Outcome:
    """The joint that moves a link mimics the joint that moves another link.

    It may do so through other joints: then the multipliers and offsets of all are composed.

    Args:
        link: The link whose joint follows.
        leader: The link whose joint is followed.
        multiplier: The ratio of the position of the following joint to that of the other.
        offset: The position of the following joint where the other is at 0, in radians or metres.
        tolerance: How far multiplier and offset may be off, in their units.
    """
    joint, leading = robot.moving_joint(link), robot.moving_joint(leader)
    followed = _mimic_chain(robot, joint, link)
    at = place(joint.mimic.location, "joint") if joint.mimic else joint.location
    if leading.name not in followed:
        message = f"the joint that moves {link!r} does not mimic the joint that moves {leader!r}"
        last = next(reversed(followed), joint.name)
        detail = f" (joint {joint.name!r})"
        if joint.mimic is not None:
            detail = f" (joint {joint.name!r} mimics {joint.mimic.joint!r}, not {leading.name!r})"
        is_missing = not robot.robot.has_joint(last)
        if is_missing:
            message = f"the joint that moves {link!r} mimics a joint that does not exist"
            detail += did_you_mean(last, (other.name for other in robot.robot.joints))
        return failed(message, at, detail=detail)
    ratio, shift = followed[leading.name]
    message = f"the joint that moves {link!r} mimics the joint that moves {leader!r}"
    numbers = expected_numbers({"multiplier": (ratio, multiplier), "offset": (shift, offset)}, tolerance)
    return compared(message, numbers, joint, joint.mimic.location if joint.mimic else None)


def _mimic_chain(robot: Configuration, joint: Joint, link: str) -> dict[str, tuple[float, float]]:
    """Return the joints that a joint mimics, directly and through others, each with the multiplier and offset to it.

    The last may not exist. Raises MissingElement for a loop.
    """
    found: dict[str, tuple[float, float]] = {}
    first, ratio, shift = joint, 1.0, 0.0
    while True:
        if joint.mimic is None:
            return found
        name = joint.mimic.joint
        ratio, shift = ratio * joint.mimic.multiplier, ratio * joint.mimic.offset + shift
        if name == first.name or name in found:
            message = f"the joint that moves {link!r} mimics itself, directly or through others"
            at = place(joint.mimic.location, "joint")
            raise MissingElement("mimicked joint", link, message=message, detail=named(first), location=at)
        found[name] = ratio, shift
        if not robot.robot.has_joint(name):
            return found
        joint = robot.joint(name)
