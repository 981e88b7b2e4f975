"""The gradebook: one file in which no result and no mark is ever lost, and the current grade is a view."""

import shutil
import sqlite3
import threading
from collections.abc import Iterator
from contextlib import closing, suppress
from decimal import Decimal
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook import connection
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.schema import APPLICATION_ID, VERSION
from grader.classroom.gradebook.views import VIEWS
from grader.errors import InputError
from grader.grading.rubric import Rubric
from tests.classroom.gradebooks import graded_as, grader, lab, mark, record_run, refusal, units, urdf
from tests.examples import examples

LABS = (lab(), lab(loads="2", box="5", essay="1.2345"), lab(extra="7.5"), lab(picture="0"))
STUDENTS = ("anna", "ben", "cleo")
NAMES = ("loads", "box", "tall", "essay", "picture", "extra")


@pytest.fixture
def book(tmp_path: Path) -> Iterator[Gradebook]:
    """Yield a gradebook with one submission and one mark."""
    with Gradebook(tmp_path / "book.db", create=True) as opened:
        record_run(opened, LABS[0], [graded_as(LABS[0], "anna", "pps??")])
        put(opened, "anna", "essay", Decimal(3), "good")
        yield opened


def put(book: Gradebook, key: str, name: str, points: Decimal | None, why: str = "") -> None:
    """Mark a criterion manually."""
    standings = Grades(book)
    standing = standings.find(key)
    criterion = next(criterion for criterion in standings.rubric(standing.rubric).criteria if criterion.id == name)
    mark(book, standing, criterion, points, "me", why)


def all_of(book: Gradebook, table: str) -> list[tuple[Any, ...]]:
    """Return all rows of a table, the oldest first."""
    return list(book.rows(f"SELECT * FROM {table} ORDER BY id"))


def test_a_new_file(book: Gradebook) -> None:
    """A new gradebook has a write-ahead log, foreign keys, a schema version and an application id."""
    settings_of = {
        name: next(book.rows(f"PRAGMA {name}"))[0]
        for name in ("journal_mode", "foreign_keys", "user_version", "application_id")
    }
    assert settings_of == {
        "journal_mode": "wal",
        "foreign_keys": 1,
        "user_version": VERSION,
        "application_id": APPLICATION_ID,
    }
    with pytest.raises(InputError, match="FOREIGN KEY"), book.input_errors():
        book.connection.execute("INSERT INTO mark VALUES (9, 99, 'essay', 1, '', '', '', 99, '', 'points')")


@pytest.mark.parametrize(
    "statement",
    [
        "UPDATE mark SET points = 40000",
        "UPDATE mark SET comment = ''",
        "DELETE FROM mark",
        "INSERT OR REPLACE INTO mark SELECT id, student, criterion, 0, '', '', '', result, '', 'points' FROM mark",
        "REPLACE INTO mark SELECT * FROM mark",
        "UPDATE result SET score = 0",
        "DELETE FROM result",
        "INSERT OR REPLACE INTO result SELECT * FROM result",
        "DELETE FROM student",
    ],
)
def test_marks_and_results_cannot_be_changed(book: Gradebook, statement: str) -> None:
    """SQLite itself refuses to change or delete a mark or a result, from any program."""
    before = all_of(book, "mark"), all_of(book, "result")
    with closing(sqlite3.connect(book.path)) as other:
        other.execute("PRAGMA foreign_keys = ON")
        with pytest.raises(sqlite3.IntegrityError):
            other.execute(statement)
    assert (all_of(book, "mark"), all_of(book, "result")) == before


# --- The current grade ------------------------------------------------------------------------------------------------

STATUS_LETTERS = st.text("pfs?!-", min_size=6, max_size=6)
RUN = st.tuples(
    st.just("run"),
    st.integers(0, len(LABS) - 1),
    st.dictionaries(
        st.sampled_from(STUDENTS), st.tuples(STATUS_LETTERS, st.sampled_from("ab"), st.sampled_from(["", "broken"]))
    ),
)
MARK = st.tuples(
    st.just("mark"),
    st.sampled_from(STUDENTS),
    st.sampled_from(NAMES),
    st.one_of(st.none(), st.integers(0, 12_345), st.just(10**9)),
)


class Model:
    """A plain model of the gradebook, for comparison."""

    def __init__(self) -> None:
        self.results: dict[str, tuple[Rubric, str, str]] = {}
        self.marks: dict[tuple[str, str], int] = {}

    def grade(self, key: str) -> tuple[int, int, int, int]:
        """Return score, maximum, pending points and errors."""
        rubric, signs, _ = self.results[key]
        score = out_of = pending = faults = 0
        for criterion, sign in zip(rubric.criteria, signs, strict=True):
            manual = self.marks.get((key, criterion.id))
            worth = units(criterion.points)
            score += manual if manual is not None else worth * (sign == "p")
            out_of += worth * (sign != "-" or manual is not None)
            pending += worth * (sign == "?" and manual is None)
            faults += sign == "!" and manual is None
        return score, out_of, pending, faults


@examples(30)
@given(st.lists(st.one_of(RUN, MARK, MARK), min_size=2, max_size=14))
def test_the_view_is_the_sum_over_the_report(steps: list[tuple[Any, ...]]) -> None:
    """View, standing, report and model agree after any runs, changes of submissions and rubrics, and marks."""
    model = Model()
    with TemporaryDirectory() as folder, Gradebook(Path(folder, "book.db"), create=True) as book:
        kept: list[list[tuple[Any, ...]]] = [[], []]
        for step in steps:
            play(book, model, step)
            now = [all_of(book, "mark"), all_of(book, "result")]
            for before, after in zip(kept, now, strict=True):
                assert after[: len(before)] == before  # no earlier row is changed or removed
            kept = now
        check(book, model)


def play(book: Gradebook, model: Model, step: tuple[Any, ...]) -> None:
    """Apply one step to the gradebook and to the model."""
    match step:
        case ("run", index, found):
            rubric = LABS[index]
            count = len(rubric.criteria)
            record_run(
                book,
                rubric,
                [graded_as(rubric, key, signs[:count], digest, why) for key, (signs, digest, why) in found.items()],
            )
            model.results |= {key: (rubric, signs[:count], digest) for key, (signs, digest, _) in found.items()}
        case ("mark", key, name, points):
            names = [criterion.id for criterion in model.results[key][0].criteria] if key in model.results else []
            if name in names:
                put(book, key, name, None if points is None else Decimal(points) / 10_000)
                if points is None:
                    model.marks.pop((key, name), None)
                else:
                    model.marks[key, name] = points


def check(book: Gradebook, model: Model) -> None:
    """Compare everyone's grade, queried in four ways."""
    standings = Grades(book)
    assert {standing.student.key for standing in standings.all()} == model.results.keys()
    for key in model.results:
        expected = model.grade(key)
        ((score, out_of, pending, faults),) = book.rows(
            "SELECT score, out_of, pending, faults FROM grade WHERE key = ?", key
        )
        assert (score, out_of, pending, faults) == expected
        standing = standings.find(key)
        assert (*map(units, (standing.score, standing.out_of, standing.pending)), standing.faults) == expected
        report = standings.report(standing)
        open_faults = sum(
            result.outcome.status == "errored" and result.manual_mark is None for result in report.results
        )
        assert (*map(units, (report.score, report.max_score, report.pending)), open_faults) == expected
        decided = {result.criterion.id: result.points for result in report.results if is_decided(result)}
        assert standings.points(standing) == decided


def is_decided(result: Any) -> bool:
    """Return whether a check or a mark has decided the points of a criterion."""
    return result.manual_mark is not None or result.outcome.status in ("passed", "failed", "skipped")


# --- Versions ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("version", [0, VERSION + 1, 7])
def test_another_version_is_refused(book: Gradebook, version: int) -> None:
    """A grader opens gradebooks of one version only, and leaves another file as it is."""
    book.connection.execute(f"PRAGMA user_version = {version}")
    book.close()
    before = book.path.read_bytes()
    why = f"is a gradebook of version {version}, and this grader reads version {VERSION}: use the grader that made it"
    assert why in refusal(grader("stats", "--gradebook", book.path))
    assert book.path.read_bytes() == before


def test_a_failed_creation_leaves_no_trace(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """If a statement fails, the file has no tables, and the next command creates them."""
    with monkeypatch.context() as patched:
        patched.setattr(connection, "VIEWS", f"{VIEWS}\nINSERT INTO nowhere VALUES (1);\n")
        with pytest.raises(InputError, match="no such table: nowhere"):
            Gradebook(tmp_path / "new.db", create=True)
    with Gradebook(tmp_path / "new.db", create=True) as again:
        assert next(again.rows("PRAGMA user_version")) == (VERSION,)


def test_concurrent_creation_of_a_gradebook(tmp_path: Path) -> None:
    """All but the first find the gradebook already made."""
    failed: list[Exception] = []
    start = threading.Barrier(8)

    def make() -> None:
        start.wait()
        try:
            Gradebook(tmp_path / "book.db", create=True).close()
        except Exception as error:  # noqa: BLE001
            failed.append(error)

    threads = [threading.Thread(target=make) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert failed == []


# --- What is no gradebook ---------------------------------------------------------------------------------------------


def spoil(kind: str, path: Path) -> None:
    """Put something other than a gradebook at a path."""
    match kind:
        case "none":
            return
        case "text":
            path.write_text("id,name\n" * 100)
        case "folder":
            path.mkdir()
        case "of-others":
            with closing(sqlite3.connect(path)) as made, made:
                made.execute("CREATE TABLE mark (x)")
        case "newer":
            Gradebook(path, create=True).close()
            with closing(sqlite3.connect(path)) as made, made:
                made.execute("PRAGMA user_version = 1000")
        case "hollow":
            with closing(sqlite3.connect(path)) as made, made:
                made.execute(f"PRAGMA application_id = {APPLICATION_ID}")
                made.execute(f"PRAGMA user_version = {VERSION}")
                made.execute("CREATE TABLE mark (x)")
        case "damaged":
            with Gradebook(path, create=True) as book:
                record_run(book, LABS[0], [graded_as(LABS[0], f"s{number}", "pps??") for number in range(200)])
            data = bytearray(path.read_bytes())
            data[4096:] = b"\xa5" * (len(data) - 4096)
            path.write_bytes(data)


WHY = {
    "none": "there is no gradebook",
    "text": "file is not a database",
    "folder": "unable to open database file",
    "of-others": "is a database, but not a gradebook",
    "newer": "is a gradebook of version 1000",
    "hollow": "is not what the grader has made",
    "damaged": "malformed",
}
WRONG = {"TEXT": b"text", "BLOB": "text", "INTEGER": "x", "REAL": "x"}  # what SQLite stores in a column of each type
COMMANDS = {
    "mark": ("mark", "anna", "essay", "1", "--gradebook"),
    "review": ("review", "--gradebook"),
    "csv": ("export", "csv", "--gradebook"),
    "json": ("export", "json", "--gradebook"),
    "stats": ("stats", "--gradebook"),
    "diff": ("diff",),
}


@pytest.mark.parametrize("kind", WHY)
def test_other_files_are_refused_in_one_line(kind: str, tmp_path: Path) -> None:
    """A file that is no gradebook is not changed."""
    path = tmp_path / "book.db"
    spoil(kind, path)
    before = path.read_bytes() if path.is_file() else None
    commands = COMMANDS if kind == "damaged" else {name: COMMANDS[name] for name in ("mark", "diff")}
    for command in commands.values():
        assert WHY[kind] in refusal(grader(*command, path))
    (tmp_path / "class").mkdir()
    (tmp_path / "class/ash.urdf").write_text(urdf())
    if kind != "none":
        done = grader("batch", tmp_path / "class", "--gradebook", path)
        assert (done.returncode, done.stdout, WHY[kind] in done.stderr) == (2, "", True), done.stderr
    if kind in ("text", "of-others", "newer"):
        assert path.read_bytes() == before


def tampered(path: Path, statement: str, *values: object) -> Path:
    """Return a copy of a gradebook in which a statement has changed something that no trigger and no CHECK allows."""
    copy = path.with_name("tampered.db")
    shutil.copy(path, copy)
    with closing(sqlite3.connect(copy)) as made, made:
        triggers = made.execute("SELECT name, sql FROM sqlite_master WHERE type = 'trigger'").fetchall()
        for name, _ in triggers:
            made.execute(f"DROP TRIGGER {name}")
        made.execute("PRAGMA ignore_check_constraints = ON")
        assert made.execute(statement, values).rowcount > 0, statement
        for _, definition in triggers:
            made.execute(definition)
    return copy


def test_a_value_of_another_type_is_found(book: Gradebook) -> None:
    """In every column that has a value: SQLite stores whatever it is given."""
    tables = [name for (name,) in book.rows("SELECT name FROM sqlite_master WHERE type = 'table'")]
    columns = [
        (table, name, WRONG[kind])
        for table in tables
        if book.first(f"SELECT 1 FROM {table}")
        for _, name, kind, *_ in book.rows(f"PRAGMA table_info({table})")
        if name != "id"  # SQLite itself refuses another type there
    ]
    assert len(columns) > 60
    triggers = [name for (name,) in book.rows("SELECT name FROM sqlite_master WHERE type = 'trigger'")]
    for pragma in ("foreign_keys = OFF", "ignore_check_constraints = ON"):
        book.connection.execute(f"PRAGMA {pragma}")
    for table, name, value in columns:
        with suppress(ZeroDivisionError), book.transaction():
            for trigger in triggers:
                book.connection.execute(f"DROP TRIGGER {trigger}")
            book.connection.execute(f"UPDATE OR REPLACE {table} SET {name} = ?", (value,))
            with pytest.raises(InputError, match="is damaged"):
                book.check_undamaged()
            raise ZeroDivisionError  # undo
    book.check_undamaged()


@pytest.mark.parametrize(
    ("statement", "why"),
    [
        ("UPDATE result SET record = x'00'", "is damaged: the record 1 cannot be read"),
        ("UPDATE result SET record = substr(record, 1, length(record) - 9)", "is damaged: the record 1 cannot be read"),
        ("UPDATE student SET name = CAST(x'ff' AS TEXT)", "Could not decode to UTF-8 column"),
        ("UPDATE rubric SET text = x'ff'", "is not UTF-8"),
        ("UPDATE submission SET files = '5'", "is damaged: submission has a value that the grader does not write"),
        ("UPDATE student SET days_late = 9e999", "is damaged: student has a value that the grader does not write"),
    ],
)
def test_a_damaged_value_is_one_line(book: Gradebook, statement: str, why: str) -> None:
    """Whatever error it leads to."""
    book.close()
    assert why in refusal(grader("export", "json", "--gradebook", tampered(book.path, statement)))
