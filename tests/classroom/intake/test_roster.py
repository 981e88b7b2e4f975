"""Rosters in CSV files, and matching names to their students."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.names import iso_time
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.intake.roster_file import read_roster
from grader.classroom.students import Student
from grader.errors import InputError


def read(tmp_path: Path, text: str | bytes) -> Roster:
    path = tmp_path / "roster.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_roster(path)


def only(tmp_path: Path, text: str) -> RosterEntry:
    (entry,) = read(tmp_path, text).entries
    return entry


PLAIN = "id,name,email\n100,Ann Ash,ann@example.org\n\n200,Jörg Müller,jm@example.org\n"


@pytest.mark.parametrize(
    "data",
    [
        PLAIN.encode(),
        PLAIN.encode("utf-8-sig"),
        PLAIN.encode("utf-16"),
        PLAIN.encode("cp1252"),
        PLAIN.replace("\n", "\r\n").encode(),
        PLAIN.replace(",", ";").encode(),
        PLAIN.replace(",", "\t").encode(),
        b"sep=;\n" + PLAIN.replace(",", ";").encode(),
        '\n"ID","Full Name","E-mail"\n="100","Ann  Ash",ann@example.org\n 200 ,Jörg Müller,jm@example.org,,\n'.encode(),
        "Student_Number;e mail address;NAME\n100;ann@example.org;Ann Ash\n200;jm@example.org;Jörg Müller\n;;\n".replace(
            "e mail address", "Email Address"
        ).encode(),
    ],
)
def test_spellings_of_one_roster(tmp_path: Path, data: bytes) -> None:
    """Encodings, delimiters, line endings, quotes, blank lines and spellings of columns are read alike."""
    assert read(tmp_path, data).students == (
        Student("100", "Ann Ash", "ann@example.org", sis="100"),
        Student("200", "Jörg Müller", "jm@example.org", sis="200"),
    )


def test_a_canvas_gradebook(tmp_path: Path) -> None:
    """The ID of a Canvas export is Canvas' own number; its row of points is no student."""
    text = (
        "Student,ID,SIS User ID,SIS Login ID,Section,Lab 6 (98765)\n"
        ",,,,,Manual Posting\n    Points Possible,,,,,100\n"
        '"Doe, Jane",33,s100,jdoe,Tutorial 1,\n'
    )
    entry = only(tmp_path, text)
    assert entry.student == Student("33", "Doe, Jane", login="jdoe", sis="s100", canvas="33")
    assert entry.section == "Tutorial 1"


def test_a_moodle_worksheet(tmp_path: Path) -> None:
    """The number in Moodle's Identifier is the participant's."""
    text = 'Identifier,"Full name","Email address",Status\n"Participant 123",Jane Doe,jane@example.org,Submitted\n'
    assert only(tmp_path, text).student == Student("jane@example.org", "Jane Doe", "jane@example.org", moodle="123")
    german = "ID;Vollständiger Name;E-Mail-Adresse\nTeilnehmer/in123;Jane Doe;\n"
    assert only(tmp_path, german).student == Student("Jane Doe", "Jane Doe", moodle="123")


def test_all_columns(tmp_path: Path) -> None:
    """All known columns are read, and an unknown one is ignored."""
    text = (
        "First name,Surname,Login,GitHub username,SIS ID,Canvas ID,Moodle ID,Group,Section,Marker,Due date,Extension,Submitted at,Late,Shoe\n"
        "Ann,Ash,aash,annie,s1,11,22,A,B,Kim Kowhai,2026-09-01T23:59+02:00,2 days,2026-09-02 10:00:00Z,1.5,44\n"
    )
    assert only(tmp_path, text) == RosterEntry(
        Student("s1", "Ann Ash", "", "aash", "s1", "11", "22"),
        group="A",
        section="B",
        marker="Kim Kowhai",
        due="2026-09-01T23:59:00+02:00",
        extension_days=2.0,
        submitted="2026-09-02T10:00:00Z",
        is_late=True,
        days_late=1.5,
        aliases=("annie",),
    )


@pytest.mark.parametrize(
    ("cell", "late"),
    [("yes", (True, None)), ("No", (False, None)), ("0", (False, 0.0)), ("2 days", (True, 2.0)), ("", (None, None))],
)
def test_late(tmp_path: Path, cell: str, late: tuple[bool | None, float | None]) -> None:
    """Late is yes, no, or a number of days."""
    entry = only(tmp_path, f"id,late\n1,{cell}\n")
    assert (entry.is_late, entry.days_late) == late


def test_an_extension_is_days_or_a_date(tmp_path: Path) -> None:
    """A number is a number of days, anything else the date of the extension."""
    first, second = read(tmp_path, "id,extension\n1,3\n2,2026-09-04\n").entries
    assert (first.due, first.extension_days) == ("", 3.0)
    assert (second.due, second.extension_days) == ("2026-09-04", 0.0)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "has no students"),
        ("id,name\n", "has no students"),
        ("points,grade\n1,2\n", "no column for an id, login, name or email in its first line, only: points, grade"),
        ("id,name\n1,Ann\n2,Bea\n1,Cal\n", "has the id 1 twice, in lines 2 and 4"),
        ("id,canvas id\n1,7\n2,7\n", "has the canvas id 7 twice, in lines 2 and 3"),
        ('id,name\n1,"An\nn"\n1,Bea\n', "has the id 1 twice, in lines 2 and 4"),
        ("id,name\n1\n", "line 2 of .* has 1 cell, but the first line has 2"),
        ("id,name\n1,Ann,extra\n", "line 2 of .* has 3 cells, but the first line has 2"),
        ("id,name,points\n,,7\n", "line 2 of .* has no id, login, name or email address: add one of them"),
        ("id,name\n1,Ann\n2,'Bea\n3,\"Cal\n", "a quotation mark in row 4 is never closed"),
        ("id,due\n1,12/7/26\n", "line 2 of .* has the date '12/7/26': write it as"),
        ("id,late\n1,maybe\n", "line 2 of .* has 'maybe' for late: write yes, no"),
        (b"\xff\xfe\x00", "is not text in utf-16"),
        (b"i\0d\0,\0", "contains a NUL character"),
        (b"id\n\x81\n", "is not text in UTF-8 or Windows-1252"),
    ],
)
def test_invalid_rosters(tmp_path: Path, text: str | bytes, message: str) -> None:
    """Each mistake is one line, with the line of the file if there is one."""
    with pytest.raises(InputError, match=message) as caught:
        read(tmp_path, text)
    assert "\n" not in str(caught.value)


def test_a_comma_in_a_header(tmp_path: Path) -> None:
    """The most frequent delimiter of the first line counts, because a person may write a comma in a title."""
    assert only(tmp_path, "Note, old;id;login\n;7;ann\n").student.login == "ann"


def test_a_file_that_cannot_be_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A missing file and a huge one are errors of one line."""
    with pytest.raises(InputError, match="cannot read"):
        read_roster(tmp_path / "none.csv")
    monkeypatch.setattr("grader.classroom.intake.roster_file.SIZE_LIMIT", 10)
    with pytest.raises(InputError, match=r"larger than 10 bytes, the limit$"):
        read(tmp_path, PLAIN)


@given(st.datetimes())
def test_times(time: object) -> None:
    """A time as Python writes it is read to the second."""
    text = str(time)
    assert iso_time(text) == text[:19].replace(" ", "T")
    assert iso_time(f"{text} UTC") == f"{text[:19].replace(' ', 'T')}Z"
    assert iso_time(text[:10]) == text[:10]
    assert iso_time(f"on {text}") == ""


@given(st.binary(max_size=300))
def test_any_bytes_give_a_roster_or_lines(tmp_path_factory: pytest.TempPathFactory, data: bytes) -> None:
    """Any bytes are read, or refused with a line for each mistake."""
    try:
        roster = read(tmp_path_factory.getbasetemp(), b"id,name\n" + data)
    except InputError as error:
        assert all(line.isprintable() for line in str(error).split("\n"))
    else:
        assert all(student.key.isprintable() for student in roster.students)


@pytest.mark.parametrize(
    ("columns", "row", "message"),
    [
        ("id,late", "1,-1", "line 2 of FILE has '-1' for late: write yes, no, or a number of days from 0"),
        ("id,extension", "1,-2", "line 2 of FILE has '-2' for extension: write a number of days from 0, or a date"),
        ("id,extension", "1,soon", "line 2 of FILE has 'soon' for extension: write a number of days from 0, or a date"),
        (
            "id,extension",
            "1,2026-02-30",
            "line 2 of FILE has '2026-02-30' for extension, which does not exist: write a",
        ),
        ("id,due", "1,soon", "line 2 of FILE has the date 'soon': write it as 2026-09-01 or 2026-09-01T23:59"),
        ("id,due", "1,2026-02-30", "line 2 of FILE has the date '2026-02-30', which does not exist: write it as"),
        ("id,due", "1,2026-09-01T25:00", "line 2 of FILE has the date '2026-09-01T25:00', which does not exist"),
        (
            "id,submitted",
            "1,2026-02-30 10:00",
            "line 2 of FILE has the time '2026-02-30 10:00' for submitted, which does not exist",
        ),
        (
            "id,submitted",
            "1,yesterday",
            "line 2 of FILE has the time 'yesterday' for submitted: write it as 2026-09-01T10:00",
        ),
        (
            "id,due,extension",
            "1,2026-09-01,2026-09-02",
            "line 2 of FILE has both '2026-09-01' for due and '2026-09-02'",
        ),
        ("id,canvas id", "1,ash", "line 2 of FILE has 'ash' for the canvas id, which must be a number"),
        ("id,participant id", "1,s12345", "line 2 of FILE has 's12345' for the participant id, which must be a number"),
        ("id,email", "1,ash", "line 2 of FILE has 'ash' for the email address, which needs an @"),
        ("id,group", "1,-", "line 2 of FILE has '-' for the group: leave the cell empty for a student without a group"),
        ("id,group", "1,\N{ZERO WIDTH SPACE}", "line 2 of FILE has '\\u200b' for the group"),
        ("id,group", "1,N/A", "line 2 of FILE has 'N/A' for the group"),
        ("id,email", "1,a@x.org\n2,A@X.org", "FILE has the email address A@X.org twice, in lines 2 and 3"),
        ("id,login", "1,ash\n2,birch\n3,ash", "FILE has the login ash twice, in lines 2 and 4"),
        ("name,sis id,id", "Ash,1,8\nBirch,1,9", "FILE has the sis id 1 twice, in lines 2 and 3"),
        ("Student,ID,SIS Login ID", "Ash,7,ash\nBirch,x,birch", "line 3 of FILE has 'x' for the canvas id"),
    ],
)
def test_bad_values(tmp_path: Path, columns: str, row: str, message: str) -> None:
    """A value that cannot be right is refused with its line: nothing is ignored silently."""
    with pytest.raises(InputError) as caught:
        read(tmp_path, f"{columns}\n{row}\n")
    assert str(caught.value).startswith(message.replace("FILE", str(tmp_path / "roster.csv")))
    assert "\n" not in str(caught.value)


def test_all_mistakes_are_reported_at_once(tmp_path: Path) -> None:
    """One line for each, in the order of the file, the duplicates last; of many, the first twenty."""
    text = "id,late,due,group\n1,maybe,2026-13-01,-\n2\n1,yes,,A\n"
    with pytest.raises(InputError) as caught:
        read(tmp_path, text)
    found = [line.removeprefix("line ").replace(f"of {tmp_path}/", "") for line in str(caught.value).split("\n")]
    assert [line[:26] for line in found] == [
        "2 roster.csv has the date ",
        "2 roster.csv has 'maybe' f",
        "2 roster.csv has '-' for t",
        "3 roster.csv has 1 cell, b",
        f"{tmp_path}/roster.csv has the id 1"[:26],
    ]
    with pytest.raises(InputError) as caught:
        read(tmp_path, "id,late\n" + "".join(f"{number},maybe\n" for number in range(50)))
    assert str(caught.value).split("\n")[19:] == [
        f"line 21 of {tmp_path}/roster.csv has 'maybe' for late: write yes, no, or a number of days from 0",
        "... and 30 more",
    ]


def test_identifiers_that_are_not_of_moodle(tmp_path: Path) -> None:
    """In the roster of GitHub Classroom the identifier is the course's own id; in a worksheet it is Moodle's."""
    classroom = read(tmp_path, '"identifier","github_username","github_id","name"\n"1234567","ash-a","99",""\n')
    assert classroom.entries[0].student == Student("1234567", login="ash-a", sis="1234567")
    named = read(tmp_path, "identifier,github_username\n'Ash, Ann',ash-a\n".replace("'", '"'))
    assert named.entries[0].student.key == "Ash, Ann"
    assert read(tmp_path, "Identifier,email\nParticipant 12,a@x.org\n").entries[0].student.moodle == "12"
    assert read(tmp_path, "Identifier,email\ns12,a@x.org\n").entries[0].student.key == "s12"


def test_ids_of_an_own_roster_with_the_columns_of_canvas(tmp_path: Path) -> None:
    """A roster whose ids are no numbers is not taken for a gradebook of Canvas."""
    assert read(tmp_path, "Student,ID,Login\nAnn Ash,aa1,ash\n").entries[0].student == Student(
        "aa1", "Ann Ash", login="ash", sis="aa1"
    )
