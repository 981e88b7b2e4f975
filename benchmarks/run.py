"""Measurements behind the speed claims: `python benchmarks/run.py`. Quote the ratios; absolute times are the machine's.

Quote the ratios; absolute times depend on the machine. Every pair is timed alternately, A
B A B, so that a machine whose speed drifts favours neither.
"""

import contextlib
import io
import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from importlib import import_module
from importlib.metadata import PackageNotFoundError, distribution
from importlib.util import find_spec
from pathlib import Path

from lxml import etree

from grader.grading.grade import grade
from grader.grading.rubric import load_rubric
from grader.report.as_json import render_json
from grader.report.formats import Format
from grader.robot.kinematics import Configuration
from grader.robot.reader import read_urdf
from grader.submission.opening import open_submission, read_submission
from grader.submission.surroundings import Surroundings
from grader.xacro.expansion import expand

ROOT = Path(__file__).resolve().parent.parent
WORKSPACE = ROOT / "submissions" / "reference"
PACKAGE = WORKSPACE / "roscourse_sim_ws" / "src" / "my_robot"
URDF = PACKAGE / "urdf" / "my_robot.urdf"
ZIPPED = ROOT / "submissions" / "equivalent-zipped-with-wrapper" / "lab6.zip"
XACRO = ROOT / "submissions" / "equivalent-xacro-inertials" / "my_robot.urdf.xacro"
BARE = "import typer, lxml, numpy, rich"
BARE_USED = "import typer, lxml.etree, numpy, rich.console"
CLASSROOM = {
    **dict.fromkeys(("CLASSROOM", "ASSIGNMENT", "USERNAME", "COMMIT_URL", "RELEASE_URL"), "lab6"),
    "SUBMISSION_TAG": "submit/2026-09-01T10-00-00Z-ab12cd3",
}
CHAIN = (10, 100, 1_000, 10_000)


def main() -> None:
    """Print every figure of the page."""
    whole_process()
    whole_packages()
    all_formats()
    warm_grading()
    warm_packages()
    warm_xacro()
    inspecting()
    forward_kinematics()


def whole_process(runs: int = 15) -> None:
    """Compare the whole process with importing its dependencies in a bare interpreter."""
    python, module = sys.executable, [sys.executable, "-m", "grader"]
    commands = {
        "bare imports": [python, "-c", BARE],
        "bare imports, submodules": [python, "-c", BARE_USED],
        "grade": [*module, "grade", str(URDF)],
        "grade --format json": [*module, "grade", str(URDF), "--format", "json"],
        "inspect": [*module, "inspect", str(URDF)],
        "--help": [*module, "--help"],
        "--version": [*module, "--version"],
    }
    times = in_turn({name: process(command) for name, command in commands.items()}, runs)
    table("The whole process", times, "bare imports", f"python -c '{BARE}'")


def whole_packages(runs: int = 15) -> None:
    """Compare processes that grade a package, a workspace with answers and pictures, and its zip with the URDF alone."""
    module = [sys.executable, "-m", "grader"]
    submitted = {"the URDF alone": URDF, "package": PACKAGE, "workspace": WORKSPACE, "zip": ZIPPED}
    times = in_turn({name: process([*module, "grade", str(path)]) for name, path in submitted.items()}, runs)
    table("Whole submissions as a whole process", times, "the URDF alone", "grade my_robot.urdf")


def all_formats(runs: int = 25) -> None:
    """Compare a run that saves every format with one that saves one, for a submission with mistakes and one without."""
    for name in ("several-mistakes", "reference"):
        command = [sys.executable, "-m", "grader", "grade", str(ROOT / "submissions" / name)]
        with tempfile.TemporaryDirectory() as folder:
            saves = {kind: f"{kind}={Path(folder, kind)}" for kind in Format}
            commands = {
                "one format": [*command, "--save", saves[Format.JSON]],
                "all formats": [*command, *(word for save in saves.values() for word in ("--save", save))],
            }
            environment = {**process_environment(), **CLASSROOM}
            times = in_turn({key: process(words, environment) for key, words in commands.items()}, runs)
        table(f"All {len(saves)} formats of {name}", times, "one format", "--save json=FILE")


def warm_packages(runs: int = 15) -> None:
    """Compare opening and grading a whole submission in a running process with the URDF in it alone."""
    rubric = load_rubric("lab6")

    def grading(path: Path) -> Callable[[], object]:
        return lambda: grade(rubric, open_submission(str(path), rubric.lab))

    submitted = {"the URDF alone": URDF, "package": PACKAGE, "workspace": WORKSPACE, "zip": ZIPPED}
    times = in_turn({name: repeated(grading(path), 10) for name, path in submitted.items()}, runs)
    table("Whole submissions, warm, from a path to the report", times, "the URDF alone", "grade my_robot.urdf")


def warm_xacro(runs: int = 15) -> None:
    """Compare grading a robot in xacro with grading the URDF that xacro makes of it, in a running process."""
    rubric, data = load_rubric("lab6"), XACRO.read_bytes()
    expanded = expand(data, XACRO.name, Surroundings().workspace(), {}).root
    assert expanded is not None
    plain = etree.tostring(expanded, pretty_print=True)

    def grading(data: bytes, path: str) -> Callable[[], object]:
        return lambda: grade(rubric, read_submission(data, identity="a", path=path))

    files = {"the expanded URDF": (plain, "my_robot.urdf"), "xacro": (data, XACRO.name)}
    times = in_turn({name: repeated(grading(*file), 50) for name, file in files.items()}, runs)
    table("xacro, warm, bytes to report", times, "the expanded URDF", "grade my_robot.urdf")


def warm_grading(runs: int = 25) -> None:
    """Compare grading in a running process with lxml's own parse of the same bytes."""
    rubric, data = load_rubric("lab6"), URDF.read_bytes()

    def grade_once() -> None:
        grade(rubric, read_submission(data, identity="a", path="my_robot.urdf"))

    def to_json() -> None:
        render_json(grade(rubric, read_submission(data, identity="a", path="my_robot.urdf")))

    times = in_turn(
        {
            "lxml.etree.fromstring": repeated(lambda: etree.fromstring(data), 1_000),
            "read_urdf": repeated(lambda: read_urdf(data), 100),
            "grade, bytes to report": repeated(grade_once, 50),
            "grade, bytes to JSON": repeated(to_json, 50),
            **{name: repeated(run, 50) for name, run in other_parsers(data)},
        },
        runs,
    )
    table(f"Warm, the reference of {len(data)} bytes", times, "lxml.etree.fromstring", "lxml.etree.fromstring")


def inspecting(runs: int = 10) -> None:
    """Compare inspect as a whole process with other readers of URDF, if they are installed."""
    commands = {"grader inspect": process([sys.executable, "-m", "grader", "inspect", str(URDF), "--format", "json"])}
    program = check_urdf()
    if program is not None:
        environment = {**os.environ, "LD_LIBRARY_PATH": str(program.parent.parent / "lib")}
        commands["check_urdf"] = process([str(program), str(URDF)], environment)
    scripts = {
        "pinocchio": "import pinocchio as p; m = p.buildModelFromUrdf({0!r}); p.forwardKinematics(m, m.createData(), p.neutral(m))",
        "yourdfpy": "import yourdfpy; yourdfpy.URDF.load({0!r}, load_meshes=False)",
        "urdf_parser_py": "from urdf_parser_py.urdf import URDF; URDF.from_xml_string(open({0!r}, 'rb').read())",
    }
    for name, script in scripts.items():
        if find_spec(name) is not None:
            commands[name] = process([sys.executable, "-W", "ignore", "-c", script.format(str(URDF))])
    table("inspect as a whole process", in_turn(commands, runs), "grader inspect", "grader inspect")


def forward_kinematics() -> None:
    """Measure every pose of a chain of revolute joints, read once and solved anew."""
    print("\nForward kinematics, every link's pose in the root")
    for count in CHAIN:
        reading = read_urdf(chain(count), "chain.urdf")
        assert reading.robot is not None
        robot = reading.robot
        names = [link.name for link in robot.links]
        positions = {joint.name: 0.1 for joint in robot.joints}

        def solve() -> None:
            configuration = Configuration(robot, positions)
            for name in names:
                configuration.pose(name)

        best = min(once(solve) for _ in range(max(3, 3_000 // count)))
        print(f"  {count:>6} links  {best * 1e3:9.3f} ms  {best / count * 1e6:6.2f} us a link")


def chain(count: int) -> bytes:
    """Return the URDF of a chain of this many links."""
    lines = (
        f'<link name="l{index}"/><joint name="j{index}" type="continuous"><parent link="l{index - 1}"/>'
        f'<child link="l{index}"/><origin xyz="0.1 0 0.01" rpy="0.1 0.2 0.3"/><axis xyz="0 1 0"/></joint>'
        for index in range(1, count)
    )
    return "\n".join(['<robot name="chain">', '<link name="l0"/>', *lines, "</robot>"]).encode()


def other_parsers(data: bytes) -> list[tuple[str, Callable[[], object]]]:
    """Measure urdf_parser_py in the same process, if it is installed."""
    if find_spec("urdf_parser_py") is None:
        return []
    parser = import_module("urdf_parser_py.urdf").URDF

    def parse() -> None:
        with contextlib.redirect_stderr(io.StringIO()):
            parser.from_xml_string(data)

    return [("urdf_parser_py, parse only", parse)]


def check_urdf() -> Path | None:
    """Measure urdfdom's own program, if the test extra is installed."""
    try:
        return Path(str(distribution("cmeel-urdfdom").locate_file("cmeel.prefix/bin/check_urdf")))
    except PackageNotFoundError:
        return None


def process(command: list[str], environment: dict[str, str] | None = None) -> Callable[[], float]:
    """Run a whole process and return its time in seconds."""
    variables = process_environment() if environment is None else environment

    def run() -> float:
        return once(lambda: subprocess.run(command, capture_output=True, env=variables, check=False))

    return run


def process_environment() -> dict[str, str]:
    """Return the environment of a process that finds its bytecode ready, as an installed package does."""
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": str(Path(tempfile.gettempdir()) / "grader-benchmark")}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    return environment


def repeated(run: Callable[[], object], count: int) -> Callable[[], float]:
    """Return a function that runs several times and returns the seconds for each."""

    def batch() -> float:
        start = time.perf_counter()
        for _ in range(count):
            run()
        return (time.perf_counter() - start) / count

    return batch


def once(run: Callable[[], object]) -> float:
    """Return the seconds that a call takes."""
    start = time.perf_counter()
    run()
    return time.perf_counter() - start


def in_turn(runs: dict[str, Callable[[], float]], count: int) -> dict[str, list[float]]:
    """Run this many rounds of all measurements in turn, after a round that is not measured."""
    times: dict[str, list[float]] = {name: [] for name in runs}
    for number in range(count + 1):
        for name, run in runs.items():
            seconds = run()
            if number:
                times[name].append(seconds)
    return times


def table(title: str, times: dict[str, list[float]], base: str, base_words: str) -> None:
    """Print medians and minima, and each as a multiple of the base's."""
    print(f"\n{title} (1 = {base_words})")
    median, least = statistics.median(times[base]), min(times[base])
    for name, values in times.items():
        middle, best = statistics.median(values), min(values)
        print(
            f"  {name:<28} median {middle * 1e3:9.3f} ms  {middle / median:6.2f} x   least {best * 1e3:9.3f} ms"
            f"  {best / least:6.2f} x"
        )


if __name__ == "__main__":
    main()
