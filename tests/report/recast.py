"""The same report with other words wherever a student's may stand."""

from collections.abc import Callable
from dataclasses import dataclass, replace

from grader.grading.report import GradedSubmission, Report, Result
from grader.report.content import other_problems
from grader.robot.reader import Verdict
from grader.source import Location, Source
from grader.submission.urdf import OtherCandidate
from grader.text import printable

Words = Callable[[], str]


@dataclass(frozen=True)
class Package:
    """A package by name."""

    folder: str
    name: str


@dataclass(frozen=True)
class Recast:
    """A submission of other words. Its paths are printable, as all paths in a submission are."""

    id: str
    path: str | None
    sha256: str | None
    package: Package | None
    other_candidates: tuple[OtherCandidate, ...]
    ignored: tuple[str, ...]
    has_urdf: bool
    verdict: Verdict | None
    is_single: bool
    unread: str
    text: str | None

    def source(self, path: str) -> Source | None:
        """The same text whatever the path is."""
        return Source(path, self.text) if self.text is not None else None


def recast(report: Report, words: Words) -> Report:
    """A report of the same results, in other words: messages, notes, problems, paths, names, lines that are quoted."""

    def path() -> str:
        return f"a{printable(words())}"

    problems = tuple(replace(each, message=words(), location=Location(path(), 2, 3)) for each in other_problems(report))
    return replace(
        report,
        submission=_submission(report.submission, words, path),
        results=tuple(_result(each, words, path) for each in report.results),
        problems=problems,
        notes=tuple(words() for _ in report.notes),
        exhibits=tuple(
            each._replace(files=tuple(replace(file, path=path()) for file in each.files)) for each in report.exhibits
        ),
        others=tuple(replace(each, path=path()) for each in report.others),
    )


def _submission(old: GradedSubmission, words: Words, path: Words) -> GradedSubmission:
    return Recast(
        words(),
        path() if old.path is not None else None,
        old.sha256,
        Package(path() if old.package.folder else "", words()) if old.package is not None else None,
        tuple(OtherCandidate(path(), words()) for _ in old.other_candidates),
        tuple(words() for _ in old.ignored),
        old.has_urdf,
        old.verdict,
        old.is_single,
        "unread" if old.unread else "",
        "\n".join(f"<a b='{words()}'/>{words()}" for _ in range(3)),
    )


def _result(old: Result, words: Words, path: Words) -> Result:
    outcome = old.outcome
    where = Location(path(), 1, 2) if outcome.location is not None else None
    measured = f"found\n{words()}" if isinstance(outcome.measured, str) else outcome.measured
    return old._replace(outcome=outcome._replace(message=words(), measured=measured, location=where))
