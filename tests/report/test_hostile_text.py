"""Whatever a student writes, each format stays what it is: no command, no markup, no link, no escape comes through."""

import io
import os
import tempfile
from collections.abc import Mapping
from contextlib import redirect_stderr, redirect_stdout
from functools import cache
from itertools import cycle
from pathlib import Path
from typing import Any
from unittest.mock import patch

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from grader.cli.app import run
from grader.grading.grade import grade
from grader.grading.report import Report
from grader.report.formats import Format, render
from grader.report.locations import Base
from grader.submission.submission import read_submission
from tests.report.hostile import BREAKING, PIECES, SLOTS, TEXT, UNASKED, name_of, write_submission
from tests.report.readers import reader
from tests.report.recast import recast
from tests.report.workflow_commands import commands
from tests.robot.edge_cases import EDGE_CASES
from tests.samples import LAB6, SAMPLES, opened

ANNOTATIONS = {"error", "warning", "notice"}
PROPERTIES = {"file", "line", "endLine", "col", "endColumn", "title"}
TEXTS = st.dictionaries(st.sampled_from(SLOTS + BREAKING), TEXT, min_size=1, max_size=6)
EVERYWHERE = {slot: "".join(PIECES[::7]) for slot in SLOTS}
FENCES = {"answer": "`" * 300 + "\n![x](http://e.org/y.png)\n# h\n", "file": "`" * 90 + "![x](y)", "box": "`" * 90}


def is_harmless(text: str, kind: Format | None = None) -> None:
    """UTF-8, all of it visible, and of GitHub's commands none but annotations, which only their own format holds."""
    text.encode()
    unseen = {character for character in text if not character.isprintable()} - {"\n"}
    assert unseen <= ({"\u2060"} if kind is Format.MARKDOWN else set())  # it keeps mentions from being found
    found = commands(text) if kind is not Format.MARKDOWN else []
    assert kind is Format.GITHUB or not found
    assert {command.name for command in found} <= ANNOTATIONS
    for command in found:
        keys = [key for key, _ in command.properties]
        assert set(keys) <= PROPERTIES
        assert len(set(keys)) == len(keys)


def pieces(report: Report, base: Base) -> dict[Format, Any]:
    """What every format is made of where all words are harmless."""
    twin = recast(report, lambda: "words")
    return {kind: reader(kind).structure(render(twin, kind, base)) for kind in Format}


def holds(report: Report, base: Base, wanted: Mapping[Format, Any] | None = None) -> None:
    """Every format is valid, harmless, and made of the same pieces as with harmless words."""
    wanted = pieces(report, base) if wanted is None else wanted
    for kind in Format:
        text = render(report, kind, base)
        is_harmless(text, kind)
        assert kind is Format.GITHUB or not commands(text)
        reader(kind).parse(text)
        assert reader(kind).structure(text) == wanted[kind], kind


def written(texts: Mapping[str, str]) -> Report:
    """The report on a hand-in with these texts, from files on disk."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(os.fsdecode(os.path.join(os.fsencode(folder), name_of(texts.get("note", "x")))))
        write_submission(place, texts)
        report = grade(LAB6, opened(place))
        assert not report.counts("errored"), [result.traceback for result in report.results if result.traceback]
        holds(report, Base(f"{place.name}/"))
        return report


@pytest.mark.slow
@given(TEXTS)
@example(EVERYWHERE)
@example(FENCES)
@settings(max_examples=100)
def test_of_a_hand_in_only_words_come_through(texts: Mapping[str, str]) -> None:
    """Names of robots, links, joints, materials, files and folders, comments, answers, values and strings in Python."""
    written(texts)


@given(st.dictionaries(st.sampled_from(UNASKED), TEXT, min_size=1))
@settings(max_examples=40)
def test_words_that_nobody_asks_for_cost_nothing(texts: Mapping[str, str]) -> None:
    """The score is that of the reference, whatever its robot, a colour, or a file beside it is called."""
    assert written(texts).score == 90


def test_of_a_broken_file_only_words_come_through() -> None:
    """Whatever ROS 2 makes of a URDF: some of those that its reader is held against."""
    for case in EDGE_CASES[::40]:
        if len(case.text) < 20_000:
            holds(grade(LAB6, read_submission(case.text, identity=case.name, path="a.urdf")), Base())


@cache
def report_of(name: str) -> Report:
    """A sample's report."""
    return SAMPLES[name].grade()


@cache
def pieces_of(name: str, base: Base) -> dict[Format, Any]:
    """What a sample's report is made of."""
    return pieces(report_of(name), base)


@pytest.mark.parametrize("base", [Base(), Base("a b/"), Base(archive="a.zip")], ids=["folder", "below", "archive"])
@pytest.mark.parametrize("name", ["several-mistakes", "pictures-only", "setup-as-created", "smart-quotes", "reference"])
@given(words=st.lists(TEXT, min_size=1, max_size=9))
@example(["`" * 90 + "![x](y)"])
@settings(max_examples=15)
def test_of_a_report_only_words_come_through(name: str, base: Base, words: list[str]) -> None:
    """Also what no file system and no XML can carry: NUL, halves of surrogate pairs, in every message, name and path."""
    following = cycle(words)
    holds(recast(report_of(name), lambda: next(following)), base, pieces_of(name, base))


def cli(*arguments: str, **variables: str) -> tuple[int, str, str]:
    """Run a command in this process: its exit code, and what it has written to standard output and error."""
    out, err = (io.TextIOWrapper(io.BytesIO(), "utf-8", "backslashreplace", newline="\n") for _ in range(2))
    with patch.dict(os.environ, variables), redirect_stdout(out), redirect_stderr(err):
        code = run(arguments)
    found = []
    for stream in (out, err):
        stream.flush()
        buffer = stream.buffer
        assert isinstance(buffer, io.BytesIO)
        found.append(buffer.getvalue().decode())
    return code, found[0], found[1]


@given(TEXTS)
@example(EVERYWHERE)
@settings(max_examples=60)
def test_what_is_printed_in_a_job_is_harmless(texts: Mapping[str, str]) -> None:
    """Reports, warnings and inspections hold no command; standard error holds annotations, and the summary is Markdown."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(os.fsdecode(os.path.join(os.fsencode(folder), name_of(texts.get("note", "x")))))
        write_submission(place, texts)
        summary = Path(folder) / "summary"
        job = {"GITHUB_ACTIONS": "true", "GITHUB_WORKSPACE": folder, "GITHUB_STEP_SUMMARY": str(summary)}
        code, out, err = cli("grade", str(place), **job)
        assert code in (0, 1)
        is_harmless(out)
        is_harmless(err, Format.GITHUB)
        assert len(commands(err)) == err.count("\n")
        is_harmless(summary.read_text(encoding="utf-8"), Format.MARKDOWN)
        for command in ("grade", "inspect"):
            _, out, err = cli(command, str(place))
            is_harmless(out)
            is_harmless(err)
        _, out, err = cli("inspect", str(place), "--format", "json")
        is_harmless(out)


@given(TEXT)
@example("##[error]x\n::error::y")
@settings(max_examples=60)
def test_a_path_that_is_not_there_is_told_harmlessly(text: str) -> None:
    """The reason why nothing was graded names it, on standard error and in the summary."""
    with tempfile.TemporaryDirectory() as folder:
        summary = Path(folder) / "summary"
        name = os.fsdecode(name_of(text))
        job = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(summary)}
        code, out, err = cli("grade", f"{folder}/{name}", **job)
        assert (code, out) == (2, "")
        is_harmless(err, Format.GITHUB)
        assert [command.get("title") for command in commands(err)] == ["Nothing was graded"]
        is_harmless(summary.read_text(encoding="utf-8"), Format.MARKDOWN)
