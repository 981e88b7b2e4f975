"""Times and memory of the largest inputs that the tests limit by counted work: `python -m benchmarks.bounds [URDF|rubric|documents|xacro]`.

Each row is a whole command in a process of its own, in seconds of processor time and megabytes on this machine: of up to
three runs the first within its limit. The exit code is 1 if a row of xacro exceeds that beyond what a command on a tiny file takes.
"""

import json
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

from tests.cli.test_bounded_work import DOCUMENTS, RUBRICS, URDF, URDFS
from tests.xacro.hostile_costs import COSTS

RUNS = 3
SECONDS, MEGABYTES = 1.0, 200
_TINY = '<robot name="tiny"><link name="base_link"/></robot>'
# A process is at first as large as the one that starts it, so that a small one has to.
_MEASURE = """
import json, resource, subprocess, sys
subprocess.run([sys.executable, "-m", "grader", *sys.argv[1:]], capture_output=True)
used = resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([used.ru_utime + used.ru_stime, used.ru_maxrss // 1024]))
"""


class Row(NamedTuple):
    """A command that reads a large input; `times` is how many times the limit it may take, 0 where it has none."""

    name: str
    arguments: tuple[str | Path, ...]
    times: int = 0


def inputs(folder: Path) -> Iterator[Row]:
    """Write each input below a folder, and yield the command that reads it."""
    for number, (kind, text) in enumerate(URDFS.items()):
        path = folder / f"{number}.urdf"
        path.write_text(text)
        yield Row(f"URDF: {kind}, inspect", ("inspect", path))
        yield Row(f"URDF: {kind}, grade", ("grade", path))
    for number, (kind, text) in enumerate(RUBRICS.items()):
        path = folder / f"{number}.toml"
        path.write_text(text)
        yield Row(f"rubric: {kind}", ("rubric", "check", path))
    for number, (kind, (text, count)) in enumerate(DOCUMENTS.items()):
        path = folder / str(number)
        path.mkdir()
        (path / "my_robot.urdf").write_bytes(URDF)
        for index in range(count):
            (path / f"{index}.md").write_text(text)
        yield Row(f"documents: {kind}", ("grade", path))
    for kind, document in COSTS.items():
        path = folder / "xacro"
        for name, content in {document.path: document.text, **document.files}.items():
            (path / name).parent.mkdir(parents=True, exist_ok=True)
            (path / name).write_bytes(content if isinstance(content, bytes) else content.encode())
        yield Row(f"xacro: {kind}, inspect", ("inspect", path), 1)
        yield Row(f"xacro: {kind}, hints", ("grade", "--hints", "edit", path), 2)
        shutil.rmtree(path)


def measured(arguments: tuple[str | Path, ...]) -> tuple[float, int]:
    """Return how many seconds and megabytes a command takes."""
    done = subprocess.run(
        [sys.executable, "-c", _MEASURE, *arguments], capture_output=True, check=True
    )
    seconds, megabytes = json.loads(done.stdout)
    return seconds, megabytes


def main() -> None:
    """Print the time and the memory of each input."""
    with tempfile.TemporaryDirectory() as folder:
        tiny = Path(folder, "tiny.urdf")
        tiny.write_text(_TINY)
        bare = min(measured(("inspect", tiny)) for _ in range(RUNS))[0]
        code = 0
        for row in inputs(Path(folder)):
            if not row.name.startswith("".join(sys.argv[1:])):
                continue
            for _ in range(RUNS):
                seconds, megabytes = measured(row.arguments)
                is_above = seconds - bare > row.times * SECONDS or megabytes > row.times * MEGABYTES
                if not is_above:
                    break
            is_too_slow = is_above and row.times > 0
            mark = " ABOVE" if is_too_slow else ""
            print(f"{seconds:6.2f} s {megabytes:5} MB  {row.name}{mark}", flush=True)
            code |= is_too_slow
    sys.exit(code)


if __name__ == "__main__":
    main()
