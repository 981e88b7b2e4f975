"""Grade a large class in which one submission in a hundred is hostile, and watch the processes: `python -m tests.faults.soak N`.

The last lines are the figures. The exit code is 1 if the memory or the descriptors of the command grow, a process or a
zombie remains, or a submission has no result.
"""

import os
import shutil
import subprocess
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path
from statistics import fmean, linear_regression
from tempfile import TemporaryDirectory
from typing import NamedTuple

from tests.classroom.class_runs import HOSTILE, lines_of, repeated, session_of, started, verdicts, without_hints
from tests.samples import ROOT

sys.path.insert(0, str(ROOT / "benchmarks"))  # a folder of scripts
import class_generator as made_up

_DISTINCT = 5_000  # the next ones are links to their files
_EVERY = 100  # submissions of which one is hostile
_TIMEOUT = 3  # seconds for each submission
_MISBEHAVIOUR = ["dies", "crashes", "leaves", "leaves_loudly", "exits", "eats", "raises", "raises_unusually"]
_HANGS = ["hangs", "hangs_in_c", "stops"]
_KINDS = [
    "empty-zip",
    "broken-zip",
    "broken-tar",
    "garbage-zip",
    "zip-bomb",
    "zips-in-zips",
    "escaping-zip",
    "escaping-tar",
    "links-out",
    "links-out-zip",
    "links-out-tar",
    "deep-folders",
    "deep-zip",
    "garbage",
    "too-large",
    "deep-xml",
    "billion-laughs",
    "nul-bytes",
    "utf-16",
    "latin-text",
    "latin-name",
]
_HOSTILE = [*_MISBEHAVIOUR, *_KINDS, *_HANGS]
_CRITERION = """

[[criterion]]
id = "behaves"
part = "{part}"
title = "The robot's name asks for nothing bad"
points = 0
check = "behaves"
"""
_MAX_GROWTH = 0.05  # of the memory, from the first to the last quarter of the grading
_MAX_ZOMBIE = 30.0  # seconds


class Sample(NamedTuple):
    """What was seen at a moment: bytes of memory, descriptors, processes, results."""

    seconds: float
    memory: int
    descriptors: int
    processes: int
    results: int


def make_class(folder: Path, count: int) -> Counter[str]:
    """Write a class; return the number of each kind of submission."""
    folder.mkdir()
    kinds: Counter[str] = Counter()
    robots: list[Path] = []
    for index in range(count):
        kind = _HOSTILE[index // _EVERY % len(_HOSTILE)] if index % _EVERY == 0 else "urdf"
        kinds[kind] += 1
        who = made_up.person(1, index, with_awkward=False)
        file = folder / f"{who.key}.urdf"
        if kind in made_up.KINDS and not (kind == "urdf" and len(robots) == _DISTINCT):
            attempts = made_up.KINDS[kind][1](made_up.ItemFactory(made_up.Dice(f"soak/{index}"), who.login))
            for item in made_up.in_folders(made_up.GeneratedSubmission(who, kind, attempts, None)):
                made_up.write(str(folder), item)
            robots += [file] * (kind == "urdf")
        elif kind == "urdf":
            file.hardlink_to(robots[index % _DISTINCT])
        else:
            file.write_text(f'<robot name="{kind}"><link name="a"/></robot>')
    return kinds


def rubric_in(folder: Path) -> Path:
    """Write Lab 6 with a criterion that misbehaves, without hints."""
    shutil.copytree(without_hints().parent, folder)
    (folder / "answers.toml").unlink()
    text = (folder / "lab6.toml").read_text(encoding="utf-8")
    part = text.partition('[[part]]\nid = "')[2].partition('"')[0]
    (folder / "lab6.toml").write_text(text + _CRITERION.format(part=part), encoding="utf-8")
    return folder / "lab6.toml"


class Watch:
    """Watches a command and the processes that it starts."""

    def __init__(self, process: "subprocess.Popen[str]", book: Path) -> None:
        self._process, self._book, self._began = process, book, time.monotonic()
        self.samples: list[Sample] = []
        self._zombies: dict[int, float] = {}
        self.longest_zombie = 0.0

    def until_end(self) -> int:
        """Take a sample twice a second until the command has ended; return its exit code."""
        while (code := self._process.poll()) is None:
            self.samples += self._sample()
            time.sleep(0.5)
        return code

    def _sample(self) -> Iterator[Sample]:
        now, pid = time.monotonic() - self._began, self._process.pid
        zombies = {child: self._zombies.get(child, now) for child in _zombies(pid)}
        self.longest_zombie = max([self.longest_zombie, *(now - since for since in zombies.values())])
        self._zombies = zombies
        try:
            memory = int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
            descriptors = len(os.listdir(f"/proc/{pid}/fd"))
            results = (self._book / "results.jsonl").read_bytes().count(b"\n")
        except (OSError, IndexError):  # it has just ended, or not begun
            return
        yield Sample(now, memory, descriptors, len(session_of(self._process)), results)


def _zombies(parent: int) -> Iterator[int]:
    """Yield the zombies in the session of a command."""
    for path in Path("/proc").glob("[0-9]*/stat"):
        try:
            state, _, _, session, *_ = path.read_text().rpartition(")")[2].split()
        except OSError:
            continue
        if state == "Z" and int(session) == parent:
            yield int(path.parent.name)


def main(arguments: Sequence[str]) -> int:
    """Make a class, grade it, print the figures; return 1 if something grows or is lost."""
    count = int(arguments[0])
    with TemporaryDirectory() as name:
        top = Path(name)
        began = time.monotonic()
        kinds = make_class(top / "class", count)
        rubric, book = rubric_in(top / "rubric"), top / "soak"
        hostile = count - kinds["urdf"]
        print(f"{count} submissions, {hostile} of them hostile, made in {time.monotonic() - began:.0f} s", flush=True)
        command = (
            "batch",
            top / "class",
            "--gradebook",
            book,
            "--rubric",
            rubric,
            "--timeout",
            _TIMEOUT,
            "--jobs",
            "2",
        )
        began = time.monotonic()
        with started(*map(str, command), PYTHONPATH=str(HOSTILE)) as process:
            watch = Watch(process, book)
            code = watch.until_end()
            seconds = time.monotonic() - began
            time.sleep(2)
            left = len(session_of(process))
            error = process.stderr.read() if process.stderr is not None else ""
        print(*error.splitlines()[-3:], sep="\n")
        found = Counter(verdicts(book).values())
        print(f"exit code {code} after {seconds:.0f} s, {count / seconds:.0f} submissions/s: {dict(found)}")
        faults = [*_growth(watch.samples), *_losses(watch, book, kinds, code, left)]
    print(*(faults or ["nothing grows, and nothing is lost"]), sep="\n")
    return 1 if faults else 0


def _growth(samples: Sequence[Sample]) -> Iterator[str]:
    """Print the memory and the descriptors while submissions are graded; yield what grows."""
    graded = [sample for sample in samples if 0 < sample.results < samples[-1].results]
    quarter = len(graded) // 4
    if not quarter:
        yield "the run was too short to be measured"
        return
    for name, most in (("memory", _MAX_GROWTH), ("descriptors", _MAX_GROWTH)):
        values = [float(getattr(sample, name)) for sample in graded]
        first, last = fmean(values[quarter : 2 * quarter]), fmean(values[-quarter:])
        slope = linear_regression([sample.results for sample in graded[quarter:]], values[quarter:]).slope
        unit, scale = ("MiB", 2**20) if name == "memory" else ("", 1)
        print(
            f"{name}: {first / scale:.1f} {unit} in the second quarter, {last / scale:.1f} in the last, "
            f"at most {max(values) / scale:.1f}; slope {slope * 1000 / scale:+.4f} {unit} for 1,000 submissions"
        )
        if last > first * (1 + most):
            yield f"the {name} grows by {last / first - 1:.0%}"
    print(f"memory at the end, with the summary: {max(sample.memory for sample in samples) / 2**20:.0f} MiB")
    print(f"processes: at most {max(sample.processes for sample in graded)}")


def _losses(watch: Watch, book: Path, kinds: Counter[str], code: int, left: int) -> Iterator[str]:
    """Yield what is lost or left: results, processes, zombies."""
    print(f"the longest zombie: {watch.longest_zombie:.1f} s; processes that remain: {left}")
    if code:
        yield f"exit code {code}"
    if left:
        yield f"{left} processes remain"
    if watch.longest_zombie > _MAX_ZOMBIE:
        yield f"a zombie remained for {watch.longest_zombie:.0f} s"
    found = Counter(verdicts(book).values())
    if found.total() != kinds.total():
        yield f"{kinds.total() - found.total()} submissions have no result"
    if found["graded"] < kinds["urdf"]:
        yield f"{kinds['urdf'] - found['graded']} correct submissions are not graded"
    if repeated(book) or len(lines_of(book, "run")) != 1:
        yield "a result is there twice, or the run is not"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
