"""Time what an editor waits for after a change: `python -m benchmarks.editor [CHANGES]`.

The changes are those of a word or a line, in a lab, a workspace, and 20 packages; each is undone before the next. The
figures are of CPU time, from a change to its diagnostics. Every tenth look is compared with one from nothing.
"""

import random
import shutil
import sys
import time
from functools import partial
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory

from grader.app.editor.diagnostics import make_diagnostics
from grader.app.editor.edited_files import EditedFiles
from grader.app.editor.session import EditorSession
from tests.command_line import ROOT
from tests.workspace.random_edits import Files, edited_text, files_of
from tests.workspace.test_kept import twenty_packages

_CHECKED = 10  # looks, of which one is compared with one from nothing


def _write(folder: Path, files: Files) -> None:
    for path, data in files.items():
        file = folder / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_bytes(data)


def _times(root: Path, files: Files, changes: int) -> tuple[float, list[float]]:
    """Return the CPU time of the first look in seconds, and those after changes."""
    session, draw = EditorSession(root), random.Random(root.name)
    start = time.process_time()
    make_diagnostics(session.look(), root)
    first, times = time.process_time() - start, []
    for number in range(changes):
        path = draw.choice(sorted(files))
        text = edited_text(files[path], draw).decode("utf-8", "ignore")
        session.change(partial(EditedFiles.type, path=path, text=text))
        start = time.process_time()
        found = make_diagnostics(session.look(), root)
        times.append(time.process_time() - start)
        if number % _CHECKED == 0:
            anew = EditorSession(root)
            anew.files.type(path, text)
            assert make_diagnostics(anew.look(), root) == found, path
        session.change(partial(EditedFiles.close, path=path))
        session.look()
    return first, times


def main(changes: int) -> None:
    """Print the figures."""
    workspaces = {
        "lab6": files_of(ROOT / "rubrics/lab6"),
        "diffdrive": files_of(ROOT / "rubrics/diffdrive"),
        "20 packages": twenty_packages(),
    }
    with TemporaryDirectory() as folder:
        for name, files in workspaces.items():
            root = Path(folder).resolve() / name
            _write(root, files)
            first, times = _times(root, files, changes)
            middle, longest = 1000 * median(times), 1000 * max(times)
            print(
                f"{name}: first {1000 * first:.0f} ms, then {middle:.0f} ms, at most {longest:.0f}"
            )
            shutil.rmtree(root)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
