"""Run a command of the grader, and print which modules it loads and how many instructions its own code runs.

`python -m tests.cost.counted ARGUMENT...`; the report goes to the file that COST_REPORT names.
"""

import json
import os
import sys
from pathlib import Path
from types import FrameType
from typing import Any

_OWN = str(Path(__file__).resolve().parents[2] / "grader") + os.sep


class Counter:
    """The instructions of bytecode that the code of the grader has executed."""

    instructions = 0

    def enter(self, frame: FrameType, _event: str, _argument: Any) -> Any:
        """Count in the functions of the grader, and in no others."""
        if not frame.f_code.co_filename.startswith(_OWN):
            return None
        frame.f_trace_opcodes, frame.f_trace_lines = True, False
        return self.count

    def count(self, _frame: FrameType, event: str, _argument: Any) -> Any:
        """Count an instruction."""
        if event == "opcode":
            self.instructions += 1
        return self.count


def main() -> None:
    """Count while the command runs, and write the report when it ends."""
    counter = Counter()
    before = {*sys.modules}
    sys.settrace(counter.enter)
    code: object = 0
    try:
        from grader.__main__ import main as run_command

        run_command()
    except SystemExit as error:
        code = error.code
    finally:
        sys.settrace(None)
    new = {*sys.modules} - before
    own = sorted(name for name in new if name.partition(".")[0] == "grader")
    # The part of a package that mypyc compiles has a name of its build.
    others = {name.partition(".")[0] for name in new if not name.endswith("__mypyc")}
    others -= {"grader", *sys.stdlib_module_names}
    report = {
        "code": code,
        "instructions": counter.instructions,
        "modules": own,
        "packages": sorted(name for name in others if not name.startswith("_")),
    }
    Path(os.environ["COST_REPORT"]).write_text(json.dumps(report), encoding="utf-8")


if __name__ == "__main__":
    main()
