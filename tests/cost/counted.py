"""Run a command of the grader, and print which modules it loads.

`python -m tests.cost.counted ARGUMENT...`; the report goes to the file that COST_REPORT names.
"""

import json
import os
import sys
from pathlib import Path


def main() -> None:
    """Run the command, and write the report when it ends."""
    before = {*sys.modules}
    code: object = 0
    try:
        from grader.__main__ import main as run_command

        run_command()
    except SystemExit as error:
        code = error.code
    new = {*sys.modules} - before
    own = sorted(name for name in new if name.partition(".")[0] == "grader")
    # The part of a package that mypyc compiles has a name of its build.
    others = {name.partition(".")[0] for name in new if not name.endswith("__mypyc")}
    others -= {"grader", *sys.stdlib_module_names}
    report = {
        "code": code,
        "modules": own,
        "packages": sorted(name for name in others if not name.startswith("_")),
    }
    Path(os.environ["COST_REPORT"]).write_text(json.dumps(report), encoding="utf-8")


if __name__ == "__main__":
    main()
