"""The elements in a `<joint>` besides its frame and axis, as plain values. A number that cannot be read is NaN."""

from typing import NamedTuple

from grader.source import LazyLocation


class Limit(NamedTuple):
    """A joint's range (rad or m), maximum effort (N m or N) and maximum velocity (rad/s or m/s)."""

    lower: float
    upper: float
    effort: float
    velocity: float
    location: LazyLocation | None = None


class Mimic(NamedTuple):
    """This joint's position is `multiplier` times the named joint's, plus `offset`."""

    joint: str
    multiplier: float = 1.0
    offset: float = 0.0
    location: LazyLocation | None = None


class Dynamics(NamedTuple):
    """Damping (N m s/rad or N s/m) and static friction (N m or N)."""

    damping: float = 0.0
    friction: float = 0.0
    location: LazyLocation | None = None


class SafetyController(NamedTuple):
    """The range (rad or m) in which a safety controller keeps a joint, and its gains for position and velocity."""

    k_velocity: float
    soft_lower_limit: float = 0.0
    soft_upper_limit: float = 0.0
    k_position: float = 0.0
    location: LazyLocation | None = None


class Calibration(NamedTuple):
    """The positions (rad or m) at which a joint's reference switch has a rising or falling edge; None if not given."""

    rising: float | None = None
    falling: float | None = None
    location: LazyLocation | None = None
