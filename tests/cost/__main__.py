"""Compare what five commands load and execute with the table: `python -m tests.cost [--write REASON]`.

More than 3 % more modules or instructions fail, with the names of the modules that came. `--write` renews the rows that have
changed, each with the reason. Instructions are counted in the code of the grader only, on the version of Python of the table.
"""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.command_line import ROOT

TABLE = Path(__file__).with_name("costs.json")
COMMANDS = {
    "grade a URDF": ["grade", "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"],
    "grade a package": ["grade", "submissions/lab6/reference"],
    "grade a package with control": ["grade", "rubrics/diffdrive", "--rubric", "diffdrive"],
    "inspect a package": ["inspect", "submissions/lab6/reference"],
    "inspect a package with control": ["inspect", "rubrics/diffdrive", "--format", "json"],
}
MOST = 1.03


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
    return counted


def excess(before: dict[str, Any], now: dict[str, Any]) -> list[str]:
    """Return what is more than a row of the table allows."""
    said = []
    came = sorted({*now["modules"]} - {*before["modules"]})
    if len(now["modules"]) > MOST * len(before["modules"]):
        said.append(f"{len(now['modules'])} modules, not {len(before['modules'])}; new: {came}")
    if now["instructions"] > MOST * before["instructions"]:
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
    version = ".".join(map(str, sys.version_info[:2]))
    if not given.write and table.get("python") != version:
        print(f"not compared: the table is of Python {table.get('python')}, not {version}")
        return 0
    rows = table.get("rows", {})
    is_over = False
    for name, arguments in COMMANDS.items():
        now = cost(arguments)
        before = rows.get(name)
        said = excess(before, now) if before is not None else ["it has no row"]
        print(f"{name}: {len(now['modules'])} modules, {now['instructions']:,} instructions")
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
