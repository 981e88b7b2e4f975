"""What the cases of marks_by_python.toml earn: `python -m tests.known.marks_by_python` writes marks_by_python.json.

Each version of Python prints the same, but for the sentence that a case needs a newer one. So the newest version writes the file.
"""

import json
import sys
from dataclasses import replace
from hashlib import sha256
from pathlib import Path
from shutil import copytree
from tempfile import TemporaryDirectory
from typing import Any, NamedTuple

import tomli

from grader.lab.grading.grade import grade
from grader.lab.submission.opening import open_submission
from grader.report.formats import Format, render
from tests.command_line import run
from tests.samples import LAB6, ROOT

MARKS = Path(__file__).with_suffix(".json")
_REFERENCE = ROOT / "submissions" / "lab6" / "reference" / "roscourse_sim_ws"
_PACKAGE = Path("src", "my_robot")
_FILES = {
    "setup": _PACKAGE / "setup.py",
    "launch": _PACKAGE / "launch" / "my_robot_rviz.launch.py",
}
_XACRO = """<robot name="my_robot" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <link name="base_link"><visual><geometry><box size="{} 1 1"/></geometry></visual></link>
</robot>
"""


class Case(NamedTuple):
    """A change of one file, and the release of the rubric."""

    name: str
    line: str
    file: str = "setup"
    distro: str = "jazzy"
    needs: int = 0  # the minor version of Python that reads it

    @property
    def is_read(self) -> bool:
        """Whether the Python that runs here reads it."""
        return sys.version_info.minor >= self.needs


CASES = [
    Case(**row)
    for row in tomli.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))["case"]
]


def marks(case: Case) -> dict[str, Any]:
    """Return what a case earns, what is said of it, and the digests of its outputs."""
    with TemporaryDirectory() as folder:
        if case.file == "urdf":
            robot = Path(folder, "my_robot.urdf.xacro")
            robot.write_text(_XACRO.format(case.line), "utf-8")
            return _inspected(robot, case)
        workspace = copytree(_REFERENCE, Path(folder, "workspace"))
        file = workspace / _FILES[case.file]
        file.write_text(f"{case.line}\n{file.read_text('utf-8')}", "utf-8")
        rubric = replace(LAB6, distro=case.distro)  # type: ignore[arg-type]  # a name from the table
        report = grade(rubric, open_submission(str(workspace), rubric.lab))
        said = [
            f"{result.criterion.id} {result.outcome.status}: {result.outcome.message}"
            for result in report.results
            if result.criterion.part == "task2" and result.outcome.status != "passed"
        ]
        return {
            "score": str(report.score),
            "pending": str(report.pending),
            "said": said,
            "report": _digest(render(report, Format.JSON).encode()),
            **_inspected(workspace, case),
        }


def _inspected(path: Path, case: Case) -> dict[str, Any]:
    """Return the problems that are found, and the digest of all that is printed."""
    options = ["inspect", path, "--distro", case.distro, "--format", "json"]
    done = run(options)
    output = done.stdout.replace(str(path).encode(), b"")
    inspection = json.loads(output)
    problems = [
        f"{problem['code']} {problem['severity']}: {problem['message']}"
        for each in (inspection, *inspection["robots"])
        for problem in each["problems"]
    ]
    return {"problems": problems, "exit": done.returncode, "inspection": _digest(output)}


def _digest(data: bytes) -> str:
    return sha256(data).hexdigest()[:16]


def main() -> None:
    """Write what each case earns."""
    if not all(case.is_read for case in CASES):
        raise SystemExit("write the file with the newest version of Python that a case needs")
    table = {case.name: marks(case) for case in CASES}
    MARKS.write_text(json.dumps(table, indent=1, ensure_ascii=False) + "\n", "utf-8")


if __name__ == "__main__":
    main()
