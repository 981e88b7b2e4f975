"""The lines of results: what is written is read, whatever the end of the file; the newest line of a student counts."""

import errno
from collections.abc import Iterator
from pathlib import Path
from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import GraderError, InputError, MachineError
from grader.classroom.results.results import (
    Results,
    ResultsWriter,
    Run,
    StoredCriterion,
    StoredResult,
)
from tests.examples import examples

TEXT = st.text(st.characters(codec="utf-8"), max_size=8)
ENTRIES = st.dictionaries(
    TEXT, st.tuples(st.none() | st.sampled_from([0, 1, 2.5]), TEXT, TEXT, TEXT), max_size=2
)
GRADED = st.builds(
    StoredResult,
    TEXT,
    st.integers(1, 3),
    st.sampled_from(["graded", "unreadable", "errored"]),
    TEXT,
    TEXT,
    TEXT,
    paths=st.lists(TEXT, max_size=2).map(tuple),
    is_late=st.booleans(),
    results=ENTRIES,
    person=st.dictionaries(st.sampled_from(["name", "canvas"]), TEXT),
    work=st.just({}),
    answers=st.dictionaries(TEXT, TEXT),
    texts=st.dictionaries(TEXT, TEXT, max_size=2),
    written=st.dictionaries(TEXT, TEXT, max_size=2),
    timeout=st.sampled_from([0, 2.5]),
)
pytestmark = pytest.mark.usefixtures("unsynced")
RUN = Run(
    1, "2026-11-23T15:00:00.000+00:00", "1.0.0", "rubric", "context", {"ann": "3", "ben": None}
)


@pytest.fixture(scope="module")
def unsynced() -> Iterator[None]:
    """Leave it to the system when it writes to the disk."""
    with patch("os.fsync", bool):
        yield


def plain(one: StoredResult) -> StoredResult:
    """Return a result with lists in place of tuples, as JSON has them."""
    return one._replace(results={name: (*entry,) for name, entry in one.results.items()})


@pytest.mark.slow
@given(st.lists(GRADED, max_size=6))
@examples(30)
def test_the_newest_line_of_each_student_is_read(
    tmp_path_factory: pytest.TempPathFactory, lines: list[StoredResult]
) -> None:
    """Results are read as they were written, in the order of the keys."""
    file = tmp_path_factory.mktemp("results") / "results.jsonl"
    with ResultsWriter(file, 0) as writer:
        writer.append(*(one.line for one in lines))
    newest = {one.student: one for one in lines}
    found = Results(file)
    assert list(map(plain, found.all())) == [
        newest[key]._replace(texts={}, written={}) for key in sorted(newest)
    ]
    assert all(found.of(key) is not None for key in newest)
    for (
        one
    ) in newest.values():  # texts of an earlier result count as long as the submission is the same
        assert not one.texts or found.texts(one) == one.texts
        assert not one.written or found.written_answers(one) == one.written
        assert found.texts(one._replace(digest=f"{one.digest} ")) == {}
    assert found.of("\x00nobody") is None


@pytest.mark.parametrize(
    ("number", "kind"), [(errno.EIO, MachineError), (errno.EACCES, InputError)]
)
def test_results_that_can_no_longer_be_read(
    number: int, kind: type[GraderError], tmp_path: Path
) -> None:
    """A line has one message, whether the disk or the file is the cause."""
    with ResultsWriter(tmp_path / "results.jsonl", 0) as writer:
        writer.append(StoredResult("ann", 1, "graded", "d1").line)
    found, refused = Results(tmp_path / "results.jsonl"), OSError(number, "why")
    with (
        patch.object(Path, "open", side_effect=refused),
        pytest.raises(kind, match=r"^cannot read .*: why"),
    ):
        found.of("ann")


def test_a_torn_last_line_is_ignored_and_cut(tmp_path: Path) -> None:
    """Of every prefix of the file the whole lines count, and the next line is written behind them."""
    lines = [
        StoredResult("ann", 1, "graded", "d1").line,
        StoredResult("ben", 1, "graded", "d2").line,
        RUN.line,
    ]
    whole = b"".join(lines)
    ends = [sum(map(len, lines[:number])) for number in range(len(lines) + 1)]
    file = tmp_path / "results.jsonl"
    for end in range(len(whole) + 1):
        file.write_bytes(whole[:end])
        found = Results(file)
        kept = max(number for number, place in enumerate(ends) if place <= end)
        assert found.end == ends[kept]
        assert (len(found.students), len(found.runs)) == (min(kept, 2), int(kept == 3))
        with ResultsWriter(file, found.end) as writer:
            writer.append(StoredResult("cid", 1, "graded").line)
        assert Results(file).students == [*["ann", "ben"][: min(kept, 2)], "cid"]


@given(
    st.integers(0, 4),
    st.sampled_from(["lost", "cut", "hole", "changed"]),
    st.integers(1, 2000),
    st.booleans(),
)
@examples(60)
def test_no_damage_brings_back_an_older_result(
    tmp_path_factory: pytest.TempPathFactory, number: int, damage: str, place: int, is_stopped: bool
) -> None:
    """Whatever line is damaged or lost, each student has the newest result or none, and a run that may be lost is refused."""
    first, second = StoredResult("ann", 1, "graded", "d1"), StoredResult("ben", 1, "graded", "d2")
    run = RUN._replace(written=["ann", "ben"])
    newest = {"ann": StoredResult("ann", 2, "graded", "d3"), "ben": second}
    after = [] if is_stopped else [RUN._replace(run=2, written=["ann"]).line]
    lines = [first.line, second.line, run.line, newest["ann"].line, *after]
    file = tmp_path_factory.mktemp("damaged") / "results.jsonl"
    number %= len(lines)
    line = lines[number]
    at = place % (len(line) - 2)  # a hole leaves the line break: else two lines are damaged
    changed = b"#" if line[at : at + 1] != b"#" else b"+"
    lines[number] = {
        "lost": b"",
        "cut": line[:at] + b"\n",
        "hole": line[:at] + b"\0\0" + line[at + 2 :],
        "changed": line[:at] + changed + line[at + 1 :],
    }[damage]
    file.write_bytes(b"".join(lines))
    found = Results(file)
    assert bool(found.damage) == (damage != "lost")
    if number == 2 or number == len(lines) - 1:  # a run, or what may be one
        if damage != "lost" and number == len(lines) - 1:
            with pytest.raises(InputError, match=f"line {number + 1} of .* cannot be read"):
                found.check_newest()
        return
    found.check_newest()
    for key, one in newest.items():
        assert found.of(key) == (None if number == {"ann": 3, "ben": 1}[key] else one)


def test_an_earlier_run_can_be_read(tmp_path: Path) -> None:
    """Up to a run, later lines do not count."""
    file = tmp_path / "results.jsonl"
    second = RUN._replace(run=2)
    lines = [
        StoredResult("ann", 1, "graded", "d1"),
        RUN,
        StoredResult("ann", 2, "graded", "d2"),
        second,
    ]
    file.write_bytes(b"".join(one.line for one in lines))  # type: ignore[attr-defined]
    first, now = Results(file, 1), Results(file)
    assert [one.digest for one in first.all()] == ["d1"]
    assert [one.digest for one in now.all()] == ["d2"]
    assert (first.runs, now.runs, now.next_run) == ([RUN], [RUN._replace(totals={}), second], 3)


def test_a_full_line_is_small() -> None:
    """A submission with fifty criteria has less than 4 KB."""
    results: dict[str, StoredCriterion] = {
        f"right-wheel-forward-{number}": (2.5, "passed", "", "") for number in range(50)
    }
    assert len(StoredResult("student-12345", 1, "graded", results=results).line) < 4096
