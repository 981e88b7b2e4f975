"""The same report with other words wherever a student's may stand, and what every format makes of it but the words."""

from collections.abc import Callable
from dataclasses import replace
from itertools import groupby
from typing import Any

from grader.cli.formats import Format
from grader.files.tree import PassedOver
from grader.grading.report import GradedPackage, GradedSubmission, Report, Result
from grader.report.words import untold
from grader.source import Location, Source
from grader.text import printable
from tests.report.readers import read_as_github, read_commands, read_json, read_junit, read_markdown

Words = Callable[[], str]
# Words with very many backticks stand in Markdown as text instead of code, or as a block that is indented instead of fenced.
_ALIKE = {"code_inline": "text", "code_block": "fence"}


def recast(report: Report, words: Words) -> Report:
    """A report of the same results, in other words: messages, notes, problems, paths, names, lines that are quoted."""

    def path() -> str:
        return f"a{printable(words())}"

    problems = tuple(replace(each, message=words(), location=Location(path(), 2, 3)) for each in untold(report))
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
    text = "\n".join(f"<a b='{words()}'/>{words()}" for _ in range(3))
    return GradedSubmission(
        words(),
        path() if old.path is not None else None,
        old.sha256,
        GradedPackage(path() if old.package.folder else "", words()) if old.package is not None else None,
        tuple(PassedOver(path(), words()) for _ in old.passed_over),
        tuple(words() for _ in old.left_out),
        old.has_urdf,
        old.verdict,
        old.is_single,
        "unread" if old.unread else "",
        lambda path: Source(path, text),
    )


def _result(old: Result, words: Words, path: Words) -> Result:
    outcome = old.outcome
    where = Location(path(), 1, 2) if outcome.location is not None else None
    measured = f"found\n{words()}" if isinstance(outcome.measured, str) else outcome.measured
    return old._replace(outcome=outcome._replace(message=words(), measured=measured, location=where))


def structure(kind: Format, text: str) -> Any:
    """What a report is made of: its elements, its tokens, its keys, whatever the words in them are."""
    match kind:
        case Format.TERMINAL:
            return None
        case Format.MARKDOWN:
            kinds = [_ALIKE.get(token.type, token.type) for token in read_markdown(text)]
            tags = [tag for tag in _tags(read_as_github(text)) if tag != "code"]
            return [each for each, _ in groupby(kinds)], tags
        case Format.JUNIT:
            return _tags(read_junit(text))
        case Format.GITHUB:
            return [(each.name, [key for key, _ in each.properties]) for each in read_commands(text)]
        case _:
            return _shape(read_json(text))


def _tags(root: Any) -> list[str]:
    return [each.tag for each in root.iter()]


# A snippet is left out where it is long; of problems a report in other words has only those that nothing else tells.
_UNEQUAL = {"snippet", "problems"}


def _shape(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _shape(each) for key, each in value.items() if key not in _UNEQUAL}
    if isinstance(value, list) and all(isinstance(each, str) for each in value):
        return "lines"
    return [_shape(each) for each in value] if isinstance(value, list) else type(value).__name__
