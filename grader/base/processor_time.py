"""A limit of the processor time of this process: an exception, and some time later its end.

Everything that reads a student's files counts its own work. This limit is for work that is not
counted. The time of other processes, and of waiting, is not counted.
"""

import signal
import time
from functools import cache
from math import ceil, inf
from types import FrameType

from grader.base.errors import OutOfTime

GRADE_SECONDS = 20  # of processor time for `grader grade`
INSPECT_SECONDS = 60  # and for `grader inspect`
CAN_LIMIT = hasattr(signal, "setitimer")  # not on Windows
_GRACE = 10  # more seconds, after which the process is ended, whatever it does
_DRIFT = 1.25  # the system counts ticks for this end, some per cent more than a long process used
_AGAIN = 2.0  # seconds after which it is raised again: where no exception can be, it is lost
_SPARE = 0.25  # seconds of a limit of the shell that are left to say so


def limit_processor_time(seconds: float) -> None:
    """Raise OutOfTime in the main thread after more seconds of processor time.

    It is raised again where the first was lost, as in a finalizer. SIGXCPU ends the process later.
    An earlier limit no longer counts.

    A lower limit of the process itself, as of `ulimit -t`, stays.
    """
    if not CAN_LIMIT:
        return
    import resource

    reason = f"this takes more than {seconds:g} s of processor time"
    soft, hard = _own_limits()
    used = time.process_time()
    end = min(ceil(used * _DRIFT + seconds) + _GRACE, soft)
    limit = min(soft, hard)
    if limit < used + seconds + _SPARE:
        seconds = max(limit - _SPARE - used, 0.001)
        reason = f"this takes more than the {limit} s of processor time that `ulimit -t` allows"

    def stop(_number: int, _frame: FrameType | None) -> None:
        raise OutOfTime(reason)

    signal.signal(signal.SIGPROF, stop)
    signal.setitimer(signal.ITIMER_PROF, seconds, _AGAIN)
    if end <= hard:
        resource.setrlimit(resource.RLIMIT_CPU, (int(end), _as_limit(hard)))


def lift_processor_time() -> None:
    """End the limit: the process has its own limits again."""
    if not CAN_LIMIT:
        return
    import resource

    signal.setitimer(signal.ITIMER_PROF, 0)
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    soft, hard = _own_limits()
    resource.setrlimit(resource.RLIMIT_CPU, (_as_limit(soft), _as_limit(hard)))


@cache
def _own_limits() -> tuple[float, float]:
    """Return the limits that this process has been started with.

    These are the lower one, and that which it cannot raise.
    """
    import resource

    soft, hard = (
        inf if limit == resource.RLIM_INFINITY else limit
        for limit in resource.getrlimit(resource.RLIMIT_CPU)
    )
    return soft, hard


def _as_limit(seconds: float) -> int:
    """Return a limit as the system has it."""
    import resource

    return resource.RLIM_INFINITY if seconds == inf else int(seconds)
