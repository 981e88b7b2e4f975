"""Ctrl-C at any moment: no message of the interpreter, and it is never lost."""

import signal
import subprocess
import sys

import pytest

pytestmark = pytest.mark.slow

SCRIPT = """
import signal, sys, time
from grader.app.cli.ending import quiet_interrupts

class Interrupted:
    def __del__(self):
        signal.raise_signal(signal.SIGINT)  # Python cannot raise an exception here

try:
    with quiet_interrupts():
        {body}
except KeyboardInterrupt:
    print("interrupted")
"""


def ran(body: str) -> tuple[str, str]:
    """Return what a script prints on standard output and error."""
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", SCRIPT.format(body=body)],
        check=False,
        capture_output=True,
        text=True,
    )
    return done.stdout, done.stderr


@pytest.mark.exhaustive
def test_an_interrupt_in_a_finalizer_is_not_lost() -> None:
    """Without it Python prints the exception and goes on."""
    assert ran("Interrupted(); time.sleep(100)") == ("interrupted\n", "")


@pytest.mark.exhaustive
def test_an_interrupt_that_is_repeated_too_early_is_not_lost() -> None:
    """On a busy machine it arrives in the hook that has asked for it."""
    start = "lambda self: Timer.start(self) if early else (early.append(1), signal.raise_signal(2))"
    timer = f"early = []; from threading import Timer; ending.Timer = type('Early', (Timer,), {{'start': {start}}})"
    body = f"from grader.app.cli import ending; {timer}; Interrupted(); time.sleep(10)"
    assert ran(body) == ("interrupted\n", "")


@pytest.mark.exhaustive
def test_a_file_that_an_interrupt_leaves_open_is_no_mistake() -> None:
    """A warning about it would be printed while the exception is on its way; without an interrupt it is."""
    leaves_open = "file = open(sys.executable); file = None"
    assert ran(f"Interrupted() if 0 else None; {leaves_open}")[1].startswith("Exception ignored")
    assert ran(
        f"try:\n            signal.raise_signal(2)\n        except KeyboardInterrupt:\n            {leaves_open}"
    ) == ("", "")


@pytest.mark.exhaustive
def test_other_faults_of_finalizers_are_shown() -> None:
    """Only what an interrupt causes is quiet."""
    assert "ZeroDivisionError" in ran("type('A', (), {'__del__': lambda self: 1 / 0})()")[1]


@pytest.mark.exhaustive
def test_an_ignored_interrupt_stays_ignored() -> None:
    """After nohup or `trap '' INT` Ctrl-C does nothing."""
    before = "signal.signal(signal.SIGINT, signal.SIG_IGN)"
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            SCRIPT.format(body="signal.raise_signal(2); print('ended')").replace(
                "try:\n", f"{before}\ntry:\n", 1
            ),
        ],
        check=False,
        capture_output=True,
        text=True,
    )
    assert (done.stdout, done.stderr) == ("ended\n", "")


def test_the_handler_is_restored() -> None:
    """A caller in the same process gets its own handler back."""
    from grader.app.cli.ending import quiet_interrupts

    before = signal.getsignal(signal.SIGINT), sys.unraisablehook
    with quiet_interrupts():
        assert signal.getsignal(signal.SIGINT) is not before[0]
    assert (signal.getsignal(signal.SIGINT), sys.unraisablehook) == before
