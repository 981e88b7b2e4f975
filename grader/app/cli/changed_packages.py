"""The hook `grader-inspect` of pre-commit: `grader inspect` of each package that a commit changes.

Run it as `python -I -m grader.app.cli.changed_packages [OPTION]... FILE...`.
"""

import sys
from collections.abc import Sequence
from pathlib import Path

from grader.app.cli.app import run
from grader.files.limits import ROBOT_ENDINGS


def main(arguments: Sequence[str]) -> int:
    """Inspect the packages of the files, which come last; return the highest exit code.

    Without another format, each finding has a line with its path from the repository's root, where
    pre-commit runs the hook.
    """
    options = list(arguments)
    places = set()
    while options and Path(options[-1]).is_file():
        place = _find_inspected(Path(options.pop()))
        if place:
            places.add(place)
    if not any(option.startswith("--format") for option in options):
        options += ["--format", "concise"]
    codes = [run(["inspect", *options, "--", str(place)]) for place in sorted(places)]
    return max(codes, default=0)


def _find_inspected(file: Path) -> Path | None:
    """Return the package that a file is in, else a robot on its own; None for other files."""
    for folder in file.parents:
        if (folder / "package.xml").is_file():
            return folder
    return file if file.name.lower().endswith(ROBOT_ENDINGS) else None


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
