"""One submission, from what was typed to reports and an exit code."""

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from grader.cli.output import complain, emit, screen
from grader.errors import GraderError, InputError
from grader.report.formats import Format, needed, render
from grader.text import printable_path
from grader.usecases.github import base_of, on_github, tell_github
from grader.usecases.writing import ROBOTS, clear, is_same, refuse_links, save

if TYPE_CHECKING:
    from grader.grading.report import Report
    from grader.grading.rubric import Rubric
    from grader.report.places import Base

_NUMBER = re.compile(r"[0-9]{1,9}(?:\.[0-9]{1,9})?%?")
_MOST_PERCENT = 100
_SHA256 = re.compile(r"[0-9a-fA-F]{64}")


@dataclass(frozen=True, slots=True)
class Threshold:
    """The score from which on a run counts as passed: points, or percent of what can be earned."""

    value: Decimal
    is_percent: bool

    @classmethod
    def read(cls, text: str) -> "Threshold":
        """The threshold that `--fail-under` names, as 58.5 or 80%; raises GraderError."""
        if not _NUMBER.fullmatch(text) or (text.endswith("%") and Decimal(text[:-1]) > _MOST_PERCENT):
            raise GraderError(f"--fail-under takes points or a percentage such as 80%, not {text!r}")
        return cls(Decimal(text.removesuffix("%")), text.endswith("%"))

    def reached(self, score: Decimal, most: Decimal) -> bool:
        """Whether a score of so many points is enough."""
        return score * 100 >= self.value * most if self.is_percent else score >= self.value


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is to be graded and how it is reported."""

    path: str
    rubric: str
    expected_rubric: str | None
    parts: tuple[str, ...]
    format: Format
    saves: tuple[tuple[Format, Path], ...]
    fail_under: str | None
    max_size: int
    answers: bool = False

    @property
    def threshold(self) -> Threshold | None:
        """The score from which on the exit code is 0, if there is one; raises GraderError."""
        return Threshold.read(self.fail_under) if self.fail_under is not None else None


class Graded(NamedTuple):
    """A report, where its submission stands in a repository, and the exit code."""

    report: "Report"
    base: "Base"
    code: int


def read_saves(texts: Sequence[str]) -> tuple[tuple[Format, Path], ...]:
    """What `--save` names: formats and files; raises GraderError."""
    saves = tuple(map(_split_save, texts))
    files = [os.path.realpath(file) for _, file in saves if file.is_file() or not file.exists()]
    for _, file in saves:
        if files.count(os.path.realpath(file)) > 1:
            raise GraderError(f"--save names {file} twice, and one file cannot hold two reports")
    return saves


def _split_save(text: str) -> tuple[Format, Path]:
    kind, equals, file = text.partition("=")
    if kind not in list(Format) or not equals or file in ("", "-"):
        raise GraderError(f"--save takes FORMAT=FILE with one of the formats {', '.join(Format)}, not {text!r}")
    return Format(kind), Path(os.path.expanduser(file))  # noqa: PTH111  no shell does it behind `=`; this never raises


def grade_once(wanted: Wanted) -> tuple["Report", int]:
    """Grade, save and print the reports that are wanted; the report and the exit code. Raises GraderError."""
    modes = make_room(wanted)
    done = graded(wanted)
    save_reports(wanted, done, modes)
    text = render(done.report, wanted.format, done.base, screen())
    emit(text if wanted.format is Format.TERMINAL else text.encode("utf-8", "backslashreplace"))
    if not on_github():
        _complain_of_undecided(done)
    else:
        tell_github(done.report, done.base, annotate=wanted.format is not Format.GITHUB)
    return done.report, done.code


def graded(wanted: Wanted) -> Graded:
    """Grade what is wanted, and report nothing but faults of ours. Raises GraderError."""
    threshold = wanted.threshold  # refused before anything is graded
    from grader.grading.grade import grade
    from grader.submission.submission import open_submission
    from grader.text import printable

    for kind in (wanted.format, *(kind for kind, _ in wanted.saves)):
        needed(kind)  # refused before anything is graded
    rules = wanted_rubric(wanted)
    submission = open_submission(wanted.path, wanted=rules.urdf, package=rules.package, limit=wanted.max_size)
    report = grade(rules, submission, wanted.parts)
    for result in report.results:
        if result.traceback:
            complain(printable(f"{result.criterion.id}: {result.traceback.strip().splitlines()[-1]}"))
    base = base_of(wanted.path, is_single=submission.is_single)
    return Graded(report, base, _exit_code(report, threshold))


def _complain_of_undecided(done: Graded) -> None:
    """Say why the exit code is 1 though nothing failed: a report may not be what is looked at."""
    from grader.report.words import undecided
    from grader.text import printable

    left = [each.criterion.id for each in undecided(done.report)]
    if done.code == 1 and left and not done.report.counts("failed", "skipped"):
        complain(printable(f"exit code 1: could not be decided, and needs manual grading: {', '.join(left)}"))


def make_room(wanted: Wanted) -> dict[Path, int]:
    """Remove what an earlier run, or a student, has left where `--save` writes; return the permissions of these files.

    If the run is refused after that, no forged report is taken for its own. A robot stays: it may be what is graded. Raises
    InputError where a report would replace what is graded, or would be written through a symlink of the submission.
    """
    _refuse_graded(wanted, wanted.path, wanted.rubric)
    refusals: list[InputError] = []
    modes: dict[Path, int | None] = {}
    for _, file in wanted.saves:
        try:
            refuse_links(file, (wanted.path,))
        except InputError as error:  # the others are removed all the same
            refusals.append(error)
            continue
        if Path(os.path.realpath(file)).suffix.lower() not in ROBOTS:
            modes[file] = clear(file)
    if refusals:
        raise refusals[0]
    return {file: mode for file, mode in modes.items() if mode is not None}


def _refuse_graded(wanted: Wanted, *graded_from: str) -> None:
    for _, file in wanted.saves:
        if any(is_same(file, Path(each)) and Path(each).is_file() for each in graded_from):
            raise InputError(f"--save would replace {printable_path(file)}, which is graded: name another file")


def save_reports(wanted: Wanted, done: Graded, modes: Mapping[Path, int]) -> None:
    """Write the reports that `--save` names, with the permissions of the files that were there; raises InputError."""
    _refuse_graded(wanted, os.path.join(wanted.path, done.report.submission.path or ""))  # noqa: PTH118  names
    for kind, file in wanted.saves:
        save(file, render(done.report, kind, done.base), (wanted.path,), modes.get(file))


def wanted_rubric(wanted: Wanted) -> "Rubric":
    """The rubric, if it is the one that is expected and has the parts that are named; raises GraderError."""
    from grader.grading.answers import load_with_answers, missing_answers
    from grader.grading.rubric import load_rubric

    expected = wanted.expected_rubric
    if expected is not None and not _SHA256.fullmatch(expected):
        raise GraderError(
            f"--expect-rubric takes the 64 digits that `grader rubric show` prints as sha256, not {expected!r}"
        )
    rules = (load_with_answers if wanted.answers else load_rubric)(wanted.rubric)
    if wanted.answers and missing_answers(rules):
        complain(missing_answers(rules))
    if expected is not None and expected.lower() != rules.sha256:
        raise InputError(
            f"the rubric {rules.id} is not the one that is expected: its sha256 is {rules.sha256}, not {expected.lower()}"
        )
    for name in wanted.parts:
        rules.part(name)
    return rules


def _exit_code(report: "Report", threshold: Threshold | None) -> int:
    """3 for a faulty check; with a threshold, 0 exactly where the score reaches it; else 0 where a program decided that all passed.

    What a program normally decides but could not is not green without a threshold: a person has to look first.
    """
    from grader.report.words import undecided

    if report.counts("errored"):
        return 3
    if threshold is not None:
        return 0 if threshold.reached(report.score, report.max_score) else 1
    return 1 if report.counts("failed", "skipped") or undecided(report) else 0
