"""Write what the checks find in the rows now, and show what changed: `python -m tests.checks [CHECK]`."""

import difflib
import sys

from tests.checks.rows import CORPUS, Row, read_rows

_ROW = "[[row]]\n"


def write(row: Row, found: str) -> None:
    """Replace what a row expects: its lines from `status` on."""
    path = CORPUS / f"{row.check.name}.toml"
    head, *rows = path.read_text(encoding="utf-8").split(_ROW)
    given = rows[row.index].partition("\nstatus = ")[0].rstrip("\n")
    rows[row.index] = f"{given}\n{found}" + "\n" * (row.index < len(rows) - 1)
    path.write_text(_ROW.join((head, *rows)), encoding="utf-8")


if __name__ == "__main__":
    for row in read_rows():
        if (
            row.check.name in (sys.argv[1:] or row.check.name)
            and (found := row.found()) != row.expected
        ):
            texts = row.expected.splitlines(), found.splitlines()
            print(
                f"== {row.name}",
                *difflib.unified_diff(*texts, "before", "now", lineterm="", n=1),
                sep="\n",
            )
            write(row, found)
