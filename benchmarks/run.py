"""Every speed that the project claims: `python benchmarks/run.py [FIGURE...]`. Needs `pip install '.[test]' --group oracle --group bench`.

All figures are ratios of alternatives that run in turn; absolute times depend on the machine. Every command must end
with the expected exit code and print an expected word. `--against FOLDER` also runs each command of the grader with the
checkout in that folder, and prints how much faster this one is.
"""

import argparse
import json
import math
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.metadata import distribution
from pathlib import Path
from typing import NamedTuple

from class_generator import make_class
from timing import PACKAGE, ROOT, URDF, Command, in_turn, ratio

_HERE = Path(__file__).resolve().parent
_MISTAKES = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"
_IMPORTS = "import typer, lxml.etree, numpy, rich.console; print('imported')"
_READERS = {
    "pinocchio": "import pinocchio as p; m = p.buildModelFromUrdf({0!r}); p.forwardKinematics(m, m.createData(), p.neutral(m)); print(m.nframes)",
    "yourdfpy": "import yourdfpy; print(len(yourdfpy.URDF.load({0!r}, load_meshes=False).link_map))",
    "urdf_parser_py": "from urdf_parser_py.urdf import URDF; print(len(URDF.from_xml_file({0!r}).links))",
}
_LOOP = 'for f in "$1"/*.urdf; do "$0" "$f" >/dev/null || exit 1; done; echo all'


def forget(book: Path) -> None:
    """Remove a gradebook, which was a file in earlier versions."""
    if book.is_dir():
        shutil.rmtree(book)
    book.unlink(missing_ok=True)


class Row(NamedTuple):
    """A figure: what is compared, and the ratio."""

    figure: str
    value: float
    unit: str = ""

    def __str__(self) -> str:
        """Return the row of the table."""
        return f"| {self.figure} | {self.value:.2f}{self.unit} |"


@dataclass(frozen=True)
class Bench:
    """Where the inputs are made, how many rounds run, and the checkout to compare with."""

    top: Path
    rounds: int
    before: Path | None = None
    is_all: bool = False

    def grader(
        self,
        *arguments: str | Path,
        code: int = 0,
        word: str = "",
        root: Path = ROOT,
        prepare: Callable[[], object] = bool,
    ) -> Command:
        """Return a command of the grader."""
        words = (sys.executable, "-P", "-m", "grader", *arguments)
        return Command(words, code, word, {"PYTHONPATH": str(root)}, prepare)

    def compare(self, **commands: Command) -> dict[str, list[float]]:
        """Return the times of commands that run in turn; those of the grader also with the other checkout, as `NAME before`."""
        runs = dict(commands)
        if self.before is not None:
            for name, command in commands.items():
                if (
                    "grader" in command.words and name != "again"
                ):  # its gradebook is of this version
                    runs[f"{name} before"] = command._replace(
                        environment={"PYTHONPATH": str(self.before)}
                    )
        times = in_turn({name: command.seconds for name, command in runs.items()}, self.rounds)
        for name in commands:
            if f"{name} before" in times:
                print(
                    f"  {name}: {ratio(times[f'{name} before'], times[name]):.2f} times as fast as before",
                    flush=True,
                )
        return times

    def class_of(self, count: int) -> Path:
        """Return a class of this many URDFs, generated on first use."""
        folder = self.top / f"class-{count}"
        if not folder.exists():
            for _ in make_class(folder, count, seed=count):
                pass
        return folder

    def batch(
        self, count: int, *options: str | Path, book: Path | None = None, word: str = "graded"
    ) -> Command:
        """Return the grading of a class, into a new gradebook by default."""
        path = book or self.top / "book"
        prepare = (lambda: forget(path)) if book is None else bool
        return self.grader(
            "batch", self.class_of(count), "--gradebook", path, *options, word=word, prepare=prepare
        )

    @cached_property
    def warm(self) -> dict[str, list[float]]:
        """The times of gradings in a running process, of several such processes."""
        times: dict[str, list[float]] = {}
        script = Command(
            (sys.executable, _HERE / "warm.py", "5"), environment={"PYTHONPATH": str(ROOT)}
        )
        for _ in range(max(1, self.rounds // 5)):
            for name, values in json.loads(script.output()).items():
                times.setdefault(name, []).extend(values)
        return times


def cold(bench: Bench) -> Iterator[Row]:
    """Compare a whole `grade` with what a course would write instead, and with interpreters that only import."""
    python, urdf = sys.executable, {"URDF": str(URDF)}
    folder = bench.top / "autograders"
    shutil.copytree(_HERE / "autograders", folder, dirs_exist_ok=True)
    (folder / "pytest.ini").write_text("[pytest]\n")
    asserts = {
        name: Command(
            (python, "-m", "pytest", "-q", "-p", "no:cacheprovider", folder / f"test_{name}.py"),
            0,
            "6 passed",
            urdf,
        )
        for name in ("urdf_parser_py", "yourdfpy")
    }
    times = bench.compare(
        grade=bench.grader("grade", URDF, word="70/70"),
        json=bench.grader("grade", URDF, "--format", "json", word='"score"'),
        imports=Command((python, "-c", _IMPORTS), word="imported"),
        bare=Command((python, "-c", "print('nothing')"), word="nothing"),
        **asserts,
    )
    for name in ("urdf_parser_py", "yourdfpy"):
        figure = f"cold `grade`, times as fast as pytest with six asserts on {name}"
        yield Row(figure, ratio(times[name], times["grade"]))
    yield Row(
        "cold `grade` against bare imports of its libraries",
        ratio(times["grade"], times["imports"]),
    )
    yield Row("cold `grade --format json` against the same", ratio(times["json"], times["imports"]))
    yield Row(
        "cold `grade` against an interpreter that starts and ends",
        ratio(times["grade"], times["bare"]),
    )


def readers(bench: Bench) -> Iterator[Row]:
    """Compare a whole `inspect` with other programs that read the same URDF."""
    commands = {
        name: Command(
            (sys.executable, "-W", "ignore", "-c", text.format(str(URDF))),
            word="6" if name != "pinocchio" else "1",
        )
        for name, text in _READERS.items()
    }
    times = bench.compare(
        inspect=bench.grader("inspect", URDF, "--format", "json", word="base_footprint"),
        check_urdf=Command((_check_urdf(), URDF), word="Successfully", environment=_LIBRARIES),
        **commands,
    )
    for name in ("check_urdf", *_READERS):
        yield Row(f"cold `inspect`, times as fast as {name}", ratio(times[name], times["inspect"]))


def warm(bench: Bench) -> Iterator[Row]:
    """Compare gradings in a running process with lxml's parse of the same bytes, and with each other."""
    times = bench.warm
    for figure, above, below in (
        ("warm, bytes to report, against lxml's parse", "bytes to report", "lxml"),
        ("package, warm, against its URDF", "package", "path to report"),
        (
            "packages without equal files, warm, against the URDF",
            "distinct packages",
            "path to report",
        ),
        ("zip, warm, against its URDF", "zip", "path to report"),
        ("xacro, warm, against its expanded URDF", "xacro", "expanded"),
        ("xacro without equal files, warm, against the same", "distinct xacro", "expanded"),
    ):
        yield Row(figure, ratio(times[above], times[below]))


def hints(bench: Bench) -> Iterator[Row]:
    """Compare a cold `grade` of a URDF with mistakes with and without hints."""
    arguments = ("grade", _MISTAKES, "--hints")
    times = bench.compare(
        hints=bench.grader(*arguments, "cause", code=1, word="Check line"),
        none=bench.grader(*arguments, "none", code=1, word="43/70"),
    )
    yield Row(
        "several mistakes with hints, cold, against without", ratio(times["hints"], times["none"])
    )


def batch(bench: Bench) -> Iterator[Row]:
    """Compare `batch` of 600 URDFs with a shell loop over check_urdf, and with itself in other ways."""
    count, done = 600, bench.top / "done"
    bench.batch(count, book=done).seconds()
    times = bench.compare(
        two=bench.batch(count, "--jobs", "2"),
        one=bench.batch(count, "--jobs", "1"),
        again=bench.batch(count, book=done, word="unchanged"),
        reports=bench.batch(count, "--reports", bench.top / "reports"),
        loop=Command(
            ("sh", "-c", _LOOP, _check_urdf(), _readable(bench, count)),
            word="all",
            environment=_LIBRARIES,
        ),
    )
    figure = f"`batch` of {count}, two workers, times as fast as a loop over check_urdf"
    yield Row(figure, ratio(times["loop"], times["two"]))
    yield Row("two workers, times as fast as one", ratio(times["one"], times["two"]))
    yield Row("the unchanged class again, times as fast", ratio(times["two"], times["again"]))
    yield Row("`batch --reports` against without", ratio(times["reports"], times["two"]))


def a_thousand(bench: Bench) -> Iterator[Row]:
    """Compare `batch` of 1,000 URDFs with `--against`, and time what follows it."""
    book = bench.top / "thousand"
    bench.batch(1_000, book=book).seconds()
    bench.compare(a_thousand=bench.batch(1_000, "--jobs", "2"))
    for name, words in (("export", ("export", "csv")), ("stats", ("stats",))):
        times = in_turn({name: bench.grader(*words, "--gradebook", book).seconds}, bench.rounds)
        yield Row(f"`{' '.join(words)}` of 1,000", min(times[name]), " s")


def rubric_test(bench: Bench) -> Iterator[Row]:
    """Time all mutants of two generated rubrics."""
    for links in (11, 82):
        urdf, rubric = bench.top / f"arm-{links}.urdf", bench.top / f"arm-{links}.toml"
        urdf.write_text(arm(links))
        bench.grader("rubric", "new", rubric, "--from", urdf, "--force").seconds()
        count = rubric.read_text().count("[[criterion]]")
        seconds = bench.grader("rubric", "test", rubric, word="Mutants").seconds()
        yield Row(f"`rubric test`, {links} links, {count} criteria", seconds, " s")


def memory(bench: Bench) -> Iterator[Row]:
    """Compare the peak memory of the whole process tree of two classes."""
    large = 100_000 if bench.is_all else 10_000
    peaks = []
    for count in (1_000, large):
        command = bench.batch(count)
        command.prepare()
        peaks.append(command.peak_memory())
    yield Row(f"peak memory of a batch of {large:,} against 1,000", peaks[1] / peaks[0])


def growth(bench: Bench) -> Iterator[Row]:
    """Fit the exponent of the cost between two sizes of an input: 1 is linear."""
    sizes = {
        "submissions": (2_000, 20_000 if not bench.is_all else 100_000),
        "links": (2_000, 20_000),
        "files": (1_000, 10_000),
        "criteria": (100, 1_000),
    }
    base = min(bench.grader("grade", URDF).processor_seconds() for _ in range(5))
    for kind, (small, large) in sizes.items():
        low, high = (
            _INPUTS[kind](bench, size).processor_seconds() - base for size in (small, large)
        )
        exponent = math.log(high / max(low, base / 10)) / math.log(large / small)
        yield Row(f"exponent of the time for {kind}, {small:,} to {large:,}", exponent)


def _links(bench: Bench, count: int) -> Command:
    path = bench.top / f"chain-{count}.urdf"
    path.write_text(arm(count))
    return bench.grader(
        "grade", path, "--max-size", "100000000", "--hints", "none", code=1, word="3/70"
    )


def _files(bench: Bench, count: int) -> Command:
    folder = bench.top / f"files-{count}"
    shutil.copytree(PACKAGE, folder, dirs_exist_ok=True)
    for number in range(count):
        (folder / f"notes-{number}.txt").write_text("nothing")
    return bench.grader("grade", folder, "--hints", "none", code=0, word="90/")


def _criteria(bench: Bench, count: int) -> Command:
    path = bench.top / f"criteria-{count}.toml"
    rows = "".join(
        f'[[criterion]]\nid = "c{number}"\npart = "all"\ntitle = "Link {number}"\npoints = 1\nabout = "The base"\ncheck = "shows_box"\nwith = {{ link = "base_link", size = [0.6, 0.4, 0.2], tolerance = 0.002 }}\n'
        for number in range(count)
    )
    path.write_text(
        f'id = "many"\ntitle = "Many"\nurdf = "my_robot.urdf"\npoints = {count}\n[[part]]\nid = "all"\ntitle = "All"\npoints = {count}\n{rows}'
    )
    return bench.grader("grade", URDF, "--rubric", path, word=f"{count}/{count}")


def _submissions(bench: Bench, count: int) -> Command:
    return bench.batch(count)


_INPUTS: dict[str, Callable[[Bench, int], Command]] = {
    "submissions": _submissions,
    "links": _links,
    "files": _files,
    "criteria": _criteria,
}


def arm(links: int) -> str:
    """Return the URDF of a chain of revolute joints, each link with a shape, a body and an inertia."""
    body = '<geometry><cylinder radius="0.05" length="0.2"/></geometry>'
    parts = [
        f'<link name="link_{number}"><visual><origin xyz="0 0 0.1"/>{body}</visual>'
        f'<collision><origin xyz="0 0 0.1"/>{body}</collision><inertial><origin xyz="0 0 0.1"/><mass value="1"/>'
        '<inertia ixx="0.004" ixy="0" ixz="0" iyy="0.004" iyz="0" izz="0.00125"/></inertial></link>'
        for number in range(links)
    ]
    parts += [
        f'<joint name="joint_{number}" type="{"revolute" if number <= 7 else "fixed"}"><parent link="link_{number - 1}"/>'
        f'<child link="link_{number}"/><origin xyz="0 0 0.2" rpy="{0.1 * (number % 3)} 0 0.2"/><axis xyz="0 {number % 2} 1"/>'
        '<limit lower="-1.5" upper="1.5" effort="10" velocity="2"/></joint>'
        for number in range(1, links)
    ]
    return "\n".join(['<robot name="arm">', *parts, "</robot>"])


def _readable(bench: Bench, count: int) -> Path:
    """Return the files of a class, each replaced by the reference's size of file if ROS 2 refuses it."""
    folder = bench.top / f"readable-{count}"
    if not folder.exists():
        folder.mkdir()
        data = URDF.read_bytes()
        for path in sorted(bench.class_of(count).rglob("*.urdf")):
            (folder / path.name).write_bytes(data)
    return folder


def _check_urdf() -> Path:
    return Path(str(distribution("cmeel-urdfdom").locate_file("cmeel.prefix/bin/check_urdf")))


_LIBRARIES = {"LD_LIBRARY_PATH": str(_check_urdf().parent.parent / "lib")}
FIGURES: dict[str, Callable[[Bench], Iterator[Row]]] = {
    "cold": cold,
    "readers": readers,
    "warm": warm,
    "hints": hints,
    "batch": batch,
    "a-thousand": a_thousand,
    "rubric-test": rubric_test,
    "memory": memory,
    "growth": growth,
}


def main(arguments: Sequence[str] | None = None) -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description="Print every speed that the project claims.")
    parser.add_argument(
        "figures", nargs="*", metavar="FIGURE", help=f"any of: {', '.join(FIGURES)}; default: all"
    )
    parser.add_argument("--rounds", type=int, default=11)
    parser.add_argument(
        "--against", type=Path, metavar="FOLDER", help="another checkout to compare with"
    )
    parser.add_argument("--all", action="store_true", help="classes of 100,000 too")
    given = parser.parse_args(arguments)
    unknown = sorted(set(given.figures) - set(FIGURES))
    if unknown:
        parser.error(f"there is no figure {', '.join(unknown)}")
    if given.against is not None and not (given.against / "grader/__main__.py").is_file():
        parser.error(f"--against {given.against} is no checkout")
    print("| figure | measured |\n|---|---|")
    with tempfile.TemporaryDirectory() as top:
        bench = Bench(Path(top), given.rounds, given.against, given.all)
        for name in given.figures or FIGURES:
            for row in FIGURES[name](bench):
                print(row, flush=True)


if __name__ == "__main__":
    main()
