"""Totals and comments in a Moodle grading worksheet, in the languages that Moodle writes."""

import csv
import io
import re
from decimal import Decimal
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.outcome import Outcome
from grader.classroom.lms.feedback import LIMIT, FeedbackItem, feedback_html, feedback_items, is_own_feedback
from grader.classroom.lms.filling import FillOptions
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.moodle import fill_worksheet
from grader.classroom.lms.preflight import Filled, RowNote
from grader.classroom.students import Student
from grader.classroom.tables import neutral
from grader.errors import InputError
from grader.grading.report import ManualMark, Result
from tests.classroom.gradebooks import lab

HEADER = (
    'Identifier,"Full name","Email address",Status,Grade,"Maximum Grade","Grade can be changed",'
    '"Last modified (submission)","Last modified (grade)","Feedback comments"'
)
COMMENT = feedback_html(
    Decimal("58.5"), Decimal(100), [FeedbackItem("The base", Decimal(2), Decimal(4), "it is 0.1 m too low")]
)


def graded(key: str, total: str | None = "58.5", feedback: str = "", why_not: str = "", **known: Any) -> LmsGrade:
    return LmsGrade(Student(key, **known), None if total is None else Decimal(total), feedback, why_not)


def row(
    number: int,
    name: str = "Jane Doe",
    old: str = "",
    comment: str = "",
    *,
    maximum: str = "100.00",
    change: str = "Yes",
) -> str:
    return f'"Participant {number}","{name}",p{number}@uni.example,Submitted,{old},{maximum},{change},-,-,{comment}'


def worksheet(*rows: str, header: str = HEADER, end: str = "\n") -> bytes:
    return "".join(row + end for row in (header, *rows)).encode()


def fill(
    data: bytes,
    *grades: LmsGrade,
    column: str = "",
    feedback_column: str = "",
    out_of: str = "100",
    any_maximum: bool = False,
) -> Filled:
    options = FillOptions(Decimal(out_of), (), column, feedback_column, any_maximum)
    return fill_worksheet(data, grades, options)


def cells(filled: Filled) -> list[list[str]]:
    return list(csv.reader(io.StringIO(filled.data.decode(), newline="")))


@pytest.mark.parametrize("title", ["ID number", "Username", "ID-Nummer"])
def test_the_key_counts_as_id_number(title: str) -> None:
    """If the site shows ID numbers or user names, a student is found by them."""
    data = f"Identifier,Full name,{title},Status,Grade,Maximum grade\nParticipant 7,Jane,s123,-,,100.00\n".encode()
    assert fill(data, graded("S123")).preflight.filled == 1


def test_namesakes_and_other_numbers_are_never_guessed() -> None:
    """A name in two rows is ambiguous; a name whose participant number differs matches nobody."""
    data = worksheet(row(1), row(2), row(3, "Ann Lee"))
    filled = fill(data, graded("a", name="Jane Doe"), graded("b", name="Ann Lee", moodle="4"))
    assert cells(filled) == [next(csv.reader([HEADER]))]
    assert [left.row for left in filled.preflight.ambiguous] == [2, 3]
    assert [left.who for left in filled.preflight.unknown] == ["Ann Lee"]
    assert [left.who for left in filled.preflight.missing] == ["Ann Lee"]


def test_a_suspended_student_has_a_plain_name() -> None:
    """The span and the picture that Moodle puts around a suspended student's name are ignored."""
    name = '<span class=""usersuspended"">Jane &amp; Doe <img src=""x"" title=""Suspended"" /></span>'
    filled = fill(worksheet(row(7, name)), graded("x", None, why_not="pending", name="Jane & Doe"))
    assert filled.preflight.ungraded == [RowNote(2, "Jane & Doe", "pending")]


def test_blind_marking() -> None:
    """Without names, students have identifiers and are found by the number."""
    data = b'Identifier,Status,Grade,"Maximum grade"\n"Participant 7",Submitted,,100.00\n"Participant 8",Submitted,,100.00\n'
    filled = fill(data, graded("x", moodle="7"))
    assert cells(filled)[1:] == [["Participant 7", "Submitted", "58.50", "100.00"]]
    assert filled.preflight.unknown[0].who == "Participant 8"


def test_rows_without_a_grade_are_omitted() -> None:
    """Locked, above Moodle's maximum, pending, misplaced cells: omitted, so that Moodle changes nothing."""
    rows = [row(1, change="No"), row(2, maximum="50.00"), row(3, old="12.00", comment="mine"), row(4) + ",x"]
    grades = [
        graded("1", moodle="1"),
        graded("2", moodle="2"),
        graded("3", None, why_not="not handed in", moodle="3"),
        graded("4", moodle="4"),
    ]
    filled = fill(worksheet(*rows), *grades, any_maximum=True)
    assert len(cells(filled)) == 1
    assert [left.why for left in filled.preflight.ungraded] == [
        "has a grade that is locked in Moodle",
        "not handed in",
        "the row has 11 cells and the header 10",
    ]
    why = "58.50 points are above the maximum of 50: raise the maximum there, or give a final mark"
    assert filled.preflight.refused == [RowNote(3, "Jane Doe", why)]
    assert not filled.preflight.matches


def test_full_marks_are_not_above_the_maximum() -> None:
    """A total equal to the maximum is filled."""
    assert fill(worksheet(row(1)), graded("x", "100", moodle="1")).preflight.filled == 1


def test_no_comment_leaves_the_cell_unchanged() -> None:
    """Without feedback from the grader the existing comment stays, without a message."""
    filled = fill(worksheet(row(1, comment="mine")), graded("1", moodle="1"))
    assert cells(filled)[1][9] == "mine"
    assert not filled.preflight.kept_feedback


def test_a_comment_starts_no_formula() -> None:
    """A written cell starts no formula, regardless of who wrote the comment."""
    assert cells(fill(worksheet(row(1)), graded("1", feedback="=1+1", moodle="1")))[1][9] == "'=1+1"


GERMAN = (
    'ID,"Vollständiger Name",E-Mail-Adresse,Status,Bewertung,Bestwertung,"Bewertung kann geändert werden",'
    '"Zuletzt geändert (Abgabe)","Zuletzt geändert (Bewertung)","Feedback als Kommentar"'
)


def test_german() -> None:
    """The number follows the word without a space, decimals have a comma, and No is Nein."""
    rows = [
        'Teilnehmer/in123,"Jörg Öztürk",j@uni.example,"Zur Bewertung abgegeben",,"100,00",Ja,-,-,',
        'Teilnehmer/in124,"Ann Lee",a@uni.example,"Zur Bewertung abgegeben",,"100,00",Nein,-,-,',
    ]
    filled = fill(
        worksheet(*rows, header=GERMAN), graded("1", moodle="123", feedback=COMMENT), graded("2", moodle="124")
    )
    assert cells(filled)[1] == [
        "Teilnehmer/in123",
        "Jörg Öztürk",
        "j@uni.example",
        "Zur Bewertung abgegeben",
        "58,50",
        "100,00",
        "Ja",
        "-",
        "-",
        COMMENT,
    ]
    assert [left.who for left in filled.preflight.ungraded] == ["Ann Lee"]
    assert not filled.preflight.warnings


def test_an_unknown_language() -> None:
    """Grade and maximum are found by their values; a comment needs its column's name."""
    header = "Tunniste,Nimi,Sposti,Tila,Ryhmä,Arvosana,Enimmäisarvosana,Muokattu,Palaute"
    data = worksheet(
        "Osallistuja 7,Jane,j@uni.example,ok,3,,100.00,-,",
        "Osallistuja 8,Ann,a@uni.example,ok,3,80.00,100.00,-,",
        header=header,
    )
    grade = graded("x", email="j@uni.example", feedback=COMMENT)
    filled = fill(data, grade)
    assert filled.preflight.column == "Arvosana"
    assert cells(filled)[1][5:] == ["58.50", "100.00", "-", ""]
    assert any("no known column for feedback" in warning for warning in filled.preflight.warnings)
    assert any("Last modified" in warning for warning in filled.preflight.warnings)
    assert cells(fill(data, grade, feedback_column="Palaute"))[1][8] == COMMENT
    assert cells(fill(data, grade, column="Arvosana"))[1][5] == "58.50"


def test_a_workflow_a_marker_and_an_online_text() -> None:
    """Columns that only some sites have change nothing."""
    header = (
        "Identifier,Full name,ID number,Email address,Status,Group,Marker,Grade,Maximum grade,Marking workflow state,"
        "Grade can be changed,Last modified (submission),Online text,Last modified (grade),Feedback comments"
    )
    line = 'Participant 7,Jane,,j@uni.example,ok,Team 1,Prof,,100.00,Not marked,Yes,-,"<p>a\n=b</p>",-,'
    filled = fill(worksheet(line, header=header), graded("x", moodle="7", feedback=COMMENT))
    assert cells(filled)[1][7] == "58.50"
    assert cells(filled)[1][12:] == ["<p>a\n=b</p>", "-", COMMENT]


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"", "not a grading worksheet.*has: nothing"),
        (worksheet(), "not a grading worksheet"),
        (b"Student,ID,SIS Login ID,Section,Lab 6 (1)\nJane,1,ab1,A,\n", "not a grading worksheet.*'Student', 'ID'"),
        (
            b'Identifier,Full name,Grade,Scale\nParticipant 1,Jane,,"poor\ngood"\n',
            "no number as the maximum grade after 'Grade'",
        ),
        (b"Identifier,Full name,Grade,Maximum grade\nParticipant 1,Jane,,\n", "no number as the maximum grade"),
        (b"Identifier,Full name,Grade\nParticipant 1,Jane\n", "no number as the maximum grade after 'Grade'"),
        (b"Tunniste,Nimi,Arvosana\nOsallistuja 1,Jane,\n", "cannot detect the column.*'Arvosana'"),
    ],
)
def test_other_files_are_refused(data: bytes, words: str) -> None:
    """A file that is no worksheet, or has a scale, is refused in one sentence that lists the headers."""
    with pytest.raises(InputError, match=words) as raised:
        fill(data)
    assert "\n" not in str(raised.value)


def test_missing_columns() -> None:
    """A named column must exist."""
    with pytest.raises(InputError, match=r"no column 'Mark'.*'Grade'"):
        fill(worksheet(row(1)), column="Mark")
    with pytest.raises(InputError, match="no column 'Notes'"):
        fill(worksheet(row(1)), feedback_column="Notes")


def test_warnings() -> None:
    """Another maximum, and a file that must be uploaded with other settings, are reported."""
    assert fill(worksheet(row(1)), out_of="70", any_maximum=True).preflight.warnings == [
        "the maximum in Moodle is 100.00 points, and that of the rubric 70",
    ]
    data = b"Identifier;Grade;Maximum grade;Last modified (grade)\nParticipant 1;;100,00;-\n"
    assert fill(data).preflight.warnings == ["when you upload the file, choose semicolon and UTF-8"]


def test_another_maximum_is_refused() -> None:
    """9.33 of 100 would be 9.33 of 10, so it needs an option."""
    data = worksheet(row(1), row(2, maximum="10.00"))
    with pytest.raises(InputError) as raised:
        fill(data, graded("1", "9.33", moodle="1"))
    assert str(raised.value) == (
        "Moodle's 'Maximum Grade' is 10, but the rubric's maximum is 100: change the maximum in the LMS and export again,"
        " or pass --any-maximum to write the points unchanged"
    )
    assert fill(data, graded("1", "9.33", moodle="1"), any_maximum=True).preflight.filled == 1


RUBRIC = lab()


def result(name: str, outcome: Outcome, because: str | None = None, ruling: ManualMark | None = None) -> Result:
    (criterion,) = [criterion for criterion in RUBRIC.criteria if criterion.id == name]
    return Result(criterion, outcome, because, "", ruling)


def skipped(name: str, because: str = "loads", ruling: ManualMark | None = None) -> Result:
    return result(name, Outcome("skipped", f"not decided, because {because} failed"), because, ruling)


def test_feedback_is_grouped_by_cause() -> None:
    """Criteria that are skipped or pending for one reason are one item; messages begin with a capital."""
    loads = result("loads", Outcome("failed", "the file has no root"))
    text = feedback_html(
        Decimal(0), Decimal(11), list(feedback_items([loads, *map(skipped, ("box", "tall", "essay"))]))
    )
    assert re.findall("<li>(.*?)</li>", text) == [
        "About loads: 0 of 3. The file has no root",
        "3 criteria were skipped because loads failed: 0 of 7.",
    ]
    pending = Outcome("pending", "nobody can tell; needs manual grading")
    assert list(feedback_items([result(name, pending) for name in ("box", "tall")])) == [
        FeedbackItem(
            "2 criteria need manual grading",
            Decimal(0),
            Decimal(3),
            "Nobody can tell; needs manual grading",
            is_open=True,
        )
    ]


def test_items_with_their_own_cause_stay_separate() -> None:
    """A single skip, a question with its model answer, a manual comment, and criteria with full points."""
    asks = Outcome("pending", "a person has to mark it", "this", "that")
    found = [
        result("loads", Outcome("passed", "fine")),
        skipped("box", ruling=ManualMark(Decimal(1), "me", "nice try")),
        skipped("tall", "box"),
        result("essay", asks),
        result("picture", asks._replace(measured='xyz="0" is off', message='xyz="0" is off')),
    ]
    assert [(item.title, item.message) for item in feedback_items(found)] == [
        ("About box", "nice try"),
        ("About tall", "Not decided, because box failed"),
        ("About essay", "A person has to mark it"),
        ("About picture", 'xyz="0" is off'),
    ]


def test_feedback_that_an_editor_reformatted() -> None:
    """The same words in other tags and spaces are still recognised; other words are not."""
    assert is_own_feedback(COMMENT.replace("<p>", "<p dir='ltr'>\n ").replace("</li>", "</li>\n"))
    assert not is_own_feedback(COMMENT.replace("too low", "far too low"))
    assert not is_own_feedback("Graded automatically: 3 of 4 points.")
    assert not is_own_feedback("")


def test_feedback_is_limited() -> None:
    """A long comment says how many items it omits."""
    remarks = [FeedbackItem(f"Criterion {n}", Decimal(0), Decimal(1), "x" * 200) for n in range(90)]
    text = feedback_html(Decimal(0), Decimal(90), remarks)
    shown = text.count("Criterion")
    assert 10 < shown < 90
    assert f"<li>... and {90 - shown} more</li></ul>" in text
    assert len(text) <= LIMIT


REMARKS = st.builds(
    FeedbackItem, st.text(max_size=900), st.decimals(-5, 5, places=2), st.just(Decimal(5)), st.text(max_size=900)
)


@given(st.lists(REMARKS, max_size=8))
def test_feedback_is_always_safe(remarks: list[FeedbackItem]) -> None:
    """Any text gives one line within the limit, with only the grader's tags, no formula, and is recognised again."""
    text = feedback_html(Decimal(1), Decimal(2), remarks)
    assert len(text) <= LIMIT
    assert text.splitlines() == [text]
    assert neutral(text) == text
    assert set(re.findall(r"</?\w+", text)) <= {"<p", "</p", "<ul", "</ul", "<li", "</li"}
    assert "\\" not in text
    assert is_own_feedback(text)
    assert is_own_feedback(text.encode("cp1252", "xmlcharrefreplace").decode("cp1252"))
    text.encode("utf-8")


NAMES = st.text(st.sampled_from("aé=+-@\"',;\n\t 😀\u202eשא\\<>"), min_size=1, max_size=8)
