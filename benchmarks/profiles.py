"""Where the time goes: `python benchmarks/profiles.py [--root FOLDER] [CASE...]` prints shares of the processor time.

It looks at the stack at intervals of CPU time, with ITIMER_VIRTUAL because a grading uses another timer, and names the
innermost part of the grader in it, or whose modules are being loaded.
"""

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from types import FrameType

from timing import ROOT, URDF

_LIBRARIES = ("typer", "rich", "lxml", "numpy", "pebble", "asyncio", "yaml", "tomllib")
_INTERVAL = 0.001  # seconds; the system may make it longer
_CLASS = 600
_LEAST = 2.0  # percent
_WARM = {"warm": "bytes to report", "package": "package", "xacro": "xacro"}
_ROUNDS = {"cold": 30, "batch": 3}


def part_of(frame: FrameType | None) -> str:
    """Return the part of the program that a stack is in; a library is loading what it imports, too."""
    part, is_loading = "", False
    while frame is not None:
        top, _, rest = frame.f_globals.get("__name__", "").partition(".")
        is_known = top in _LIBRARIES or (top == "grader" and rest)
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            is_loading = True
        elif is_loading and is_known and frame.f_code.co_name == "<module>":
            return f"loading {top}"
        elif is_known:
            part = part or (rest.partition(".")[0] if top == "grader" else top)
        frame = frame.f_back
    return "loading others" if is_loading else part or "others"


def sampled(run: Callable[[], object]) -> Counter[str]:
    """Return how often each part was seen at work."""
    found: Counter[str] = Counter()
    signal.signal(signal.SIGVTALRM, lambda _, frame: found.update([part_of(frame)]))
    signal.setitimer(signal.ITIMER_VIRTUAL, _INTERVAL, _INTERVAL)
    try:
        run()
    except SystemExit:
        pass
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0)
    return found


def command(*arguments: str) -> None:
    """Run a command of the grader."""
    sys.argv = ["grader", *arguments]
    sys.stdout = Path(os.devnull).open("w", encoding="utf-8")  # noqa: SIM115  until the process ends
    from grader.__main__ import main

    main()


def case(name: str, folder: Path) -> Counter[str]:
    """Run a case in this process."""
    if name in _WARM:
        from warm import CASES

        one = CASES[_WARM[name]]
        one.run()
        return sampled(lambda: [one.run() for _ in range(1_000 if name == "warm" else 300)])
    if name == "worker":
        from grader.classroom.run.batch_worker import ClassContext, Task, grade_all
        from grader.lab.rubric.rubric import load_rubric

        rubric, tasks = (
            load_rubric("lab6"),
            [Task(path.stem, 0, (path.name,)) for path in sorted(folder.iterdir())],
        )
        work = partial(grade_all, ClassContext((str(folder),), rubric.data, str(rubric.path)))
        work(tasks[:30])
        return sampled(lambda: [work(tasks) for _ in range(3)])
    if name == "cold":
        return sampled(lambda: command("grade", str(URDF)))
    jobs = "1" if name == "batch-1" else "2"
    return sampled(
        lambda: command(
            "batch", str(folder), "--gradebook", str(folder.with_suffix(".book")), "--jobs", jobs
        )
    )


CASES = ("cold", *_WARM, "worker", "batch-1", "batch-2")


def main() -> None:
    """Print the shares of each case as a table."""
    parser = argparse.ArgumentParser(description="Print where the time goes.")
    parser.add_argument(
        "cases", nargs="*", metavar="CASE", help=f"any of: {', '.join(CASES)}; default: all"
    )
    parser.add_argument("--root", type=Path, default=ROOT, help="the checkout to look at")
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    given = parser.parse_args()
    if given.folder is not None:  # in a process of its own
        print(json.dumps(case(given.cases[0], given.folder)), file=sys.__stdout__)
        return
    from class_generator import (
        make_class,
    )  # late, like all that loads the grader: a case starts without it

    with tempfile.TemporaryDirectory() as top:
        folder = Path(top, "class")
        list(make_class(folder, _CLASS, seed=_CLASS))
        for name in given.cases or CASES:
            seen: Counter[str] = Counter()
            for _ in range(_ROUNDS.get(name.partition("-")[0], 1)):
                shutil.rmtree(folder.with_suffix(".book"), ignore_errors=True)
                words = (sys.executable, "-P", __file__, name, "--folder", folder)
                environment = {
                    **os.environ,
                    "PYTHONPATH": f"{given.root}{os.pathsep}{Path(__file__).parent}",
                }
                done = subprocess.run(
                    words, check=True, capture_output=True, text=True, env=environment
                )
                seen.update(json.loads(done.stdout))
            total = seen.total()
            shares = (f"{part} {100 * count / total:.0f}" for part, count in seen.most_common())
            print(
                f"| {name} | {', '.join(share for share in shares if float(share.split()[-1]) >= _LEAST)} |",
                flush=True,
            )


if __name__ == "__main__":
    main()
