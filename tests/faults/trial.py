"""Run one scenario with one fault, and say what does not hold afterwards."""

import json
import os
import pickle
import re
import shutil
import signal
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from tests.faults.scenarios import Scenario
from tests.faults.shim import Shim

HANG_TIMEOUT = 120  # seconds
_TIME = re.compile(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}[+-]\d\d:\d\d")


class Ran(NamedTuple):
    """What a command did: its exit code and output, and the calls that were counted. Code -1: it hung or crashed."""

    code: int
    out: bytes
    err: str
    counts: dict[str, int]


_CLASS_PAGE = "/index.html"
RESULTS, _GRADES = "/results.jsonl", "/grades.csv"
_OF_ONE_RUN = {
    "run": 0,
    "crc32": 0,
    "written": [],
}  # in a line of results: another run may leave other values
_REMOVED = (
    "report.json",
)  # what `--save` names is removed first: a run that is refused leaves no old report


class Bench:
    """A folder in which scenarios run: all have the same files in the beginning."""

    def __init__(self, top: Path, template: Path, shim: Shim) -> None:
        self.top, self._template, self._shim = top, template, shim
        self.record: Path | None = None  # where the calls of commands are recorded

    def reset(self) -> None:
        """Restore the files."""
        shutil.rmtree(self.top, ignore_errors=True)
        shutil.copytree(self._template, self.top, symlinks=True)

    def run(
        self, scenario: Scenario, kind: str = "", first: int = 0, last: int = 0, error: int = 0
    ) -> Ran:
        """Run a scenario in a fork of this process, which has all modules loaded, with a fault."""
        reader, writer = os.pipe()
        child = os.fork()
        if not child:
            os.close(reader)
            os.setpgid(0, 0)
            self._report(writer, scenario, (kind, first, last, error))
        os.close(writer)
        signal.setitimer(signal.ITIMER_REAL, HANG_TIMEOUT)
        try:
            with os.fdopen(reader, "rb") as answer:
                data = answer.read()
        except TimeoutError:
            data = b""
            os.killpg(child, signal.SIGKILL)
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        os.waitpid(child, 0)
        self._shim.disarm()
        found: Ran = (
            pickle.loads(data) if data else Ran(-1, b"", "it hung or crashed", self._shim.counts)
        )
        return found

    def _report(self, writer: int, scenario: Scenario, fault: tuple[str, int, int, int]) -> None:
        """Run a scenario and send what it did; this process ends."""
        code = 1
        try:
            os.chdir(self.top)
            done = scenario.run(self.top, self._fault(*fault))
            ran = Ran(done.returncode, done.stdout, done.stderr.decode(), self._shim.counts)
            with os.fdopen(writer, "wb") as answer:
                answer.write(pickle.dumps(ran))
            code = 0
        except BaseException:  # noqa: BLE001  nothing may run on in the fork
            self._shim.disarm()
            import traceback

            traceback.print_exc()
        os._exit(code)

    @contextmanager
    def _fault(self, *fault: Any) -> Iterator[None]:
        """Arm the shim; temporary files of the command are below the folder."""
        (folder := self.top / "tmp").mkdir(exist_ok=True)
        before, tempfile.tempdir = tempfile.tempdir, str(folder)
        try:
            with (
                self._shim.armed(*fault)
                if self.record is None
                else self._shim.recording(self.record)
            ):
                yield
        finally:
            tempfile.tempdir = before

    def state(self) -> dict[str, bytes]:
        """Return the bytes of each file in the folder, but for the times of now; of results the whole lines.

        The folder for temporary files is the system's: what cannot be removed from it stays there.
        """
        found: dict[str, bytes] = {}
        for path in sorted(self.top.rglob("*")):
            name = str(path.relative_to(self.top))
            if path.is_file() and path.name != ".lock" and not name.startswith("tmp/"):
                found[name] = _normal(name, _TIME.sub(b"TIME", path.read_bytes()))
        return {name: data for name, data in found.items() if data or "/marks/" not in name}


def _normal(name: str, data: bytes) -> bytes:
    """Return the newest results of a gradebook, its different marks, and other files as they are."""
    if name.endswith(RESULTS):
        whole = data[: data.rfind(b"\n") + 1].splitlines()
        lines = (
            json.loads(line) for line in whole if b"\0" not in line
        )  # a power failure leaves holes
        # the texts that stand before a result count with it
        newest = {
            line.get("student", ""): {**line, **_OF_ONE_RUN}
            for line in lines
            if "texts" not in line
        }
        return b"".join(json.dumps(newest[key]).encode() + b"\n" for key in sorted(newest))
    return b"".join(dict.fromkeys(data.splitlines(keepends=True))) if "/marks/" in name else data


class Expected(NamedTuple):
    """A scenario without faults: the state before and after it, and what it did."""

    before: dict[str, bytes]
    after: dict[str, bytes]
    ran: Ran


def complaints(
    bench: Bench, scenario: Scenario, expected: Expected, ran: Ran, kind: str
) -> Iterator[str]:
    """Yield what does not hold after a scenario ran with a fault; run it without, unless it is complete."""
    state = bench.state()
    new = [line for line in ran.err.splitlines() if line not in expected.ran.err.splitlines()]
    yield from _of_messages(ran, expected.ran, new)
    is_done = ran.code == expected.ran.code
    yield from _of_files(state, expected, kind, is_done=is_done, has_warned=bool(new))
    for name in expected.after:
        if name.endswith(RESULTS):
            yield from _of_results(name, state.get(name, b""), expected, is_done=is_done)
    if state == expected.after and (ran.code == expected.ran.code or scenario.goes_on):
        return
    again = bench.run(scenario)
    final = bench.state()
    if again.code != expected.ran.code:
        yield f"rerunning ends with {again.code}: {again.err.strip()}"
    for name in sorted(expected.after.keys() | final.keys()):
        if final.get(name) != expected.after.get(name) and not (
            kind == "unlink" and name not in expected.after
        ):
            yield f"rerunning: {name} {_difference(final.get(name), expected.after.get(name))}"


def _of_messages(ran: Ran, expected: Ran, new: list[str]) -> Iterator[str]:
    if ran.code not in (expected.code, 2, 3):
        yield f"it ends with {ran.code}: {ran.err.strip()}"
    if any(word in ran.err for word in ("Traceback", "internal error", "Error:", "Exception")):
        yield f"a raw message: {ran.err.strip()}"
    if ran.code != expected.code and not (new and all(line.startswith("grader: ") for line in new)):
        yield f"exit code {ran.code} without a line: {ran.err.strip()!r}"
    if ran.code == expected.code and ran.out != expected.out and not new:
        yield f"another output, and no warning: {ran.out.decode()[:300]!r}"


def _of_files(
    state: dict[str, bytes], expected: Expected, kind: str, *, is_done: bool, has_warned: bool
) -> Iterator[str]:
    """Yield which files are neither as before nor complete. A complete one may differ if the command said why."""
    before, after = expected.before, expected.after
    for name in sorted(state.keys() | before.keys() | after.keys()):
        found = state.get(name)
        is_other = has_warned or state.get(name.replace(_GRADES, RESULTS)) != after.get(
            name.replace(_GRADES, RESULTS)
        )
        if (
            name.endswith(RESULTS)
            or found == after.get(name)
            or (name.endswith(_GRADES) and is_other)
        ):
            continue
        if name.endswith(_CLASS_PAGE) and found is not None and found.endswith(b"</html>\n"):
            continue  # a picture of a robot on it may be missing
        if name not in before and name not in after:
            if kind != "unlink":
                yield f"{name} is left behind"
        elif not (
            found is None and name in _REMOVED if not is_done else has_warned
        ) and found != before.get(name):
            yield f"{name} {_difference(found, after.get(name))}"


def _of_results(name: str, data: bytes, expected: Expected, *, is_done: bool) -> Iterator[str]:
    """Yield what is wrong with results: students who are graded otherwise, or lost."""
    known = {
        line
        for state in (expected.before, expected.after)
        for line in state.get(name, b"").splitlines()
    }
    lines = data.splitlines()
    yield from (
        f"{name}: {line!r}"
        for line in lines
        if line not in known and b'"verdict": "graded"' in line
    )
    if is_done and len(lines) != len(expected.after[name].splitlines()):
        yield f"{name} lacks students"


def _difference(found: bytes | None, expected: bytes | None) -> str:
    """Return how two states of a file differ."""
    if found is None or expected is None:
        return "is not there" if found is None else "should not be there"
    at = next(
        (at for at, (one, other) in enumerate(zip(found, expected, strict=False)) if one != other),
        -1,
    )
    return f"differs ({len(found)} of {len(expected)} bytes, from {at}): {found[max(0, at - 30) : at + 60]!r}"
