"""What a plug-in check imports: what it examines, the types of its arguments, what it returns.

docs/python.md describes them. All other modules may change with any release.
"""

from grader.base.errors import MissingElement, NotDecided
from grader.base.source import place
from grader.base.toml_types import Colour, Direction, NonNegative, Size
from grader.base.transforms import Transform, Vector
from grader.lab.checks.check import About
from grader.lab.checks.outcome import (
    Outcome,
    failed,
    judged,
    measured,
    measured_point,
    passed,
    pending,
)
from grader.lab.submission.submission import Submission
from grader.ros.api import Configuration, Package, Reading

__all__ = [
    "About",
    "Colour",
    "Configuration",
    "Direction",
    "MissingElement",
    "NonNegative",
    "NotDecided",
    "Outcome",
    "Package",
    "Reading",
    "Size",
    "Submission",
    "Transform",
    "Vector",
    "failed",
    "judged",
    "measured",
    "measured_point",
    "passed",
    "pending",
    "place",
]
