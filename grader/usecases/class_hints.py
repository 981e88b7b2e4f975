"""Search the proven hints of a class in worker processes, with progress."""

from collections.abc import Callable, Iterable
from contextlib import AbstractContextManager
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.hints import remove_old_hints, rubrics_of
from grader.classroom.run.batch import Progress
from grader.classroom.run.hint_search import Group, HintSearch, same_content, same_robot
from grader.classroom.run.pool import Processes, processors
from grader.files.reading import URDF_LIMIT
from grader.grading.rubric import Rubric
from grader.text import counted
from grader.usecases import Warn

ProgressDisplay = Callable[[str], AbstractContextManager[Callable[[Progress], None]]]


class HintOptions(NamedTuple):
    """How hints are searched: the number of workers, the seconds for a submission, and the bytes of a URDF."""

    jobs: int | None = None
    timeout: float = 60.0
    max_size: int = URDF_LIMIT


def search_class_hints(
    book: Gradebook, options: HintOptions, progress: ProgressDisplay, warn: Warn, *, reports: bool, statistics: bool
) -> None:
    """Search the hints that the reports of students show, and those that the statistics of the class count."""
    searched = [rubric for rubric in rubrics_of(book) if rubric.hints != "none"] if reports else []
    if searched:
        search_hints(book, searched, same_content, options, progress, warn)
    newest = Grades(book).newest_rubric()
    if statistics and newest.sha256 not in {rubric.sha256 for rubric in searched}:
        search_hints(book, [newest], same_robot, options, progress, warn)


def search_hints(
    book: Gradebook,
    rubrics: Iterable[Rubric],
    group: Group,
    options: HintOptions,
    progress: ProgressDisplay,
    warn: Warn,
) -> None:
    """Search the hints of the newest submissions that are not stored yet, once for each group, and store them."""
    searches = [HintSearch(book, rubric, group, options.max_size) for rubric in rubrics]
    total = sum(len(search.wanted) for search in searches)
    if total and book.read_only:
        warn(f"no hints for {counted(total, 'submission')}: {book.read_only}")
        return
    if total:
        remove_old_hints(book)
        _run(searches, total, options, progress)
    unavailable = sum(search.unavailable for search in searches)
    if unavailable:
        verb = "has" if unavailable == 1 else "have"
        warn(
            f"no hints for {counted(unavailable, 'submission')}, which {verb} changed or moved since the last run: "
            "run `grader batch` again"
        )


def _run(searches: Iterable[HintSearch], total: int, options: HintOptions, progress: ProgressDisplay) -> None:
    workers = options.jobs or processors()
    with Processes(workers, options.timeout) as executor, progress("searching hints") as show:
        done = Progress(total)
        show(done)
        for search in searches:
            for verdict in search.run(executor, workers):
                done = done.with_result(verdict)
                show(done)
