"""A check of another package that does what a robot's name says: what a worker has to survive."""

import ctypes
import os
import signal
import sys
import time

from grader.checks.outcome import Outcome, passed
from grader.robot.kinematics import Configuration


def behaves(robot: Configuration) -> Outcome:
    """The robot's name asks for nothing bad."""
    match robot.robot.name:
        case "hangs":
            while True:
                time.sleep(0.01)
        case "hangs_in_c":
            ctypes.PyDLL(None).sleep(3600)  # with the interpreter's lock held: no thread and no handler gets a turn
        case "stops":
            os.kill(os.getpid(), signal.SIGSTOP)
        case "dies":
            os.kill(os.getpid(), signal.SIGKILL)
        case "leaves":
            os._exit(0)
        case "leaves_loudly":
            os._exit(7)
        case "exits":
            sys.exit("out")
        case "crashes":
            ctypes.string_at(0)
        case "eats":
            eaten = [bytearray(2**27)]
            while True:
                eaten.append(bytearray(2**27))
        case "raises":
            raise RuntimeError("as asked")
    return passed("nothing bad was asked for")
