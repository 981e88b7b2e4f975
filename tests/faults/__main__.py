"""Fail the n-th call of every kind in every command, for all n, and print what does not hold afterwards.

`python -m tests.faults [--sample N] [--lasting] [SCENARIO[:KIND] ...]`
"""

import argparse
import errno
import signal
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import mkdtemp

from tests.faults import scenarios
from tests.faults.scenarios import SCENARIOS, Scenario
from tests.faults.shim import ALWAYS, ERRORS, KINDS, Shim, is_preloaded, run_preloaded
from tests.faults.trial import Bench, Expected, complaints

_SHOWN = 3  # findings of one kind


def main(arguments: Sequence[str]) -> int:
    """Run the faults; return 1 if something does not hold."""
    parser = argparse.ArgumentParser(prog="python -m tests.faults", description=__doc__)
    parser.add_argument(
        "--sample", type=int, default=0, metavar="N", help="only N calls of each kind and command"
    )
    parser.add_argument("only", nargs="*", metavar="SCENARIO[:KIND]", help="default: all")
    parser.add_argument(
        "--lasting",
        action="store_true",
        help="fail all later calls of the kind, as a full disk does",
    )
    parser.add_argument("--verbose", action="store_true", help="print the message of each run")
    given = parser.parse_args(arguments)
    if not is_preloaded():
        return run_preloaded("tests.faults", arguments)
    signal.signal(signal.SIGALRM, _stop)
    folder = Path(mkdtemp())
    top, template = folder / "top", folder / "template"
    shim = Shim(top)
    top.mkdir()
    scenarios.prepare(top)
    top.rename(template)
    bench = Bench(top, template, shim)
    found, began = 0, time.monotonic()
    total: Counter[str] = Counter()
    for scenario in SCENARIOS:
        kinds = [
            word.partition(":")[2] for word in given.only if word.partition(":")[0] == scenario.name
        ]
        if kinds or not given.only:
            counts, bad = _run(bench, scenario, [kind for kind in kinds if kind] or KINDS, given)
            total += counts
            found += bad
    print(
        f"{total.total()} calls failed in {time.monotonic() - began:.0f} s: {dict(total)}; {found} findings"
    )
    return 1 if found else 0


def _stop(*_: object) -> None:
    raise TimeoutError


def _run(
    bench: Bench, scenario: Scenario, kinds: Sequence[str], given: argparse.Namespace
) -> tuple[Counter[str], int]:
    """Run a scenario with all faults of some kinds; return the number of each, and of findings."""
    bench.reset()
    before = bench.state()
    whole = bench.run(scenario)
    expected = Expected(before, bench.state(), whole)
    if whole.code not in (0, 1):
        print(f"{scenario.name}: {whole.err}")
        return Counter(), 1
    done: Counter[str] = Counter()
    findings: Counter[str] = Counter()
    began = time.monotonic()
    for kind in kinds:
        for number in (
            _numbers(whole.counts[kind], given.sample)
            if _concerns(scenario, kind, given.lasting)
            else ()
        ):
            error = ERRORS[kind][number % len(ERRORS[kind])]
            done[kind] += 1
            bench.reset()
            ran = bench.run(scenario, kind, number, ALWAYS if given.lasting else number, error)
            if given.verbose:
                print(
                    f"{scenario.name}: {kind} {number} ({errno.errorcode[error]}): {ran.code} {ran.err}",
                    flush=True,
                )
            for complaint in complaints(bench, scenario, expected, ran, kind):
                findings[complaint] += 1
                if findings[complaint] <= _SHOWN:
                    print(
                        f"  {scenario.name}: {kind} {number} ({errno.errorcode[error]}): {complaint}",
                        flush=True,
                    )
    print(
        f"{scenario.name}: {dict(done)}, {time.monotonic() - began:.0f} s, {findings.total()} findings",
        flush=True,
    )
    return done, findings.total()


def _concerns(scenario: Scenario, kind: str, is_lasting: bool) -> bool:
    is_of_processes = (
        kind in scenarios.IN_PROCESSES
    )  # where none can be started, a test cannot start one either
    return is_of_processes == scenario.is_process and not (is_of_processes and is_lasting)


def _numbers(count: int, sample: int) -> Iterator[int]:
    step = max(1, count // sample) if sample else 1
    return iter(range(1, count + 1, step))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
