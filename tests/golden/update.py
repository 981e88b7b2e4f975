"""Write the current outcomes of the checks: `python tests/golden/update.py`.

Read the diff before you commit it.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent.parent))

import pytest

from tests.command_line import ROOT
from tests.golden.outcomes import FILES, ROWS

if __name__ == "__main__":
    for name, rows in ROWS.items():
        FILES[name].write_text("".join(f"{row}\n" for row in rows()), encoding="utf-8")
    pytest.main([str(ROOT / "tests/checks"), "-q", "-n0", "--approve"])
