"""Classes with hostile students: whatever they write, no student gets another's submission, and no file of another's.

A class is laid out as one of the layouts, with or without a roster. Then a student adds what a student can add: further
folders and files in every odd spelling, symlinks to others' work, attempts, archives. After each addition every honest
student has the same submission as before, or none, and it is listed. `python -m tests.classroom.hostile_classes 20000`
tries as many classes and prints its seed, which a second argument repeats.
"""

import os
import random
import shutil
import sys
import tempfile
import time
import unicodedata
import zipfile
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from hypothesis import HealthCheck, seed, settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule, run_state_machine_as_test

from grader.base.errors import InputError
from grader.classroom.intake.class_files import open_class_submission
from grader.classroom.intake.submissions import read_class
from grader.classroom.roster.roster import Roster, Student

LAYOUTS = ("folders", "prefixed", "teams", "nbgrader", "moodle", "canvas")
NAMES = ("alice", "bob", "cal")
MALLORY = "mallory"
_FULL = {"alice": "Alice Ash", "bob": "Bob Birch", "cal": "Cal Cedar", MALLORY: "Mallory Moss"}
_TEAM = {"alice": "red", "bob": "red", "cal": "blue", MALLORY: "green"}
_NUMBER = {"alice": "71", "bob": "72", "cal": "73", MALLORY: "79"}
_FILE = "assignsubmission_file"


def work(owner: str) -> bytes:
    """Return a URDF that tells whose it is."""
    return f"<robot name='{owner}'><link name='{owner}'/></robot>".encode()


@dataclass(frozen=True)
class ClassLayout:
    """The layout of a class: where each student's submission is, and where a student can write."""

    layout: str
    spelling: str
    has_roster: bool

    def place(self, owner: str) -> str:
        """Return the folder of a student, as the platform or the instructor names it."""
        name = {"login": owner, "name": _FULL[owner], "email": f"{owner}@example.org"}[
            self.spelling
        ]
        return {
            "prefixed": f"lab6-{owner}",
            "teams": f"{_TEAM[owner]}/Lab6/{name}",
            "nbgrader": f"submitted/{owner}/lab6",
            "moodle": f"{_FULL[owner]}_{_NUMBER[owner]}_{_FILE}",
            "canvas": f"{_in_canvas(_FULL[owner])}_{_NUMBER[owner]}_500{_NUMBER[owner]}_my_robot",
        }.get(self.layout, name)

    def addition(self, name: str) -> str:
        """Return where a hostile student, or another with a hostile name, can write: never into another's folder."""
        return {
            "prefixed": name if name.startswith("lab6-") else f"lab6-{name}",
            "teams": f"{_TEAM[MALLORY]}/Lab6/{name}",
            "nbgrader": f"submitted/{name}/lab6",
            "moodle": f"{name}_80_{_FILE}",
            "canvas": f"{_in_canvas(name)}_80_50080_my_robot",
        }.get(self.layout, name)

    def is_own(self, name: str) -> bool:
        """Return whether the instructor or platform would give a folder of this name to an honest student on the roster."""
        stem = name.removeprefix("./").removeprefix("lab6-").split(".urdf")[0].split(".zip")[0]
        words = {
            word
            for owner in NAMES
            for word in (owner, f"k{_NUMBER[owner]}", f"{owner}@example.org")
        }
        return (
            self.has_roster and self.layout in ("folders", "prefixed", "nbgrader") and stem in words
        )

    @property
    def roster(self) -> Roster | None:
        """Return the roster: everybody but the hostile student's additions."""
        in_canvas, in_moodle = self.layout == "canvas", self.layout == "moodle"
        students = [
            Student(
                f"k{_NUMBER[name]}",
                _FULL[name],
                f"{name}@example.org",
                name,
                group=_TEAM[name],
                canvas=_NUMBER[name] if in_canvas else "",
                moodle=_NUMBER[name] if in_moodle else "",
            )
            for name in (*NAMES, MALLORY)
        ]
        return Roster(tuple(students)) if self.has_roster else None


def _in_canvas(name: str) -> str:
    words = name.split()
    return "".join(
        letter
        for letter in "".join(words[1:] + words[:1]).lower()
        if letter.isalnum() or letter == "_"
    )


def _variants(name: str) -> list[str]:
    """Return spellings of a name that could be mistaken for it."""
    full, number = _FULL[name], _NUMBER[name]
    return [
        name,
        name.upper(),
        name.title(),
        full,
        full.lower(),
        f"{full.split()[1]}, {full.split()[0]}",
        full.split()[1],
        f"{name}~2",
        f"./{name}",
        f"k{number}",
        number,
        f"{name}_{number}",
        f"{full}_{number}",
        f"lab6-{name}",
        f"x-{name}",
        f"{full.split()[0]}_{number} {full.split()[1]}",
        f"5_x_{number} {full.split()[1]}",
        f"{name}@example.org",
        f"{name}@elsewhere.example",
        f"{full}_{number}_{_FILE}_",
        f"{name}_{number}_99",
        _TEAM[name],
        f"{name}_{number}_5_x",
        unicodedata.normalize("NFD", full.replace("A", "\u00c5")),
        full.replace("a", "\u0430"),
        f"{name}\u200b",
        f"{name}\n",
        f"{name}\udcff",
        f"{name}.urdf",
        f"{name}.zip",
        f"{_TEAM[name]}-{name}",
        f"{_TEAM[name]}\\{name}",
        f"{name} ",
        f".{name}",
        f"anon_{name}x",
        f"surname\n{full.split()[1]}",
        f"canvas {number}",
    ]


HOSTILE = st.sampled_from([variant for name in NAMES for variant in _variants(name)])
LINKS = st.sampled_from(
    ["my_robot.urdf", "urdf", "attempt_9", "src/my_robot", "timestamp.txt", "zz.zip"]
)


class HostileClass(RuleBasedStateMachine):
    """A class, read again after each action of a hostile student."""

    def __init__(self) -> None:
        super().__init__()
        self._folder = tempfile.TemporaryDirectory(
            dir="/dev/shm" if Path("/dev/shm").is_dir() else None
        )
        self.root = Path(self._folder.name).resolve() / "class"

    def teardown(self) -> None:
        """Remove all files."""
        self._folder.cleanup()

    @initialize(
        layout=st.sampled_from(LAYOUTS),
        spelling=st.sampled_from(["login", "name", "email"]),
        has_roster=st.booleans(),
        is_packed=st.booleans(),
    )
    def hand_in(self, layout: str, spelling: str, has_roster: bool, is_packed: bool) -> None:
        """Lay the class out as a folder or a zip."""
        self.made = ClassLayout(layout, spelling, has_roster)
        self.source = self.root.with_suffix(".zip") if is_packed else self.root
        for name in (*NAMES, MALLORY):
            self._submit(self.made.place(name), name)
        self.before = self._read()
        assert sorted(self.before) == sorted(NAMES), (self.made, self.before)

    @rule(name=HOSTILE, is_packed=st.booleans())
    def add_a_submission(self, name: str, is_packed: bool) -> None:
        """Add another submission with a hostile name."""
        if not self.made.is_own(name):
            with suppress(OSError, ValueError):
                self._submit(self.made.addition(name), MALLORY, is_packed=is_packed)
            self._check()

    @rule(
        victim=st.sampled_from(NAMES),
        at=LINKS,
        is_absolute=st.booleans(),
        part=st.sampled_from(["", "/my_robot.urdf"]),
    )
    def link_to_another(self, victim: str, at: str, is_absolute: bool, part: str) -> None:
        """Add a symlink in a student's own folder to another's work."""
        link, target = (
            self.root / self.made.place(MALLORY) / at,
            self.root / (self.made.place(victim) + part),
        )
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

    def _submit(self, place: str, owner: str, *, is_packed: bool = False) -> None:
        """Write a submission below the class, but never through a symlink, because students cannot do that."""
        path = self.root / (f"{place}.zip" if is_packed else f"{place}/my_robot.urdf")
        path.parent.mkdir(parents=True, exist_ok=True)
        victims = [self.made.place(name) for name in NAMES if name != owner]
        is_others = any(
            f"{os.path.normpath(path)}/".startswith(f"{self.root}/{victim}/") for victim in victims
        )
        if (
            path.parent.resolve() != Path(os.path.normpath(path.parent))
            or path.is_symlink()
            or is_others
        ):
            return
        if not is_packed:
            path.write_bytes(work(owner))
            return
        with zipfile.ZipFile(path, "w") as archive:
            archive.writestr("my_robot.urdf", work(owner))

    def _check(self) -> None:
        found = self._read()
        for name, paths in self.before.items():
            listed = [
                line
                for line in self.unmatched
                if line.startswith(paths[0]) and "none is graded" in line
            ]
            assert not self.unclear & {f"k{_NUMBER[one]}" for one in found}, self.made
            is_unclear = (
                not self.made.has_roster or f"k{_NUMBER[name]}" in self.unclear
            )  # so that it is no 0
            assert found.get(name) == paths or (
                name not in found and len(listed) == 1 and is_unclear
            ), (
                self.made,
                os.listdir(self.root),
            )

    def _read(self) -> dict[str, tuple[str, ...]]:
        """Return the paths of each honest student, by the roster's key or by the folder, whose files are their own."""
        if self.source != self.root:
            _pack(self.root, self.source)
        layout = "folders" if self.made.layout == "prefixed" else self.made.layout
        found: dict[str, tuple[str, ...]] = {}
        intake = read_class([self.source], self.made.roster, layout, rubric_id="lab6")
        self.unmatched, self.unclear = intake.unmatched, intake.unclear
        for one in intake.submissions:
            owners = {
                next((name for name in NAMES if self._is_of(name, path)), MALLORY)
                for path in one.paths
            }
            assert len(owners) == 1, one
            (owner,) = owners
            assert (
                not self.made.has_roster
                or owner == MALLORY
                or one.student.key == f"k{_NUMBER[owner]}"
            ), one
            self._check_files(one.paths, one.names, owner)
            if owner != MALLORY:
                assert owner not in found, (owner, one)
                found[owner] = one.paths
        return found

    def _is_of(self, name: str, path: str) -> bool:
        """Return whether a path is that of an honest student, also of the whole repository of a team with no other."""
        place = self.made.place(name)
        return _is_below(path, place) or (
            self.made.layout == "teams" and place.startswith(f"{path}/")
        )

    def _check_files(self, paths: tuple[str, ...], names: tuple[str, ...], owner: str) -> None:
        """Assert that the files read for a submission belong to the owner of its folder."""
        read: list[bytes | None] = []
        with suppress(InputError):
            opened = open_class_submission(str(self.source), paths, names, owner)
            read.append(opened.data)
            for file in opened.tree.files.values() if opened.tree is not None else ():
                with suppress(InputError):
                    read.append(file.read(1_000_000))
        others = [
            name
            for name in (*NAMES, MALLORY)
            for data in read
            if name != owner and work(name) in (data or b"")
        ]
        assert not others, (paths, owner, others)


def _pack(folder: Path, to: Path) -> None:
    """Pack a class folder as a zip with symlinks; names that a zip cannot hold are omitted."""
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
    requested, chosen = (
        int(sys.argv[1]),
        int(sys.argv[2]) if len(sys.argv) > 2 else random.randrange(2**32),
    )
    print(f"seed {chosen}", flush=True)
    began = time.monotonic()
    try_classes(requested, chosen)
    print(
        f"{requested} classes, {time.monotonic() - began:.0f} s: no student has anybody else's submission"
    )
