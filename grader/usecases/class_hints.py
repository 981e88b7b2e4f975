"""Search the proven hints of a class in worker processes, with progress."""

from collections.abc import Iterable
from operator import attrgetter
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.hints import remove_old_hints, rubrics_of
from grader.classroom.run.hint_search import ClassHintSearch
from grader.classroom.run.pool import Processes, processors
from grader.classroom.run.progress import Progress
from grader.text import counted
from grader.usecases.terminal import Terminal


class HintOptions(NamedTuple):
    """How hints are searched: the number of workers, and the seconds for a submission."""

    jobs: int | None = None
    timeout: float = 60.0


def search_class_hints(
    book: Gradebook, options: HintOptions, terminal: Terminal, *, reports: bool, statistics: bool
) -> None:
    """Search and store the hints that students' reports show, and those that the statistics of the class count.

    Reports quote the text of the student, so that each content is searched; statistics show one of those with the same
    robot.
    """
    searched = [rubric for rubric in rubrics_of(book) if rubric.hints != "none"] if reports else []
    searches = [ClassHintSearch(book, rubric, attrgetter("content")) for rubric in searched]
    newest = Grades(book).newest_rubric()
    if statistics and newest.sha256 not in {rubric.sha256 for rubric in searched}:
        searches.append(ClassHintSearch(book, newest, attrgetter("robot")))
    total = sum(len(search.wanted) for search in searches)
    if total and book.read_only:
        terminal.warn(f"no hints for {counted(total, 'submission')}: {book.read_only}")
        return
    if total:
        remove_old_hints(book)
        _run(searches, total, options, terminal)
    unavailable = sum(search.unavailable for search in searches)
    if unavailable:
        verb = "has" if unavailable == 1 else "have"
        terminal.warn(
            f"no hints for {counted(unavailable, 'submission')}, which {verb} changed or moved since the last run, "
            "or could not be read: run `grader batch` again"
        )


def _run(searches: Iterable[ClassHintSearch], total: int, options: HintOptions, terminal: Terminal) -> None:
    workers = options.jobs or processors()
    with Processes(workers, options.timeout) as executor, terminal.show_class("searching hints") as show:
        done = Progress(total)
        show(done)
        for search in searches:
            for verdict in search.run(executor, workers):
                done = done.with_result(verdict)
                show(done)
