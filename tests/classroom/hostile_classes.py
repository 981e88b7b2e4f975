"""Classes with hostile students: whatever they write, every result and mark stays with its own student.

A class is laid out as one of the layouts, with or without a roster, graded, and marked. Then a student adds what a student can
add: further folders and files in every odd spelling, symlinks to others' work, attempts, archives. After each addition the class
is graded again into the same gradebook. `python -m tests.classroom.hostile_classes 20000` tries as many
classes and prints its seed, which a second argument repeats.
"""

import os
import random
import shutil
import sys
import tempfile
import time
import unicodedata
import zipfile
from collections.abc import Callable
from concurrent.futures import Executor, Future
from contextlib import ExitStack, suppress
from dataclasses import dataclass
from decimal import Decimal
from itertools import count
from pathlib import Path
from typing import Any

from hypothesis import HealthCheck, seed, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule, run_state_machine_as_test

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.student_grade import StudentGrade
from grader.classroom.intake.reading import read_class
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.opening import is_zip, open_class_submission
from grader.classroom.run.batch import Batch, RunSettings
from grader.classroom.students import Student
from grader.errors import InputError
from grader.grading.rubric import read_rubric
from tests.classroom.gradebooks import mark

LAYOUTS = ("folders", "prefixed", "teams", "nbgrader", "moodle", "canvas")
NAMES = ("alice", "bob", "cal")
MALLORY = "mallory"
_FULL = {"alice": "Alice Ash", "bob": "Bob Birch", "cal": "Cal Cedar", MALLORY: "Mallory Moss"}
_TEAM = {"alice": "red", "bob": "red", "cal": "blue", MALLORY: "green"}
_NUMBER = {"alice": "71", "bob": "72", "cal": "73", MALLORY: "79"}
_FILE = "assignsubmission_file"
_points = count(1)

RUBRIC = read_rubric(
    b"""id = "lab6"
title = "Whose it is"
urdf = "my_robot.urdf"
[[part]]
id = "all"
title = "All"
needs = "files"
"""
    + b"".join(
        f'[[criterion]]\nid = "is-{name}"\npart = "all"\ntitle = "Of {name}"\npoints = {points}\n'
        f'check = "frame_at"\nwith = {{ link = "{name}", relative_to = "{name}", xyz = [0, 0, 0], tolerance = 0.1 }}\n'.encode()
        for points, name in enumerate((*NAMES, MALLORY), 1)
    ),
    Path("lab6.toml"),
)
_CRITERION = RUBRIC.criteria[-1]


def work(owner: str) -> bytes:
    """Return a URDF that tells whose it is."""
    return f"<robot name='{owner}'><link name='{owner}'/></robot>".encode()


class InlineExecutor(Executor):
    """An executor that runs functions in this process, at once."""

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **named: Any) -> "Future[Any]":
        """Run a function."""
        done: Future[Any] = Future()
        done.set_result(function(*arguments, **named))
        return done


@dataclass(frozen=True)
class Class:
    """The layout of a class: where each student's submission is, and where a student can write."""

    layout: str
    spelling: str
    has_roster: bool

    def place(self, owner: str) -> str:
        """Return the folder of a student, as the platform or the instructor names it."""
        name = {"login": owner, "name": _FULL[owner], "email": f"{owner}@example.org"}[self.spelling]
        match self.layout:
            case "prefixed":
                return f"lab6-{owner}"
            case "teams":
                return f"{_TEAM[owner]}/Lab6/{name}"
            case "nbgrader":
                return f"submitted/{owner}/lab6"
            case "moodle":
                return f"{_FULL[owner]}_{_NUMBER[owner]}_{_FILE}"
            case "canvas":
                return f"{self.in_canvas(_FULL[owner])}_{_NUMBER[owner]}_500{_NUMBER[owner]}_my_robot"
            case _:
                return name

    def addition(self, name: str) -> str:
        """Return where a hostile student, or another with a hostile name, can write: never into another's folder."""
        match self.layout:
            case "prefixed":
                return f"lab6-{name}" if not name.startswith("lab6-") else name
            case "teams":
                return f"{_TEAM[MALLORY]}/Lab6/{name}"
            case "nbgrader":
                return f"submitted/{name}/lab6"
            case "moodle":
                return f"{name}_80_{_FILE}"
            case "canvas":
                return f"{self.in_canvas(name)}_80_50080_my_robot"
            case _:
                return name

    def is_own(self, name: str) -> bool:
        """Return whether a folder of this name is a student's own by the roster: exactly a key, login or address of it.

        The instructor or the platform names these folders, but not files in a team's folder or names in an LMS.
        """
        words = {word for owner in NAMES for word in (owner, f"k{_NUMBER[owner]}", f"{owner}@example.org")}
        is_named_by_instructor = self.layout in ("folders", "prefixed", "nbgrader")
        stem = name.removeprefix("./").removeprefix("lab6-").split(".urdf")[0].split(".zip")[0]
        return self.has_roster and is_named_by_instructor and stem in words

    @staticmethod
    def in_canvas(name: str) -> str:
        """Return a name as Canvas writes it."""
        words = name.split()
        return "".join(letter for letter in "".join(words[1:] + words[:1]).lower() if letter.isalnum() or letter == "_")

    @property
    def roster(self) -> Roster | None:
        """Return the roster: everybody but the hostile student's additions."""
        if not self.has_roster:
            return None
        in_canvas, in_moodle = self.layout == "canvas", self.layout == "moodle"
        return Roster(
            RosterEntry(
                Student(
                    f"k{_NUMBER[name]}", _FULL[name], f"{name}@example.org", name,
                    canvas=_NUMBER[name] if in_canvas else "", moodle=_NUMBER[name] if in_moodle else "",
                ),
                _TEAM[name],
            )
            for name in (*NAMES, MALLORY)
        )  # fmt: skip


def _variants(name: str) -> list[str]:
    """Return spellings of a name that could be mistaken for it."""
    full, number = _FULL[name], _NUMBER[name]
    return [
        name, name.upper(), name.title(), full, full.lower(), f"{full.split()[1]}, {full.split()[0]}", full.split()[1],
        f"{name}~2", f"./{name}", f"k{number}", number, f"{name}_{number}", f"{full}_{number}", f"lab6-{name}", f"x-{name}",
        f"{full.split()[0]}_{number} {full.split()[1]}", f"5_x_{number} {full.split()[1]}", f"{name}@example.org", f"{name}@elsewhere.example", f"{full}_{number}_{_FILE}_", f"{name}_{number}_99", _TEAM[name],
        unicodedata.normalize("NFD", full.replace("A", "\u00c5")), full.replace("a", "\u0430"), f"{name}\u200b", f"{name}\n",
        f"{name}\udcff", f"{name}.urdf", f"{name}.zip", f"{_TEAM[name]}-{name}", f"{_TEAM[name]}\\{name}", f"{name} ", f".{name}",
    ]  # fmt: skip


HOSTILE = st.sampled_from([_variant for name in NAMES for _variant in _variants(name)])
LINKS = st.sampled_from(["my_robot.urdf", "urdf", "attempt_9", "src/my_robot", "timestamp.txt", "zz.zip"])


class HostileClass(RuleBasedStateMachine):
    """A class, graded again after each action of a hostile student."""

    def __init__(self) -> None:
        super().__init__()
        self._stack = ExitStack()
        self.top = Path(self._stack.enter_context(tempfile.TemporaryDirectory(dir=_fast()))).resolve()
        self.root = self.top / "class"

    def teardown(self) -> None:
        """Remove all files."""
        self._stack.close()

    @initialize(
        layout=st.sampled_from(LAYOUTS),
        spelling=st.sampled_from(["login", "name", "email"]),
        has_roster=st.booleans(),
        is_zip=st.booleans(),
    )
    def grade_the_class(self, layout: str, spelling: str, has_roster: bool, is_zip: bool) -> None:
        """Lay the class out as a folder or a zip, grade it, and give every student a manual mark."""
        self.made = Class(layout, spelling, has_roster)
        self.source = self.top / "class.zip" if is_zip else self.root
        for name in (*NAMES, MALLORY):
            self._submit(self.made.place(name), name)
        self.book = self._stack.enter_context(Gradebook(self.top / "g.db", create=True))
        self._grade()
        for standing in list(Grades(self.book).all()):
            mark(self.book, standing, _CRITERION, Decimal(4), "me", "")
        self.before = self._marks()
        assert sorted(self.before) == sorted(NAMES), (self.made, self.before)

    @rule(name=HOSTILE, is_zip=st.booleans())
    def add_a_submission(self, name: str, is_zip: bool) -> None:
        """Add another submission with a hostile name."""
        if self.made.is_own(name):
            return
        place = self.made.addition(name)
        with suppress(OSError, ValueError):
            self._submit(place, MALLORY, is_zip=is_zip)
        self._check()

    @rule(
        victim=st.sampled_from(NAMES), at=LINKS, is_absolute=st.booleans(), part=st.sampled_from(["", "/my_robot.urdf"])
    )
    def link_to_another(self, victim: str, at: str, is_absolute: bool, part: str) -> None:
        """Add a symlink in a student's own folder to another's work."""
        link = self.root / self.made.place(MALLORY) / at
        target = self.root / (self.made.place(victim) + part)
        link.parent.mkdir(parents=True, exist_ok=True)
        if link.is_dir() and not link.is_symlink():
            shutil.rmtree(link)
        link.unlink(missing_ok=True)
        link.symlink_to(target if is_absolute else os.path.relpath(target, link.parent))
        self._check()

    @rule(victim=st.sampled_from(NAMES), name=HOSTILE)
    def add_a_link_as_submission(self, victim: str, name: str) -> None:
        """Add a symlink in place of another submission."""
        link = self.root / self.made.addition(name)
        with suppress(OSError, ValueError):
            link.parent.mkdir(parents=True, exist_ok=True)
            link.symlink_to(self.root / self.made.place(victim))
        self._check()

    @rule(number=st.integers(1, 20))
    def add_an_attempt(self, number: int) -> None:
        """Add another attempt."""
        with suppress(FileExistsError):  # a symlink is there already
            self._write(f"{self.made.place(MALLORY)}/attempt_{number}/my_robot.urdf", MALLORY)
        self._check()

    def _submit(self, place: str, owner: str, *, is_zip: bool = False) -> None:
        if not is_zip:
            self._write(f"{place}/my_robot.urdf", owner)
            return
        path = self.root / f"{place}.zip"
        if path.parent.resolve() == path.parent.absolute():
            path.parent.mkdir(parents=True, exist_ok=True)
            with zipfile.ZipFile(path, "w") as archive:
                archive.writestr("my_robot.urdf", work(owner))

    def _write(self, path: str, owner: str) -> None:
        """Write a file below the class, but never through a symlink, because students cannot do that."""
        place = self.root / path
        place.parent.mkdir(parents=True, exist_ok=True)
        if place.parent.resolve() == Path(os.path.normpath(place.parent)) and not place.is_symlink():
            victims = [self.made.place(name) for name in NAMES if name != owner]
            if not any(f"{os.path.normpath(place)}/".startswith(f"{self.root}/{victim}/") for victim in victims):
                place.write_bytes(work(owner))

    def _grade(self) -> None:
        layout = "folders" if self.made.layout == "prefixed" else self.made.layout
        roster = self.made.roster
        if self.source != self.root:
            _pack(self.root, self.source)
        intake = read_class(self.source, roster, layout, rubric_id="lab6")
        for submission in intake.submissions():
            self._check_files(submission.paths, submission.names, submission.student.key)
        reported = RunSettings(str(self.source), layout, roster=roster)
        Batch(self.book, RUBRIC, reported, InlineExecutor(), 1).grade(intake)

    def _check_files(self, paths: tuple[str, ...], names: tuple[str, ...], key: str) -> None:
        """Assert that the files read for a submission belong to the owner of its folder."""
        owners = {next((name for name in NAMES if _is_below(path, self.made.place(name))), MALLORY) for path in paths}
        assert len(owners) == 1, (key, paths)
        try:
            opened = open_class_submission(str(self.source), paths, names, key)
        except InputError:
            return
        read = [opened.data] if opened.data is not None else []
        if opened.tree is not None:
            for file in opened.tree.files.values():
                with suppress(InputError):
                    read.append(file.read(1_000_000))
        for data in read:
            others = [name for name in (*NAMES, MALLORY) if name not in owners and work(name) in (data or b"")]
            assert not others, (key, paths, others)

    def _check(self) -> None:
        self._grade()
        assert self._marks() == self.before, (self.made, sorted(os.listdir(self.root)))

    def _marks(self) -> dict[str, tuple[Any, ...]]:
        """Return the mark of each honest student, by the roster's key or by the folder."""
        found = {}
        for standing in Grades(self.book).all():
            owner = self._owner_of(standing)
            if owner in NAMES and standing.result is not None:
                assert owner not in found, (owner, standing)
                found[owner] = (standing.score, standing.marks, standing.why_not_final, standing.files.paths)
        return found

    def _owner_of(self, standing: StudentGrade) -> str:
        if self.made.has_roster:
            return next((name for name in NAMES if standing.student.key == f"k{_NUMBER[name]}"), MALLORY)
        return next((name for name in NAMES if _is_below(standing.files.paths[0], self.made.place(name))), MALLORY)


def _pack(folder: Path, to: Path) -> None:
    """Pack a class folder as a zip with symlinks; names that a zip cannot hold are omitted."""
    is_zip.cache_clear()
    with zipfile.ZipFile(to, "w") as archive:
        for path in sorted(folder.rglob("*"), key=str):
            member = zipfile.ZipInfo(path.relative_to(folder).as_posix())
            with suppress(UnicodeEncodeError, OSError):
                if path.is_symlink():
                    member.create_system, member.external_attr = 3, 0o120777 << 16
                    archive.writestr(member, os.readlink(path))
                elif path.is_file():
                    archive.writestr(member, path.read_bytes())


def _is_below(path: str, place: str) -> bool:
    return f"{path}/".startswith(f"{place}/")


def _fast() -> str | None:
    """Return a file system in memory, if there is one."""
    return "/dev/shm" if Path("/dev/shm").is_dir() else None


def try_classes(number: int, start: int | None = None) -> None:
    """Try so many classes; raise AssertionError with the shortest sequence of actions for the first failure."""
    run_state_machine_as_test(
        HostileClass if start is None else seed(start)(HostileClass),
        settings=settings(
            max_examples=number,
            stateful_step_count=6,
            deadline=None,
            suppress_health_check=list(HealthCheck),
        ),
    )


if __name__ == "__main__":
    requested, chosen = int(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else random.randrange(2**32)
    print(f"seed {chosen}", flush=True)
    began = time.monotonic()
    try_classes(requested, chosen)
    print(f"{requested} classes, {time.monotonic() - began:.0f} s: no result and no mark of anybody was anybody else's")
