"""Two graders mark at once, in one gradebook or in copies that they merge: no entry is lost, and every grade is that of a plain model."""

import os
import shutil
from contextlib import suppress
from copy import deepcopy
from datetime import UTC, datetime, timedelta, tzinfo
from decimal import Decimal
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from unittest.mock import patch

import pytest
from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, invariant, rule, run_state_machine_as_test

from grader.classroom.gradebook import marks
from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.manual_queue import ReviewScope
from grader.classroom.gradebook.marks import NewerMarkError
from grader.classroom.gradebook.run_writer import save_student
from grader.classroom.review.session import ReviewSession
from grader.classroom.students import Student
from grader.cli.terminal import show_class
from grader.errors import InputError
from grader.grading.rubric import Rubric, read_rubric
from grader.report.screen import Screen
from grader.usecases.manual_marks import MarkRequest, give_mark
from grader.usecases.terminal import Terminal
from grader.usecases.two_gradebooks import merge_gradebooks
from tests.classroom.gradebook.two_graders import TOTAL, Book, Entry, Grade, Item, Row
from tests.classroom.gradebooks import graded_as, lab_text, record_run

SUBMITTED, MISSING = ("ash",), "cedar"
KEYS = (*SUBMITTED, MISSING)
NAMES = ("Kim", "Lee")
SIGNS = ("ppp??", "fsp??", "pf--?", "p-p?p")  # of loads, box, tall, essay, picture
WHAT = ("points", "undo", "points", "comment", "withdrawn", "excused", "second")
VALUES = ("0", "0.5", "1")  # of the maximum
DIRECTIONS = ((0, 1), (1, 0))
KEEP = ("first", "second", "")
MEMORY = next((path for path in ("/dev/shm",) if os.access(path, os.W_OK)), None)  # does not wait for a disk
_ADJUST = '\n[adjust.{id}]\naction = "{action}"\nreason = "unclear"\n'
_START = datetime(2026, 11, 20, 12, tzinfo=UTC)


def rubric_of(rows: tuple[Row, ...]) -> Rubric:
    """Return the rubric of a model's rows: the small lab with other points, ids and adjustments."""
    text = lab_text(**{name: str(row.points) for name, row in zip(LAB, rows, strict=True)})
    for name, row in zip(LAB, rows, strict=True):
        more = "\nbonus = true" if row.bonus else ""
        text = text.replace(f'id = "{name}"', f'id = "{row.id}"{more}').replace(f'["{name}"]', f'["{row.id}"]')
        text += _ADJUST.format(id=row.id, action=row.adjusted) if row.adjusted else ""
    return read_rubric(text.encode(), Path("small.toml"))


LAB = ("loads", "box", "tall", "essay", "picture")
BASE = tuple(Row(name, Decimal(points)) for name, points in zip(LAB, ("3", "2.5", "0.5", "4", "1"), strict=True))
RUBRICS = (
    BASE,
    tuple(row._replace(points=row.points * 2) if row.id in ("essay", "loads") else row for row in BASE),
    tuple(row._replace(adjusted="drop") if row.id == "box" else row for row in BASE),
    tuple(row._replace(adjusted="full") if row.id == "essay" else row for row in BASE),
    tuple(row._replace(bonus=True) if row.id == "box" else row for row in BASE),
    tuple(row._replace(id="answer") if row.id == "essay" else row for row in BASE),
)
READ = {rows: rubric_of(rows) for rows in RUBRICS}


class Clock(datetime):
    """A clock that stands still until it is set: entries of one second are equal in two gradebooks."""

    current = _START

    @classmethod
    def now(cls, tz: tzinfo | None = None) -> "Clock":
        """Return its time."""
        del tz
        return cls.fromtimestamp(cls.current.timestamp(), UTC)


class TwoGraders(RuleBasedStateMachine):
    """Kim has the first gradebook; Lee has the same or a copy of it."""

    def __init__(self) -> None:
        super().__init__()
        self.folder = TemporaryDirectory(dir=MEMORY)
        self.paths = [Path(self.folder.name, name) for name in ("a.db", "b.db")]
        self.models = [Book(BASE, dict.fromkeys(SUBMITTED, SIGNS[0]))]
        self.changed = {0}
        Clock.current = _START
        self.clock = patch.object(marks, "datetime", Clock)
        self.clock.start()

    def teardown(self) -> None:
        """Remove the gradebooks."""
        self.clock.stop()
        self.folder.cleanup()

    @initialize(copies=st.sampled_from((True, True, False)))
    def begin(self, copies: bool) -> None:
        """Grade the class, and copy the gradebook."""
        with Gradebook(self.paths[0], create=True) as book:
            save_student(book, Student(MISSING), None)
        self._run(0)
        self._command(0, (SUBMITTED[0], 3), "points", "1")
        if copies:
            shutil.copy(*self.paths)
            self.models.append(deepcopy(self.models[0]))
            self.changed.add(1)

    def _run(self, number: int) -> None:
        model, rubric = self.models[number], READ[self.models[number].rubric]
        with Gradebook(self.paths[number]) as book:
            found = [graded_as(rubric, key, signs, key + signs) for key, signs in sorted(model.signs.items())]
            record_run(book, rubric, found)
        self.changed.add(number)

    def _of(self, grader: int) -> int:
        return min(grader, len(self.models) - 1)

    @property
    def now(self) -> str:
        """The time of the next entry."""
        return Clock.now().isoformat(timespec="seconds")

    @rule(seed=st.integers(0, 2**32))
    def work(self, seed: int) -> None:
        """Let both graders mark the same item by commands, some of them in the same second, and merge in between.

        The seed decides: generated lists would mostly be short.
        """
        random = Random(seed)
        item = random.choice(KEYS), random.choice((1, 3, -1))
        for _ in range(random.randint(3, 7)):
            Clock.current += timedelta(seconds=random.randint(0, 1))
            if random.random() < 0.25:
                self._merge(random.choice(DIRECTIONS), random.choice(KEEP))
            else:
                self._command(random.randint(0, 1), item, random.choice(WHAT), random.choice(VALUES))

    def _command(self, grader: int, item: tuple[str, int], what: str, value: str) -> None:
        """Mark, comment, excuse, withdraw, undo or give a second opinion; the position -1 is the whole submission."""
        key, position = item
        number, by = self._of(grader), NAMES[grader]
        model = self.models[number]
        row = model.rubric[position] if position >= 0 else Row(TOTAL, Decimal(8))
        marked = key, row.id
        worth = Decimal(0) if row.adjusted == "drop" else row.points
        points = str(Decimal(value) * worth)
        request = {
            "points": MarkRequest(key, row.id, points, by=by),
            "comment": MarkRequest(key, row.id, comment=f"comment {value}", by=by),
            "withdrawn": MarkRequest(key, row.id, "-", by=by),
            "excused": MarkRequest(key, row.id, excused=True, by=by),
            "undo": MarkRequest(key, row.id, undo=True, by=by),
            "second": MarkRequest(key, row.id, points, by=by, second=True),
        }[what]
        marks_before, newest = model.marks(marked), model.newest(marked)
        is_refused = (
            (what == "excused" and row.id != TOTAL)
            or (what == "undo" and not marks_before)
            or (what not in ("undo",) and key == MISSING and row.id != TOTAL)
            or (what == "second" and row.id == TOTAL)
            or (what in ("points", "second") and row.adjusted == "drop")
            or (what == "second" and newest is not None and newest.points is not None and newest.by == by)
        )
        if is_refused:
            with pytest.raises(InputError):
                give_mark(self.paths[number], request, _ignore)
            return
        give_mark(self.paths[number], request, _ignore)
        if what == "undo":
            model.restore(marked, marks_before[-2] if len(marks_before) > 1 else None, by, self.now)
        else:
            has_points = what in ("points", "second")
            model.add(marked, Entry(what, Decimal(points) if has_points else None, request.comment, by, by, self.now))
        self.changed.add(number)

    @rule(
        grader=st.integers(0, 1),
        actions=st.lists(st.sampled_from(("mark", "other", "next", "back", "undo")), min_size=1, max_size=6),
        value=st.sampled_from(VALUES),
    )
    def review(self, grader: int, actions: list[str], value: str) -> None:
        """Review: mark, go on, go back, undo; meanwhile somebody else marks the item that is shown."""
        number, by = self._of(grader), NAMES[grader]
        model = self.models[number]
        given: list[tuple[Item, Entry | None]] = []
        with Gradebook(self.paths[number]) as book:
            session = ReviewSession(Grades(book), ReviewScope(by=by))
            for action in actions:
                item = None
                if session.item is not None:
                    item = session.item.grade.student.key, session.item.result.criterion.id
                shown = model.newest(item) if item is not None else None
                match action:
                    case "next":
                        session.next()
                    case "back":
                        with suppress(InputError):  # the first item
                            session.back()
                    case "undo" if session.own.can_undo:
                        self._undo(session, model, given, item, by)
                    case "mark" | "other" if item is not None and session.item is not None:
                        points = Decimal(value) * session.item.result.criterion.points
                        entry = Entry("points", points, "", by, by, self.now)
                        if action == "other":
                            give_mark(self.paths[number], MarkRequest(*item, str(points), by="Max"), _ignore)
                            model.add(item, entry._replace(author="Max", by="Max"))
                            with pytest.raises(NewerMarkError):
                                session.mark(points, "")
                            session.next()
                        else:
                            session.mark(points, "")
                            if shown is None or state_of(shown) != state_of(entry):
                                given.append((item, shown))
                                model.add(item, entry)
                            session.next()
        self.changed.add(number)

    def _undo(
        self, session: ReviewSession, model: Book, given: list[tuple[Item, Entry | None]], item: Item | None, by: str
    ) -> None:
        """Undo the newest own mark of this item, else of this review, unless somebody has marked it since."""
        own = [index for index, (marked, _) in enumerate(given) if marked == item] or [len(given) - 1]
        marked, before = given[own[-1]]
        newest = model.newest(marked)
        assert newest is not None
        if newest.author == "Max":
            with pytest.raises(NewerMarkError):
                session.undo()
            given[:] = [pair for pair in given if pair[0] != marked]
            return
        session.undo()
        del given[own[-1]]
        model.restore(marked, before, by, self.now)

    @rule(direction=st.sampled_from(DIRECTIONS), keep=st.sampled_from(KEEP))
    def merge(self, direction: tuple[int, int], keep: str) -> None:
        """Merge one gradebook into the other."""
        self._merge(direction, keep)

    def _merge(self, direction: tuple[int, int], keep: str) -> None:
        """Merge one gradebook into the other; a second merge finds nothing else to do."""
        if len(self.models) == 1:
            return
        first, second = direction
        for _ in range(2):
            expected = self.models[first].merge(self.models[second], keep, "merger", self.now)
            with patch("grader.classroom.gradebook.merge.account", lambda: "merger"):
                text, code = merge_gradebooks(self.paths[first], self.paths[second], keep or None, TERMINAL)  # type: ignore[arg-type]
            assert code == (1 if expected else 0)
        assert expected or "nothing to merge" in text
        self.changed.add(first)

    @rule(number=st.integers(0, 1), key=st.sampled_from(SUBMITTED), signs=st.sampled_from(SIGNS))
    def rerun(self, number: int, key: str, signs: str) -> None:
        """Grade the class again, perhaps with another submission."""
        number = self._of(number)
        self.models[number].signs[key] = signs
        self._run(number)

    @rule(number=st.integers(0, 1), rows=st.sampled_from(RUBRICS))
    def change_rubric(self, number: int, rows: tuple[Row, ...]) -> None:
        """Grade the class with another rubric."""
        number = self._of(number)
        self.models[number].rubric = rows
        self._run(number)

    @invariant()
    def nothing_is_lost_and_grades_are_as_in_the_model(self) -> None:
        """Every entry is there, in order, and every grade and report is that of the model."""
        for number in sorted(self.changed & set(range(len(self.models)))):
            if not self.paths[number].exists():
                continue
            model = self.models[number]
            with Gradebook(self.paths[number]) as book:
                assert entries_of(book) == {item: rows for item, rows in model.entries.items() if rows}
                assert not [*book.rows("PRAGMA foreign_key_check")]
                grades = Grades(book)
                for key in KEYS:
                    grade = grades.find(key)
                    shown = Grade(grade.score, grade.out_of, grade.pending, grade.total, grade.is_excused)
                    assert shown == model.grade(key), key
                    if grade.result is not None:
                        report = grades.report(grade)
                        assert (report.score, report.max_score, report.pending) == shown[:3]
        self.changed.clear()


def state_of(entry: Entry) -> tuple[str, Decimal | None, str]:
    """Return the points and comment of an entry."""
    return entry.kind, entry.points, entry.comment


def entries_of(book: Gradebook) -> dict[Item, list[Entry]]:
    """Return all entries in a gradebook."""
    found: dict[Item, list[Entry]] = {}
    columns = "key, criterion, kind, points, comment, author, grader_name, at"
    for key, name, kind, units, *rest in book.rows(
        f"SELECT {columns} FROM mark JOIN student ON student.id = student ORDER BY mark.id"
    ):
        points = None if units is None else Decimal(units) / 10_000
        found.setdefault((key, name), []).append(Entry(kind, points, *rest))
    return found


def _ignore(_: str) -> None:
    """Print nothing."""


TERMINAL = Terminal(_ignore, _ignore, lambda: Screen(80), lambda _: None, _ignore, show_class)


@pytest.mark.parametrize("count", [10, pytest.param(100, marks=pytest.mark.exhaustive)])
def test_two_graders(count: int) -> None:
    """No sequence of what two graders do loses an entry or changes a grade."""
    profile = settings(
        max_examples=count, stateful_step_count=10, deadline=None,
        suppress_health_check=[HealthCheck.too_slow], phases=[Phase.generate],
    )  # fmt: skip
    run_state_machine_as_test(TwoGraders, settings=profile)
