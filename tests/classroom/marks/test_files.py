"""Files of marks keep what graders gave: however a file is written, appended to, merged, cut, or saved by a spreadsheet."""

import re
import resource
import stat
import subprocess
import sys
import unicodedata
from collections.abc import Iterable
from contextlib import suppress
from decimal import Decimal
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.base.text import format_points
from grader.classroom.marks import marks
from grader.classroom.marks.marks import (
    COLUMNS,
    EXCUSED,
    WITHDRAWN,
    Mark,
    append_marks,
    is_open_in_libreoffice,
    mark_file,
)
from grader.classroom.tables import protected, unprotected
from grader.lab.rubric.criterion import DEADLINE, GRADE
from tests.classroom.marks import STUDENTS, read, said
from tests.command_line import HANG_TIMEOUT
from tests.samples import ROOT

REFUSED = {
    "excel-dates.csv": [
        "marks/lee.csv:2: points are a number from 0 to 4, with at most 4 decimals, not '03. Mai'",
        "marks/lee.csv:3: points are a number from 0 to 4, with at most 4 decimals, not '03.05.26'",
    ],
    "excel-lost-zeros.csv": [
        "marks/lee.csv:11: student '12' may be '0012', changed by a spreadsheet: correct it"
    ],
    "excel-one-column.csv": [
        "marks/lee.csv:3: the row names no student",
        "marks/lee.csv:4: the row names no student",
    ],
}
SAVED = Path(__file__).with_name("saved")
TEXT = st.text(st.sampled_from("ab é;,=+-@'\"\t\n“x"), max_size=12).map(lambda text: text.strip())
TIMES = st.integers(0, 999).map(lambda number: f"2026-11-23T14:05:09.{number:03}+00:00")
POINTS = st.integers(0, 16).map(lambda quarters: format_points(Decimal(quarters) / 4))
DUE = "2026-11-20T23:59+01:00"


@st.composite
def mark(draw: st.DrawFn) -> Mark:
    """Draw a mark of any kind."""
    who, value = (
        draw(st.sampled_from(STUDENTS)),
        draw(POINTS | st.sampled_from((EXCUSED, WITHDRAWN, "", DUE))),
    )
    criterion = {EXCUSED: GRADE, DUE: DEADLINE}.get(value, "essay")
    drawn = Mark(
        draw(TIMES),
        draw(TEXT),
        who,
        criterion,
        value,
        draw(TEXT),
        draw(st.sampled_from(("", "d0a1"))),
    )
    assume(drawn.value or drawn.comment)
    return drawn


MARKS = st.lists(mark(), max_size=5, unique_by=lambda one: (one.time, one.student, one.criterion))


@st.composite
def dialect(draw: st.DrawFn) -> bytes:
    """Draw the first line of a file, and a row, as a person or a spreadsheet may have written them."""
    delimiter, end = draw(st.sampled_from(",;\t")), draw(st.sampled_from(("\n", "\r\n", "\r")))
    titles = draw(st.permutations([*COLUMNS, *draw(st.sampled_from(((), ("Note",), ("", ""))))]))
    row = {
        "student": "ben",
        "criterion": "picture",
        "points": draw(st.sampled_from(("1", "0.5", '"0,5"'))),
        "Note": "é",
    }
    lines = [
        delimiter.join(titles),
        *draw(st.sampled_from(((), (delimiter.join(row.get(one, "") for one in titles),)))),
    ]
    return (end.join(lines) + end).encode(
        draw(st.sampled_from(("utf-8", "utf-8-sig", "utf-16", "cp1252")))
    )


def rows_in(folder: Path) -> dict[tuple[str, str], Mark]:
    """Return the newest rows of a folder, without their places."""
    return {key: one._replace(place="") for key, one in read(folder).newest.items()}


def appended(folder: Path, start: bytes | None, marks: list[Mark], name: str = "lee.csv") -> bytes:
    """Append marks to a file with this content, and return what it is then."""
    folder.mkdir(exist_ok=True)
    if start is not None:
        (folder / name).write_bytes(start)
    append_marks(folder / name, marks)
    return (folder / name).read_bytes()


@pytest.mark.slow
@given(dialect() | st.none(), MARKS, MARKS)
def test_appended_marks_are_read_as_they_were_given(
    start: bytes | None, first: list[Mark], second: list[Mark]
) -> None:
    """In any dialect, what was in the file stays byte for byte; the newest mark is the one with the latest time."""
    expected: dict[tuple[str, str], Mark] = {}
    for one in (*first, *second):
        key = one.student, one.criterion
        expected[key] = max(expected.get(key, one), one, key=lambda other: other.time)
        if expected[key].time == one.time:
            expected[key] = one
    with TemporaryDirectory() as top:
        folder = Path(top) / "marks"
        before = appended(folder, start, first)
        assert before.startswith(start or b"")
        assert appended(folder, None, second).startswith(before)
        found = rows_in(folder)
        found.pop(("ben", "picture"), None)
        assert found == expected


@given(st.text(st.sampled_from("ab'=+-@;\t\n\r ＝"), max_size=9))
def test_protected_text_is_restored(text: str) -> None:
    """No text begins a formula, and each comes back."""
    assert unprotected(protected(text)) == text
    assert not any(
        cell.lstrip().startswith(tuple("=+-@＝"))
        for cell in protected(text).replace("\n", ";").split(";")
    )


@pytest.mark.slow
@given(st.lists(MARKS, min_size=2, max_size=2), st.booleans())
def test_copying_a_file_merges(files: list[list[Mark]], is_reversed: bool) -> None:
    """The newest marks of two folders are those of one with the files of both, in any order of names."""
    times = [one.time for marks in files for one in marks]
    assume(len({*times}) == len(times))
    with TemporaryDirectory() as top:
        parts: dict[tuple[str, str], Mark] = {}
        for number, marks in enumerate(files):
            appended(Path(top) / str(number), None, marks)
            parts |= {
                key: max(parts.get(key, one), one)
                for key, one in rows_in(Path(top) / str(number)).items()
            }
        folder = Path(top) / "marks"
        for number, marks in enumerate(files):
            appended(folder, None, marks, f"{'ba'[number] if is_reversed else 'ab'[number]}.csv")
        assert rows_in(folder) == parts


@given(dialect(), MARKS, st.data())
def test_a_cut_file_counts_nothing_new(
    start: bytes, marks: list[Mark], data: st.DataObject
) -> None:
    """Every prefix is refused, or its rows are rows of the whole file; the last one may lack its digest."""
    with TemporaryDirectory() as top:
        rows = {*rows_in_file(Path(top), start), *marks}
        whole = appended(Path(top) / "marks", start, marks)
        with suppress(InputError):
            found = {*rows_in_file(Path(top), whole[: data.draw(st.integers(0, len(whole)))])}
            assert found <= rows | {one._replace(submission="") for one in rows}


def rows_in_file(top: Path, data: bytes) -> Iterable[Mark]:
    """Return the newest rows of a file."""
    (top / "marks").mkdir(exist_ok=True)
    (top / "marks" / "lee.csv").write_bytes(data)
    return rows_in(top / "marks").values()


@pytest.mark.parametrize("path", sorted(SAVED.iterdir()), ids=lambda path: path.stem)
def test_a_file_that_a_spreadsheet_saved(path: Path, tmp_path: Path) -> None:
    """It has the marks of the original, also after more are appended; what the spreadsheet changed is refused."""
    folder = tmp_path / "marks"
    folder.mkdir()
    (folder / "lee.csv").write_bytes((SAVED / "original.csv").read_bytes())
    original = rows_in(folder)
    (folder / "lee.csv").write_bytes(path.read_bytes())
    if path.name in REFUSED:
        with pytest.raises(InputError) as caught:
            read(folder)
        assert str(caught.value).splitlines() == REFUSED[path.name]
        return
    assert rows_in(folder) == original
    new = Mark("2026-11-24T00:00:00.000+00:00", "Lee", "ben", "picture", "0.75", "é; ü\n'x", "d12")
    appended(folder, None, [new])
    assert rows_in(folder) == {**original, ("ben", "picture"): new}


HEADER = ",".join(COLUMNS)


@pytest.mark.parametrize(
    ("start", "row"),
    [
        ("", f"{HEADER}\n,Lee,ben,essay,0.75,a;b,\n"),
        (f"{HEADER}\r\n", ",Lee,ben,essay,0.75,a;b,\r\n"),
        (f"{HEADER}\n,,anna,essay,3,,d12", "\n,Lee,ben,essay,0.75,a;b,\n"),
        (f'{HEADER}\n,,anna,essay,"0,5",,\n', ',Lee,ben,essay,"0,75",a;b,\n'),
        (HEADER.replace(",", ";") + "\n", ";Lee;ben;essay;0,75;a;b;\n"),
        (HEADER.replace(",", ";") + "\n;;anna;essay;0.5;;\n", ";Lee;ben;essay;0.75;a;b;\n"),
        (f"note,{HEADER}\n", ",,Lee,ben,essay,0.75,a;b,\n"),
    ],
)
def test_a_row_is_in_the_style_of_its_file(start: str, row: str, tmp_path: Path) -> None:
    """Delimiter, decimal sign, line ends, order of columns; what is missing before it is supplied."""
    after = appended(
        tmp_path / "marks", start.encode(), [Mark("", "Lee", "ben", "essay", "0.75", "a;b")]
    )
    assert after.decode().replace('"a;b"', "a;b") == start + row


WRITER = """
from decimal import Decimal
from pathlib import Path
from grader.classroom.marks.marks import Mark, append_marks
for number in range(20):
    time = f"2026-11-23T14:05:{number:02}.000+00:00"
    append_marks(Path(FOLDER) / "lee.csv", [Mark(time, WHO, WHO, "essay", str(Decimal(number) / 8), "x" * 5000)])
"""


@pytest.mark.slow
def test_two_writers_lose_no_row(tmp_path: Path) -> None:
    """Two processes append to one file, which neither has made before."""
    folder = tmp_path / "marks"
    programs = [
        WRITER.replace("FOLDER", repr(str(folder))).replace("WHO", repr(who))
        for who in ("anna", "ben")
    ]
    started = [subprocess.Popen([sys.executable, "-c", program], cwd=ROOT) for program in programs]
    assert [one.wait(HANG_TIMEOUT) for one in started] == [0, 0]
    assert (folder / "lee.csv").read_text().count("\n") == 41
    assert {who: said(one)[:3] for (who, _), one in read(folder).counting.items()} == {
        "anna": "2.3",
        "ben": "2.3",
    }


def test_a_full_disk_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    """A row that is written in part is removed."""
    old = Mark("", "Lee", "anna", "essay", "3")
    before = appended(tmp_path / "marks", None, [old])
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (len(before) + 9, limits[1]))
    try:
        with pytest.raises(InputError, match=r"cannot write marks/lee\.csv: File too large"):
            append_marks(
                tmp_path / "marks" / "lee.csv", [old._replace(student="ben", comment="x" * 99)]
            )
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert (tmp_path / "marks" / "lee.csv").read_bytes() == before


@pytest.mark.parametrize(
    ("start", "why"),
    [
        (
            b"student,criterion,points\n",
            "marks/lee.csv has no column time, by, comment and submission: add it to the first line",
        ),
        (
            b",".join(map(str.encode, COLUMNS)) + b"\n,,anna,essay,1",
            "marks/lee.csv:2: the last row may be incomplete",
        ),
        (
            b",".join(map(str.encode, COLUMNS)) + b'\n,,anna,essay,1,"',
            "a quotation mark in row 2 is never closed",
        ),
    ],
)
def test_no_row_is_appended(start: bytes, why: str, tmp_path: Path) -> None:
    """A file without a column, or with an incomplete end, stays as it is."""
    with pytest.raises(InputError, match=re.escape(why)):
        appended(tmp_path / "marks", start, [Mark("", "", "ben", "essay")])
    assert (tmp_path / "marks" / "lee.csv").read_bytes() == start


def test_a_file_that_is_replaced_meanwhile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing is written into a file that an editor has replaced since it was opened."""

    def replace(handle: int) -> None:
        (tmp_path / "new").replace(tmp_path / "marks" / "lee.csv")

    (tmp_path / "new").write_text("of the editor")
    monkeypatch.setattr(marks, "lock", replace)
    with pytest.raises(InputError, match=r"another program replaces marks/lee\.csv: try again"):
        appended(tmp_path / "marks", b"", [Mark("", "", "ben", "essay", "1")])
    assert (tmp_path / "marks" / "lee.csv").read_text() == "of the editor"
    assert read(tmp_path / "nothing") == ({}, {}, {}, [])


def test_files_are_private_and_symlinks_are_not_followed(tmp_path: Path) -> None:
    """A new file is for its owner alone; a symlink is neither read nor written."""
    folder = tmp_path / "gradebook" / "marks"
    append_marks(folder / "lee.csv", [Mark("", "Lee", "anna", "essay", "3")])
    assert [stat.S_IMODE(path.stat().st_mode) for path in (folder, folder / "lee.csv")] == [
        0o700,
        0o600,
    ]
    (folder / "kim.csv").symlink_to(folder / "lee.csv")
    with pytest.raises(InputError, match=r"marks/kim\.csv is a symlink, and was not followed"):
        read(folder)
    with pytest.raises(InputError, match=r"cannot write marks/kim\.csv"):
        append_marks(folder / "kim.csv", [])
    assert not is_open_in_libreoffice(folder / "lee.csv")
    (folder / ".~lock.lee.csv#").touch()
    assert is_open_in_libreoffice(folder / "lee.csv")


def test_a_grader_without_a_name_is_the_login(monkeypatch: pytest.MonkeyPatch) -> None:
    """A login without a name, as in a container with the number of a user, is refused."""
    monkeypatch.setattr(marks, "getuser", lambda: "kim")
    assert mark_file(Path("marks"), " ") == Path("marks/kim.csv")
    monkeypatch.setattr(marks, "getuser", _fail)
    assert mark_file(Path("marks"), "Lee") == Path("marks/lee.csv")
    with pytest.raises(InputError, match="this login has no name: name yourself with --by NAME"):
        mark_file(Path("marks"), "")


def _fail() -> str:
    raise KeyError("getpwuid(): uid not found: 1234")


@given(
    st.lists(
        st.text(max_size=50)
        | st.sampled_from(["con", "COM1", "..", "a/b", "Kim", "kim ", "K\u0131m"]),
        max_size=3,
    )
)
def test_different_graders_have_different_files(graders: list[str]) -> None:
    """Their names are valid on every system; those of one person in upper and lower case are one file."""
    files = [mark_file(Path("marks"), by) for by in graders]
    assert len({path.name.upper() for path in files}) == len(
        {unicodedata.normalize("NFC", by.strip().lower()) for by in graders}
    )
    for path in files:
        assert path.parent == Path("marks") and re.fullmatch(
            r"[a-z0-9_][a-z0-9_-]{0,99}\.csv", path.name
        )
        assert not re.fullmatch(r"(con|prn|aux|nul|com\d|lpt\d)\.csv", path.name)
