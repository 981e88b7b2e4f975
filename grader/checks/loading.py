"""Checks of the file as a whole."""

from grader.checks.outcome import Outcome, passed
from grader.robot.reader import Reading

_UNLOADED = {"URDF083"}
_CONSEQUENCES = {"URDF080", "URDF081"}  # of a wrong name in a joint, as often as not


def urdf_loads(urdf: Reading) -> Outcome:
    """ROS 2 loads the URDF, and every link is in its one tree."""
    spoiling = [each for each in urdf.problems if each.kind.effect == "rejects" or each.code in _UNLOADED]
    if not spoiling and urdf.verdict != "rejected":
        return passed("ROS 2 loads the file and every link is in its one tree")
    causes = [each for each in spoiling if each.code not in _CONSEQUENCES]
    first = (causes or spoiling or list(urdf.problems))[0]
    more = max(0, len(spoiling) - 1)
    others = f" (and {more} more problem{'s' if more > 1 else ''} that keep{'' if more > 1 else 's'} it from loading)"
    return Outcome("failed", f"{first.message}{others if more else ''}", location=first.location)
