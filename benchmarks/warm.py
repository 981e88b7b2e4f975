"""Time gradings in a running process, and print the seconds of each round as JSON: `python benchmarks/warm.py [ROUNDS]`.

Each result is checked once before the clock starts. `run.py` makes ratios of them.
"""

import json
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from itertools import cycle
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

from lxml import etree
from timing import PACKAGE, ROOT, URDF, in_turn, repeated

from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission, read_submission
from grader.ros.package.robot_file import Surroundings
from grader.ros.python.budget import Budget
from grader.ros.xacro.expansion import expand

ZIPPED = ROOT / "submissions/lab6/equivalent-zipped-with-wrapper" / "lab6.zip"
XACRO = ROOT / "submissions/lab6/equivalent-xacro-inertials/my_robot/urdf/my_robot.urdf.xacro"
RUBRIC = load_rubric("lab6")
TEMPORARY = TemporaryDirectory()
_COPIES = 8  # more than the grader keeps results of
_COMMENTS = {
    ".py": b"# %d\n",
    ".cfg": b"# %d\n",
    ".rviz": b"# %d\n",
    ".xml": b"<!-- %d -->",
    ".urdf": b"<!-- %d -->",
}


class Case(NamedTuple):
    """A grading, the points that it must give, and how often it is repeated in a round."""

    run: Callable[[], Report]
    points: int
    times: int


def from_bytes(data: bytes, path: str) -> Callable[[], Report]:
    """Return the grading of a URDF's bytes."""
    return lambda: grade(RUBRIC, read_submission(data, identity="a", path=path))


def from_path(path: Path) -> Callable[[], Report]:
    """Return the grading of a path."""
    return lambda: grade(RUBRIC, open_submission(str(path), RUBRIC.lab))


def expanded(path: Path) -> bytes:
    """Return the URDF that xacro makes of a file."""
    root = expand(path.read_bytes(), path.name, Surroundings(Budget()), {}).root
    assert root is not None
    return etree.tostring(root, pretty_print=True)


def distinct_packages() -> Iterator[Callable[[], Report]]:
    """Yield the gradings of copies of the package, each with comments of its own in its files."""
    for number in range(_COPIES):
        copy = Path(TEMPORARY.name, str(number), PACKAGE.name)
        shutil.copytree(PACKAGE, copy)
        for file in copy.rglob("*.*"):
            if file.suffix in _COMMENTS:
                file.write_bytes(file.read_bytes() + _COMMENTS[file.suffix] % number)
        yield from_path(copy)


def in_rotation(runs: Iterable[Callable[[], Report]]) -> Callable[[], Report]:
    """Return what grades one after the other."""
    turn = cycle([*runs])
    return lambda: next(turn)()  # noqa: PLW0108  another one each time


CASES = {
    "bytes to report": Case(from_bytes(URDF.read_bytes(), "my_robot.urdf"), 70, 50),
    "path to report": Case(from_path(URDF), 70, 50),
    "package": Case(from_path(PACKAGE), 90, 10),
    "zip": Case(from_path(ZIPPED), 90, 10),
    "xacro": Case(from_bytes(XACRO.read_bytes(), XACRO.name), 70, 50),
    "distinct packages": Case(in_rotation(distinct_packages()), 90, 10),
    "distinct xacro": Case(
        in_rotation(
            from_bytes(XACRO.read_bytes() + b"<!-- %d -->" % number, XACRO.name)
            for number in range(_COPIES)
        ),
        70,
        50,
    ),
    "expanded": Case(from_bytes(expanded(XACRO), "my_robot.urdf"), 70, 50),
}


def main(rounds: int) -> None:
    """Print the times."""
    for name, case in CASES.items():
        points = case.run().score
        assert points == case.points, f"{name} has {points} points, expected {case.points}"
    data = URDF.read_bytes()
    runs = {name: repeated(case.run, case.times) for name, case in CASES.items()}
    print(
        json.dumps(
            in_turn({"lxml": repeated(lambda: etree.fromstring(data), 1_000), **runs}, rounds)
        )
    )


if __name__ == "__main__":
    main(int((*sys.argv[1:], "15")[0]))
