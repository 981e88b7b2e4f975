"""Times of the largest inputs that the tests limit by counted work: `python -m benchmarks.bounds`.

Each row is a whole command in a process of its own, in seconds on this machine: the best of three.
"""

import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from tests.cli.test_bounded_work import DOCUMENTS, RUBRICS, URDF, URDFS

RUNS = 3


def inputs(folder: Path) -> Iterator[tuple[str, tuple[str | Path, ...]]]:
    """Write each input below a folder, and yield what it is with the command that reads it."""
    for number, (kind, text) in enumerate(URDFS.items()):
        path = folder / f"{number}.urdf"
        path.write_text(text)
        yield f"URDF: {kind}, inspect", ("inspect", path)
        yield f"URDF: {kind}, grade", ("grade", path)
    for number, (kind, text) in enumerate(RUBRICS.items()):
        path = folder / f"{number}.toml"
        path.write_text(text)
        yield f"rubric: {kind}", ("rubric", "check", path)
    for number, (kind, (text, count)) in enumerate(DOCUMENTS.items()):
        path = folder / str(number)
        path.mkdir()
        (path / "my_robot.urdf").write_bytes(URDF)
        for index in range(count):
            (path / f"{index}.md").write_text(text)
        yield f"documents: {kind}", ("grade", path)


def seconds(arguments: tuple[str | Path, ...]) -> float:
    """Return how long a command takes."""
    start = time.perf_counter()
    subprocess.run([sys.executable, "-m", "grader", *arguments], capture_output=True, check=False)
    return time.perf_counter() - start


def main() -> None:
    """Print the time of each input."""
    with tempfile.TemporaryDirectory() as folder:
        for name, arguments in inputs(Path(folder)):
            print(f"{min(seconds(arguments) for _ in range(RUNS)):6.2f} s  {name}", flush=True)


if __name__ == "__main__":
    main()
