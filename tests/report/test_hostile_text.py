"""Whatever a student writes, each format keeps its structure: no command, markup, link or escape comes through."""

import os
import tempfile
from collections.abc import Mapping
from functools import cache
from itertools import cycle, product
from pathlib import Path
from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.base.source import Base
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report
from grader.report.formats import Format, InspectFormat, render
from tests.command_line import run
from tests.examples import examples, spread
from tests.report.harmless import is_harmless
from tests.report.hostile import BREAKING, PIECES, SLOTS, TEXT, UNASKED, name_of, write_submission
from tests.report.readers import reader
from tests.report.reports import hinted
from tests.report.rewording import recast
from tests.report.workflow_commands import commands
from tests.samples import LAB6, SAMPLES, opened

pytestmark = pytest.mark.slow

TEXTS = st.dictionaries(st.sampled_from(SLOTS + BREAKING), TEXT, min_size=1, max_size=6)
EVERYWHERE = {slot: "".join(PIECES[::7]) for slot in SLOTS}
FENCES = {
    "answer": "`" * 300 + "\n![x](http://e.org/y.png)\n# h\n",
    "file": "`" * 90 + "![x](y)",
    "box": "`" * 90,
}


def harmless_structures(report: Report, base: Base) -> dict[Format, Any]:
    """Return the structure of every format for harmless text."""
    twin = recast(report, lambda: "words")
    return {kind: reader(kind).structure(render(twin, kind, base)) for kind in Format}


def assert_harmless(
    report: Report, base: Base, expected: Mapping[Format, Any] | None = None
) -> None:
    """Assert that every format is valid, harmless, and has the same structure as with harmless text."""
    expected = harmless_structures(report, base) if expected is None else expected
    is_harmless(render(report, Format.TERMINAL, base, verbose=True))
    for kind in Format:
        text = render(report, kind, base)
        is_harmless(text, kind)
        assert kind is Format.GITHUB or not commands(text)
        reader(kind).parse(text)
        assert reader(kind).structure(text) == expected[kind], kind


def written(texts: Mapping[str, str]) -> Report:
    """Return the report on a submission with these texts, from files on disk."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(
            os.fsdecode(os.path.join(os.fsencode(folder), name_of(texts.get("note", "x"))))
        )
        write_submission(target, texts)
        report = grade(LAB6, opened(target))
        assert not report.fault, [result.traceback for result in report.results if result.traceback]
        assert_harmless(report, Base(f"{target.name}/"))
        return report


def is_utf8(text: str) -> bool:
    """Return whether a launch file can read a URDF with this text; otherwise it stops, which costs its criterion."""
    return not any("\ud800" <= letter <= "\udfff" for letter in text)


@given(TEXTS)
@example(EVERYWHERE)
@example(FENCES)
@examples(10)
def test_text_of_a_submission_stays_text(texts: Mapping[str, str]) -> None:
    """Names of robots, links, joints, materials, files and folders, comments, answers, values and Python strings."""
    written(texts)


@given(st.dictionaries(st.sampled_from(UNASKED), TEXT.filter(is_utf8), min_size=1))
@examples(10)
def test_irrelevant_text_does_not_affect_the_score(texts: Mapping[str, str]) -> None:
    """The score is that of the reference, whatever its robot, a colour, or a file beside it is called."""
    assert written(texts).score == 90


@cache
def report_of(name: str) -> Report:
    """Return a sample's report, or one with hints."""
    return hinted() if name == "hints" else SAMPLES[name].grade()


@cache
def structures_of(name: str, base: Base) -> dict[Format, Any]:
    """Return the structure of a sample's report in every format."""
    return harmless_structures(report_of(name), base)


@pytest.mark.parametrize(
    ("name", "base"),
    spread(
        product(
            ("hints", "pictures-only", "setup-as-created", "smart-quotes", "reference"),
            (Base("a b/"), Base(), Base(archive="a.zip")),
        ),
        7,
    ),
)
@given(words=st.lists(TEXT, min_size=1, max_size=9))
@example(["`" * 90 + "![x](y)"])
@example(["    x"])
@examples(2)
def test_text_of_a_report_stays_text(name: str, base: Base, words: list[str]) -> None:
    """Also text that no file system and no XML can hold: NUL and lone surrogates, in every message, name and path."""
    following = cycle(words)
    assert_harmless(
        recast(report_of(name), lambda: next(following)), base, structures_of(name, base)
    )


def cli(*arguments: str, **variables: str) -> tuple[int, str, str]:
    """Run a command in this process; return its exit code, standard output and standard error."""
    done = run(arguments, **variables)
    return done.returncode, done.stdout.decode(), done.stderr.decode()


@given(TEXTS)
@example(EVERYWHERE)
@examples(5)
def test_output_in_a_job_is_harmless(texts: Mapping[str, str]) -> None:
    """Reports, warnings and inspections contain no command; standard error has annotations, and the summary is Markdown."""
    with tempfile.TemporaryDirectory() as folder:
        target = Path(
            os.fsdecode(os.path.join(os.fsencode(folder), name_of(texts.get("note", "x"))))
        )
        write_submission(target, texts)
        summary = Path(folder) / "summary"
        job = {
            "GITHUB_ACTIONS": "true",
            "GITHUB_WORKSPACE": folder,
            "GITHUB_STEP_SUMMARY": str(summary),
        }
        code, out, err = cli("grade", str(target), **job)
        assert code in (0, 1)
        is_harmless(out)
        is_harmless(err, Format.GITHUB)
        assert len(commands(err)) == err.count("\n")
        is_harmless(summary.read_text(encoding="utf-8"), Format.MARKDOWN)
        for command in ("grade", "inspect"):
            _, out, err = cli(command, str(target))
            is_harmless(out)
            is_harmless(err)
        for kind in (InspectFormat.JSON, InspectFormat.HTML):
            _, out, err = cli("inspect", str(target), "--format", kind)
            is_harmless(out)


@given(TEXT)
@example("##[error]x\n::error::y")
@examples(10)
def test_a_missing_path_is_escaped(text: str) -> None:
    """The message on standard error and in the summary names the path."""
    with tempfile.TemporaryDirectory() as folder:
        summary = Path(folder) / "summary"
        name = os.fsdecode(name_of(text))
        job = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(summary)}
        code, out, err = cli("grade", f"{folder}/{name}", **job)
        assert (code, out) == (2, "")
        is_harmless(err, Format.GITHUB)
        assert [command.get("title") for command in commands(err)] == ["Nothing was graded"]
        is_harmless(summary.read_text(encoding="utf-8"), Format.MARKDOWN)
