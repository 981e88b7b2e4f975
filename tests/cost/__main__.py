"""Compare what six commands load and execute with the table: `python -m tests.cost [--write REASON]`.

More than 3 % more modules or instructions fail, with the names of the modules that came. `--write` renews the rows that have
changed, each with the reason. Instructions are those of the processor, with compiled modules, as cachegrind counts them
(valgrind of Debian; without it only modules are compared). They are compared on the build of Python of the table.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.command_line import ROOT

TABLE = Path(__file__).with_name("costs.json")
REFERENCE = "submissions/lab6/reference"
COMMANDS = {
    "grade a correct URDF": [
        "grade",
        f"{REFERENCE}/roscourse_sim_ws/src/my_robot/urdf/my_robot.urdf",
    ],
    "grade a URDF": ["grade", "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"],
    "grade a package": ["grade", REFERENCE],
    "grade a package with control": ["grade", "rubrics/diffdrive", "--rubric", "diffdrive"],
    "inspect a package": ["inspect", REFERENCE],
    "inspect a package with control": ["inspect", "rubrics/diffdrive", "--format", "json"],
}
MOST = 1.03
# Under valgrind a second of the command is nearly a minute, so that its limit of processor time is lifted.
_COUNTED = """
import runpy
from grader.base import processor_time
processor_time.CAN_LIMIT = False
runpy.run_module("grader", run_name="__main__", alter_sys=True)
"""


def cost(arguments: Sequence[str]) -> dict[str, Any]:
    """Return what a command loads and executes."""
    with TemporaryDirectory() as folder:
        report = Path(folder) / "report.json"
        environment = {**os.environ, "COST_REPORT": str(report), "PYTHONHASHSEED": "0"}
        subprocess.run(
            [sys.executable, "-m", "tests.cost.counted", *arguments],
            cwd=ROOT,
            env=environment,
            stdout=subprocess.DEVNULL,
            check=True,
        )
        counted: dict[str, Any] = json.loads(report.read_text(encoding="utf-8"))
    assert counted.pop("code") in (0, 1, None), arguments  # it has run to its end
    if shutil.which("valgrind"):
        counted["instructions"] = count_instructions(arguments)
    return counted


def count_instructions(arguments: Sequence[str]) -> int:
    """Return how many instructions the processor executes for a command."""
    counter = ["valgrind", "--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"]
    done = subprocess.run(
        [*counter, sys.executable, "-c", _COUNTED, *arguments],
        cwd=ROOT,
        env={**os.environ, "PYTHONHASHSEED": "0", "COLUMNS": "100"},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    assert done.returncode in (0, 1), done.stderr
    total = re.search(r"I +refs: +([\d,]+)", done.stderr)
    assert total is not None, done.stderr
    return int(total[1].replace(",", ""))


def excess(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return what is more than a row of the table allows."""
    said = []
    came = sorted({*now["modules"]} - {*before["modules"]})
    if len(now["modules"]) > MOST * len(before["modules"]):
        said.append(f"{len(now['modules'])} modules, not {len(before['modules'])}; new: {came}")
    if now.get("instructions", 0) > MOST * before["instructions"]:
        ratio = now["instructions"] / before["instructions"]
        said.append(f"{ratio:.3f} times as many instructions; new modules: {came or 'none'}")
    others = sorted({*now["packages"]} - {*before["packages"]})
    if others:
        said.append(f"packages that it did not load: {others}")
    return said


def main() -> int:
    """Compare each command with its row, or renew the rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", metavar="REASON", help="renew the rows that have changed")
    given = parser.parse_args()
    table = json.loads(TABLE.read_text(encoding="utf-8")) if TABLE.exists() else {}
    version = sys.version
    if not given.write and table.get("python") != version:
        print(f"not compared: the table is of Python {table.get('python')}, not {version}")
        return 0
    if shutil.which("valgrind") is None:
        print("instructions are not counted: there is no valgrind")
    subprocess.run([sys.executable, "-m", "compileall", "-q", "grader"], cwd=ROOT, check=True)
    rows = table.get("rows", {})
    is_over = False
    for name, arguments in COMMANDS.items():
        now = cost(arguments)
        before = rows.get(name)
        said = excess(before, now) if before is not None else ["it has no row"]
        print(
            f"{name}: {len(now['modules'])} modules, {now.get('instructions', 0) / 1e6:,.0f} million instructions"
        )
        for line in said:
            print(f"  {line}")
        is_over = is_over or bool(said)
        if given.write and (before is None or {**before, "reason": ""} != {**now, "reason": ""}):
            rows[name] = {"reason": given.write, **now}
    if given.write:
        text = json.dumps({"python": version, "rows": rows}, indent=1)
        TABLE.write_text(text + "\n", encoding="utf-8")
        return 0
    return int(is_over)


if __name__ == "__main__":
    sys.exit(main())
