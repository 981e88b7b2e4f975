"""Whose submissions a class contains: a table of classes, and laws that hold for any names."""

import os
import re
import tempfile
import tomllib
import zipfile
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.classroom.intake.submissions import Intake, read_class
from grader.classroom.roster.roster import Roster, Student, letters, read_roster
from tests.classroom.hostile_classes import try_classes
from tests.examples import examples
from tests.work import limited_work

ROWS: list[dict[str, Any]] = tomllib.loads(
    Path(__file__).with_name("submissions.toml").read_text("utf-8")
)["class"]


def write_class(row: dict[str, Any], top: Path) -> list[Path]:
    """Write the class of a row: empty files, folders that end in a slash, symlinks `a -> b`, and files with a text."""
    for path in row["paths"]:
        name, _, target = path.partition(" -> ")
        (top / name).parent.mkdir(parents=True, exist_ok=True)
        if target:
            (top / name).symlink_to(target)
        elif name.endswith("/"):
            (top / name).mkdir(exist_ok=True)
        else:
            (top / name).write_text(row.get("texts", {}).get(name, ""))
    if not row.get("zip"):
        return [top / name for name in row.get("roots", ["class"])]
    with zipfile.ZipFile(top / "class.zip", "w") as archive:
        for file in sorted((top / "class").rglob("*")):
            archive.write(file, file.relative_to(top / "class"))
    return [top / "class.zip"]


def read_row(row: dict[str, Any], top: Path) -> Intake:
    """Return the submissions of a row's class."""
    roster = read_roster(row["roster"].encode(), "roster.csv") if "roster" in row else None
    paths = write_class(row, top)
    gradebook = top / row["gradebook"] if "gradebook" in row else None
    return read_class(
        paths,
        roster,
        row.get("layout", "auto"),
        row.get("assignment", ""),
        "lab6",
        gradebook=gradebook,
    )


def lines_of(intake: Intake) -> list[str]:
    """Return what was found: the layout, a line a submission, whose is unclear, and the lines for the user."""
    lines = [intake.layout]
    for one in intake.submissions:
        names = one.names or [path.rpartition("/")[2] for path in one.paths]
        paths = ", ".join(
            f"{path} as {name}" if not path.endswith(name) else path
            for path, name in zip(one.paths, names, strict=True)
        )
        more = [
            *(["late"] if one.is_late else []),
            one.submitted,
            f"root {one.root}" if one.root else "",
        ]
        who = one.student.key if one.student.is_on_roster else f"{one.student.key} (visitor)"
        lines.append(f"{who} <- {' | '.join([paths, *filter(None, more)])}")
    lines += [f"unclear: {key}" for key in sorted(intake.unclear)]
    for title in ("unmatched", "notes", "ignored"):
        lines += [f"{title}: {line}" for line in getattr(intake, title)]
    return lines


@pytest.mark.parametrize("row", ROWS, ids=lambda row: row["about"])
def test_a_class_is_read(row: dict[str, Any], tmp_path: Path) -> None:
    """Each student has the submission of the table, and every other name is listed or refused."""
    try:
        found = lines_of(read_row(row, tmp_path))
    except InputError as error:
        found = [f"error: {error}"]
    assert [line.replace(f"{tmp_path}/", "") for line in found] == row["found"]


def packed(folder: str, names: list[str]) -> Path:
    """Return a zip with these empty members."""
    Path(folder).mkdir(exist_ok=True)
    with zipfile.ZipFile(Path(folder, "class.zip"), "w") as archive:
        for name in names:
            archive.writestr(zipfile.ZipInfo(name), b"")
    return Path(folder, "class.zip")


WORDS = st.text(
    st.characters(categories=["L", "M", "Nd", "Pc", "Zs", "Po"]), min_size=1, max_size=12
)
ORIGINAL = st.from_regex(r"[A-Za-z][A-Za-z0-9_ ]{0,9}\.(zip|png|urdf|tar\.gz)", fullmatch=True)
IN_MOODLE = st.text(
    st.characters(
        categories=["L", "M", "Nd", "Zs", "Po", "Pc", "Sm"], exclude_characters="&<>\"`|':\\/"
    ),
    min_size=1,
    max_size=15,
)


@pytest.mark.slow
@examples(30)
@given(
    st.dictionaries(
        st.integers(1, 10**15),
        st.tuples(
            WORDS, st.booleans(), st.dictionaries(ORIGINAL, st.just(None), min_size=1, max_size=4)
        ),
        min_size=1,
        max_size=6,
    )
)
def test_any_download_of_canvas_is_grouped_again(
    people: dict[int, tuple[str, bool, dict[str, None]]],
) -> None:
    """Whatever students and files are called, Canvas' names for them give the same submissions."""
    names, expected = list[str](), {}
    for user, (name, is_late, originals) in people.items():
        shown = re.sub(r"_\d+$", "", letters(name).partition("\n")[2]) or "x"
        for original in originals:
            names.append(
                f"{shown}{'_LATE' if is_late else ''}_{user}_{1000 + len(names)}_{original}"
            )
        expected[str(user)] = (is_late, sorted(originals))
    with tempfile.TemporaryDirectory() as folder:
        found = read_class([packed(folder, names)], None, "canvas").submissions
    assert {one.student.canvas: (one.is_late, sorted(one.names)) for one in found} == expected


@pytest.mark.slow
@examples(30)
@given(st.dictionaries(st.integers(0, 10**12), IN_MOODLE, min_size=2, max_size=6))
def test_any_download_of_moodle_is_grouped_again(people: dict[int, str]) -> None:
    """Whatever participants are called, each is identified by number and name."""
    names = {
        str(number): " ".join(name.split()).strip(".") or "x" for number, name in people.items()
    }
    paths = [f"{name}_{number}_assignsubmission_file/a.zip" for number, name in names.items()]
    with tempfile.TemporaryDirectory() as folder:
        submissions = read_class([packed(folder, paths)], None).submissions
    assert {one.student.moodle: one.student.name for one in submissions} == names


NAMES = st.lists(st.text(st.characters(codec="utf-8"), min_size=1, max_size=20), max_size=20)


@pytest.mark.slow
@given(NAMES, st.booleans())
def test_any_names_are_accepted_and_can_be_assigned(names: list[str], is_twice: bool) -> None:
    """Keys are printable and unique, all paths are in the zip, and the roster can assign every submission to a student."""
    with tempfile.TemporaryDirectory() as folder:
        members = {
            zipfile.ZipInfo(name).filename or "x" for name in ("ann.zip", "bea.zip", *names)
        }  # cut at a NUL
        targets = [
            packed(f"{folder}/{root}", sorted(members - {"package.xml"}))
            for root in "ab"[: 1 + is_twice]
        ]
        for roster in (None, Roster((Student("nobody"),))):
            found = read_class(targets, roster)
            keys = [one.student.key for one in found.submissions]
            assert keys == sorted(set(keys)) and all(map(str.isprintable, keys))
            assert len(found.unmatched) == (len(keys) if roster else 0)
            assert all(
                line.isprintable() for line in (*found.unmatched, *found.notes, *found.ignored)
            )
        for one in found.submissions:
            place = f"{'ab'[one.root]}/class.zip/{one.paths[0]}" if is_twice else one.paths[0]
            given = read_class(targets, Roster((Student("nobody", submission=place),)))
            own = next(it for it in given.submissions if it.student.is_on_roster)
            assert (own.student.key, own.student.login, own.root, own.paths) == (
                "nobody",
                "",
                one.root,
                one.paths,
            )


def test_names_that_are_not_utf_8_can_be_opened(tmp_path: Path) -> None:
    """A name of any bytes gets its own printable key, and its path leads to the file."""
    for name in (b"caf\xe9", b"caf\xe8", b"line\nbreak", b"line\\x0abreak"):
        os.mkdir(os.fsencode(tmp_path) + b"/" + name)
    found = read_class([tmp_path], None).submissions
    assert len({one.student.key for one in found}) == 4 and all(
        one.student.key.isprintable() for one in found
    )
    assert all((tmp_path / one.paths[0]).is_dir() for one in found)


def test_symlinks_in_a_zip_are_not_followed(tmp_path: Path) -> None:
    """A symlink in a zip is no submission, and a member that leads out is not read."""
    with zipfile.ZipFile(tmp_path / "class.zip", "w") as archive:
        link = zipfile.ZipInfo("ann.zip")
        link.create_system, link.external_attr = 3, 0o120777 << 16
        archive.writestr(link, "/etc/passwd")
        for name in ("bea.zip", "../cal.zip", "__MACOSX/bea.zip"):
            archive.writestr(name, b"")
    found = read_class([tmp_path / "class.zip"], None)
    assert [one.paths for one in found.submissions] == [("bea.zip",)]
    assert [line.split()[0] for line in found.ignored] == ["../cal.zip", "ann.zip"]


@pytest.mark.parametrize(
    "limit", ["grader.files.class_source._MAX_MEMBERS", "grader.files.class_source._MAX_FOLDERS"]
)
def test_a_zip_of_too_many_members_is_refused(
    limit: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The numbers of members and of folders are bounded."""
    monkeypatch.setattr(limit, 3)
    assert len(read_class([packed(str(tmp_path), ["a/a.zip", "b/b.zip"])], None).submissions) == 2
    with pytest.raises(InputError, match="contains more than 3 "):
        read_class([packed(str(tmp_path), ["a/a.zip", "b/b.zip", "c/c.zip", "d/d.zip"])], None)


def test_the_list_of_ignored_files_is_bounded(tmp_path: Path) -> None:
    """Of very many files that are no submissions the first are listed, the others counted."""
    for name in ("ann.zip", *(f"note{index:05}.txt" for index in range(1000))):
        (tmp_path / name).touch()
    lines = read_class([tmp_path], None).ignored
    assert (lines[0][:9], lines[-2][:9], lines[-1]) == (
        "note00000",
        "note00199",
        "... and 800 more",
    )


@pytest.mark.slow
def test_a_large_class_takes_linear_work(tmp_path: Path) -> None:
    """Each submission takes few calls, also in a class with as many groups, and each of one student's files."""
    for index in range(2_000):
        (tmp_path / f"student{index:05}.urdf").touch()
    students = tuple(Student(f"Student{index:05}", group=f"g{index}") for index in range(2_000))
    with limited_work(6_000_000):
        assert len(read_class([tmp_path], Roster(students)).submissions) == 2_000
    uploads = packed(
        f"{tmp_path}/zip", [f"doejane_101_{5000 + index}_{index}.png" for index in range(2_000)]
    )
    with limited_work(3_000_000):
        assert len(read_class([uploads], None, "canvas").submissions[0].paths) == 2_000


@pytest.mark.slow
def test_students_cannot_affect_others() -> None:
    """Nobody takes another's submission: a short run of `python -m tests.classroom.hostile_classes`."""
    try_classes(40)
