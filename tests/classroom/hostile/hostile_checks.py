"""A plug-in check that misbehaves as the robot's name says, to test what a worker survives."""

import ctypes
import os
import signal
import sys
import time
from types import FrameType
from typing import Any

from grader.lab.checks.outcome import Outcome, passed
from grader.ros.urdf.kinematics import Configuration

_RETURNED: dict[str, Any] = {
    "returns_nothing": None,
    "returns_text": "passed",
    "returns_a_tuple": ("passed", "fine"),
    "returns_another_status": Outcome("fine", "fine"),  # type: ignore[arg-type]
    "returns_skipped": Outcome("skipped", "because"),
    "returns_no_message": Outcome("passed", None),  # type: ignore[arg-type]
    "returns_nan": Outcome("passed", "fine", measured=float("nan")),
    "returns_objects": Outcome("passed", "fine", expected=(object(),)),  # type: ignore[arg-type]
    "returns_a_value_of_no_report": Outcome("passed", "fine", measured={1, 2}),  # type: ignore[arg-type]
}


class Unusual(BaseException):
    """An exception that `except Exception` does not catch."""


class Wordless(Exception):
    """An exception whose message ends the process."""

    def __str__(self) -> str:  # noqa: PLE0307
        sys.exit(0)


def behaves(robot: Configuration) -> Outcome:
    """The robot's name asks for no misbehaviour."""
    match robot.robot.name:
        case "hangs":
            while True:
                time.sleep(0.01)
        case "loops":
            while True:
                pass
        case "loops_in_c":
            sum(range(10**15))  # no exception can interrupt it
        case "hangs_in_c":
            ctypes.PyDLL(None).sleep(
                3600
            )  # with the interpreter's lock held: no thread and no handler gets a turn
        case "stops":
            while True:  # a shell that ends may leave its processes running
                os.kill(os.getpid(), signal.SIGSTOP)
        case "dies":
            os.kill(os.getpid(), signal.SIGKILL)
        case "leaves":
            os._exit(0)
        case "leaves_loudly":
            os._exit(7)
        case "exits":
            sys.exit("out")
        case "exits_with_0":
            sys.exit(0)
        case "raises_unusually":
            raise Unusual("as asked")
        case "raises_without_words":
            raise Wordless
        case name if name in _RETURNED:
            returned: Outcome = _RETURNED[name]
            return returned
        case "crashes":
            ctypes.string_at(0)
        case "eats":
            eaten = [bytearray(2**27)]
            while True:
                eaten.append(bytearray(2**27))
        case "dies_when_tried" if _is_tried():
            os.kill(os.getpid(), signal.SIGKILL)
        case "loops_when_tried" if _is_tried():
            while True:
                pass
        case "raises":
            raise RuntimeError("as asked")
    return passed("nothing bad was asked for")


def _is_tried() -> bool:
    """Return whether a search for hints tries an edit."""
    frame: FrameType | None = sys._getframe()
    while frame is not None and "hints" not in frame.f_code.co_filename:
        frame = frame.f_back
    return frame is not None


def without_annotation(robot: Configuration, *, at_least):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN201
    """A check whose argument has no annotation."""


def without_names(robot: Configuration, *values: float) -> Outcome:
    """A check whose arguments are positional-only."""
    raise NotImplementedError


def without_subject(robot) -> Outcome:  # type: ignore[no-untyped-def]  # noqa: ANN001
    """A check whose first argument has no annotation."""
    raise NotImplementedError


def with_endless_default(robot: Configuration, *, at_most: float = float("inf")) -> Outcome:
    """A check with a default that no rubric and no JSON can give."""
    raise NotImplementedError
