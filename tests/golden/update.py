"""Write the current output of the golden commands: `python tests/golden/update.py`.

Read the diff before you commit it.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent))

from tests.command_line import run
from tests.golden.cases import GOLDEN
from tests.golden.outcomes import FILES, ROWS

if __name__ == "__main__":
    for case in GOLDEN:
        done = run(case.arguments, **case.variables)
        case.file.write_bytes(done.stdout)
        if done.returncode != case.exit_code:
            print(f"{case.name}: exit code {done.returncode}, not {case.exit_code}")
    for name, rows in ROWS.items():
        FILES[name].write_text("".join(f"{row}\n" for row in rows()), encoding="utf-8")
