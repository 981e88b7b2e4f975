"""Every format contains the same facts, except those that its row of READERS excuses; the terminal shows all of them with `--verbose`."""

import json
import os
import re
from collections.abc import Iterator
from functools import cache
from typing import NamedTuple
from unittest.mock import patch

import pytest

from grader.base.text import format_points, printable
from grader.lab.grading.report import Report, Result
from grader.report.content import other_problems
from grader.report.criteria import is_absent, is_not_found
from grader.report.formats import Format, render
from tests.report.readers import READERS, read_commands
from tests.report.reports import adjusted
from tests.samples import REPORTED, SAMPLES

_ADJUSTED = "adjusted"  # no sample


class Fact(NamedTuple):
    """A fact that a format must contain, in one of several spellings; for a criterion or problem with its id or code."""

    kind: str
    spellings: tuple[str, ...]
    rule: str = ""


def facts(report: Report) -> Iterator[Fact]:
    """Yield all facts of a report."""
    for result in report.results:
        yield from _of_criterion(result, report)
    for problem in other_problems(report):
        message, line = printable(problem.message), problem.location.line
        paths = f"{problem.location.path}:{line}", f"line {line}: {message}"
        for spellings in ((problem.code,), (message,), paths):
            yield Fact("problem", spellings, problem.code)
    submission = report.submission
    yield from (Fact("note", (note,)) for note in report.notes)
    yield from (
        Fact("aside", (words,))
        for candidate in submission.unused_candidates
        for words in candidate[:2]
    )
    yield from (Fact("aside", (path,)) for path in submission.ignored)
    if submission.package is not None and any(
        report.rubric.part(part).needs == "package" for part in report.parts
    ):
        yield Fact("package", (submission.package.folder or submission.package.name,))
    score, most, is_pending = map(format_points, (report.score, report.max_score, report.pending))
    if report.pending:
        words = f"{is_pending} more need", f"{is_pending} points need", f'"pending":{is_pending},'
        yield Fact("waits", words)
    keys = ('"max_score":', '"max-score":', '"maxScore":')
    yield Fact(
        "score",
        (
            f"{score} of {format_points(report.max_score - report.pending)} points",
            f"{score}/{most} points",
            f"{score}/{most}  {report.rubric.title}",
            f'"score":{score},"output',
            *(f'"score":{score},{key}{most}' for key in keys),
        ),
    )
    yield Fact("rubric", (report.rubric.sha256,))
    yield Fact("version", (f"grader {report.version}", f'"version":"{report.version}"'))


def _of_criterion(result: Result, report: Report) -> Iterator[Fact]:
    criterion, outcome = result.criterion, result.outcome
    name, status = criterion.id, outcome.status
    if criterion.bonus:
        earned, most = format_points(result.points), format_points(criterion.points)
        keys = (
            f'"points":{earned},"max_points":{most},',
            f'"points":{earned},"maxPoints":{most},"bonus":true',
        )
        yield Fact(
            "earned bonus" if result.points else "bonus",
            (f"{earned}/{most} bonus", f'"score":{earned},"status"', *keys),
            name,
        )
    if result.comment is not None:
        words = " ".join(result.comment.text.split())
        yield Fact(
            "comment",
            (f"Comment by Ada: {words}", f'"text":{json.dumps(result.comment.text)},"by":"Ada"'),
            name,
        )
    if criterion.adjustment is not None:
        yield Fact("title", (criterion.title, name), name)
        reason = json.dumps(criterion.adjustment.reason)
        yield Fact("adjustment", (f"{result.why_given}.", f'"reason":{reason}'), name)
        return
    if status == "passed":
        return
    cause = next((one for one in report.results if one.criterion.id == result.because), result)
    if is_absent(result) or is_absent(cause):  # one line for each thing
        absent = (result if is_absent(result) else cause).outcome.absent
        yield from (
            Fact("unbuilt", (thing, outcome.message, f'"because":"{result.because}"'), name)
            for thing in absent
        )
        return
    if is_not_found(result):
        wanted, message = str(outcome.expected), printable(outcome.message)
        yield Fact("looked for", (wanted, wanted.replace("`", ""), message), name)
        return
    is_open = status in ("skipped", "pending")
    yield Fact(f"title of {status}" if is_open else "title", (criterion.title, name), name)
    if status == "skipped":
        yield Fact("because", (f"{result.because} failed", f'"because":"{result.because}"'), name)
        return
    if result.carried:
        yield Fact(
            "carried", (f"only because of {result.carried}", f'"carried":"{result.carried}"'), name
        )
        return
    message = printable(outcome.message)
    yield Fact(
        "message of pending" if is_open else "message", (message, message.replace("`", "")), name
    )
    if is_open and isinstance(outcome.measured, str):
        lines = (line for line in map(printable, outcome.measured.splitlines()) if line.strip())
        yield from (
            Fact("found", (line, line.lstrip("# ").replace("`", "")), name) for line in lines
        )
    if status == "failed" and outcome.location is not None:
        yield Fact("place", (f"{outcome.location.path}:{outcome.location.line}",), name)
    if (
        status == "failed"
        and result.hint is None
        and (report.submission.has_urdf or criterion.check.subject not in ("urdf", "robot"))
    ):
        feedback = criterion.feedback_on(outcome)
        yield Fact("feedback", (feedback, feedback.replace("`", "")), name)


def _plain(text: str) -> str:
    """Return a text without white space, capitals, and characters that prevent mentions or end sentences."""
    return re.sub(r"[\s\u2060]+|\.$", "", text).casefold()


def missing_from(kind: Format, report: Report) -> Iterator[Fact]:
    """Yield the facts that a format omits.

    GitHub shows at most ten annotations of a type; the last one names the others.
    """
    with patch.dict(os.environ, {"COLUMNS": "500"}):
        text = render(report, kind, verbose=True)
    shown = _plain(READERS[kind].text(text))
    reported = read_commands(text) if kind is Format.GITHUB else []
    named = {
        line
        for command in reported
        for line in command.data.partition("See the report for:")[2].split("\n")
    } - {""}
    for fact in facts(report):
        if fact.rule not in named and not any(
            _plain(spelling) in shown for spelling in fact.spellings
        ):
            yield fact


@cache
def omitted(name: str) -> frozenset[tuple[Format, Fact]]:
    """Return the facts of a sample's report that the formats omit."""
    report = adjusted() if name == _ADJUSTED else SAMPLES[name].grade()
    return frozenset((kind, fact) for kind in READERS for fact in missing_from(kind, report))


@pytest.mark.parametrize("name", [*REPORTED, _ADJUSTED])
def test_all_formats_contain_the_same_facts(name: str) -> None:
    """For each criterion its title, message, location and feedback; for the submission all of its facts."""
    assert not {
        (kind.value, fact) for kind, fact in omitted(name) if fact.kind not in READERS[kind].excused
    }


@pytest.mark.slow
def test_every_excuse_is_needed() -> None:
    """A format that contains a fact needs no excuse for it."""
    found = frozenset().union(*map(omitted, [*REPORTED, _ADJUSTED]))
    for kind, read in READERS.items():
        assert set(read.excused) == {fact.kind for format_, fact in found if format_ is kind}
