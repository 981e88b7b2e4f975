"""What a CI job gets without being asked: places in the repository, and on GitHub Actions annotations and a job summary."""

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

from grader.cli.output import complain
from grader.errors import GraderError, InputError
from grader.usecases.writing import CHECKOUTS, refuse_links

if TYPE_CHECKING:
    from grader.grading.report import Report
    from grader.report.places import Base

_SUMMARY_LIMIT = 1024 * 1024  # bytes that GitHub takes of a step's summary; it shows nothing of a longer one


def on_github() -> bool:
    """Whether this runs in a job of GitHub Actions."""
    return os.environ.get("GITHUB_ACTIONS") == "true"


def tell_github(report: "Report", base: "Base", *, annotate: bool) -> None:
    """Put findings on the lines that they are about, and the report into the job's summary.

    Annotations go to standard error, which GitHub reads for commands as well: standard output is the report's alone.
    """
    from grader.report.github import render_github
    from grader.report.markdown import cut_markdown

    if annotate:
        _annotate(render_github(report, base))
    _add_to_summary(lambda room: cut_markdown(report, room))


def tell_github_nothing(reason: str) -> None:
    """Say where a student looks that nothing was graded, and why."""
    from grader.report.github import command
    from grader.report.markdown_text import escaped
    from grader.text import printable

    lines = [printable(line) for line in reason.splitlines()]
    _annotate(command("error", None, "Nothing was graded", "\n".join(lines)))
    text = "\n\n".join(("# Nothing was graded", *map(escaped, lines))) + "\n"
    _add_to_summary(lambda room: text if len(text.encode()) <= room else "")


@contextmanager
def refusals_told() -> Iterator[None]:
    """Say in a job on GitHub why nothing was graded, whatever stops a command before it has."""
    try:
        yield
    except GraderError as error:
        if on_github():
            tell_github_nothing(str(error))
        raise


def _annotate(commands: str) -> None:
    if sys.stderr is not None:
        with suppress(OSError):
            sys.stderr.write(commands)
            sys.stderr.flush()


def _add_to_summary(text: Callable[[int], str]) -> None:
    """Add a text, made for so many bytes, to what a step has in its summary already, as far as there is room."""
    summary = os.environ.get("GITHUB_STEP_SUMMARY")
    if not summary:
        return
    try:
        refuse_links(Path(summary))
        with open(summary, "ab", opener=_no_link) as file:
            taken = file.tell()
            added = text(_SUMMARY_LIMIT - taken - 1).encode("utf-8", "backslashreplace")
            if added:
                file.write(b"\n" * bool(taken) + added)
    except OSError as error:
        complain(f"the job summary cannot be written: {error.strerror or error}")
    except InputError as error:
        complain(f"the job summary: {error}")


def _no_link(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NOFOLLOW", 0), 0o666)


def base_of(path: str, *, is_single: bool) -> "Base":
    """Where a submission stands in the repository around it, if there is one; a URDF on its own stands in its folder."""
    from grader.report.places import Base

    if path == "-":
        return Base(is_outside=True)
    named = Path(path)
    is_folder = named.is_dir()
    # A file is called what it was named, whatever a link of that name leads to; of a folder the files count.
    place = named.resolve() if is_folder else named.parent.resolve() / named.name
    root = _repository(place)
    if root is None:
        return Base(is_outside=True)
    if is_folder or is_single:
        folder = (place if is_folder else place.parent).relative_to(root).as_posix()
        return Base("" if folder == "." else f"{folder}/")
    return Base(archive=place.relative_to(root).as_posix())


def _repository(place: Path) -> Path | None:
    """The root of the repository that a path is in: as the CI system says, by its `.git`, or else the current folder."""
    around = [place, *place.parents]
    for name in CHECKOUTS:
        checkout = Path(os.environ.get(name) or os.sep).resolve()
        if checkout in around[:-1]:  # the last is the file system's root
            return checkout
    for folder in around:
        if (folder / ".git").exists():
            return folder
    with suppress(OSError):  # the current folder may be gone
        here = Path.cwd()
        return here if here in around else None
    return None
