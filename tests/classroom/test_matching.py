"""Matching students: one table for every place that matches, and how names are compared."""

from collections.abc import Callable
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.gradebook.gradebook import Gradebook
from grader.classroom.gradebook.grades import Grades
from grader.classroom.gradebook.run_writer import save_student
from grader.classroom.intake.roster import Roster, RosterEntry
from grader.classroom.lms.filling import LmsStudent, match_rows
from grader.classroom.lms.grades import LmsGrade
from grader.classroom.lms.preflight import Preflight
from grader.classroom.matching import Clue, People, canvas_name, canvas_names, clues_of, plain_name, surname
from grader.classroom.students import Student
from grader.errors import InputError

ANN = Student("100", "Ann Ash", "ann@example.org", "aash", "s100")
BEA = Student("200", "Bea Ash", "bea@example.org", "bash", canvas="5", moodle="6")
CAL = Student("300", "José de la Cruz", "ann@other.example")
DEE = Student("400", "André Dee", "andr\u00e9@example.org")
CLASS = (ANN, BEA, CAL, DEE)

Matcher = Callable[[str], Student | None]


def in_roster(name: str) -> Student | None:
    """Return the student of a folder of this name."""
    path = Roster(map(RosterEntry, CLASS)).match(Student(name)).position
    return None if path is None else CLASS[path]


def in_a_team(name: str) -> Student | None:
    """Return the student of a folder of this name in the team of everybody."""
    found = Roster(RosterEntry(student, "red") for student in CLASS).match(
        Student(f"red/{name}", name, login=name, team="red")
    )
    return None if found.position is None else CLASS[found.position]


def in_lms(name: str) -> Student | None:
    """Return the student of a row of an LMS file that has this login, address and name."""
    row = LmsStudent(1, name, Student("", name, email=name, login=name))
    grade = join([row], [LmsGrade(student, Decimal(1)) for student in CLASS]).get(1)
    return grade.student if grade is not None else None


def join(rows: list[LmsStudent], grades: list[LmsGrade]) -> dict[int, LmsGrade]:
    """Return the grades by row number."""
    return match_rows(rows, grades, Preflight(""))


def in_gradebook(name: str, tmp_path: Path) -> Student | None:
    """Return the student that `grader mark` finds by this name."""
    with Gradebook(tmp_path / "book.db", create=True) as book:
        with book.transaction():
            for student in CLASS:
                save_student(book, student, None)
        try:
            return Grades(book).find(name).student
        except InputError:
            return None


SURE = [  # in every place
    *((name, ANN) for name in ("100", "aash", "s100", "ann@example.org", "Ann Ash", "ann  ash", "Ash, Ann", "Ann_Ash")),
    *((name, BEA) for name in ("200", "bash", "bea@example.org", "Ｂea Ash")),
    *((name, CAL) for name in ("JOSE\u0301 DE LA CRUZ", "de la Cruz, José", "\u200fJosé de la Cruz")),
    *((name, DEE) for name in ("andr\u00e9@example.org", "andre\u0301@example.org", "Andre\u0301 Dee")),
    *((name, None) for name in ("ann", "Jose de la Cruz", "An Ash", "zoe", "0100", "100 ~2")),
]


@pytest.mark.parametrize(("name", "student"), SURE)
@pytest.mark.parametrize("ask", [in_roster, in_a_team, in_lms])
def test_a_name_means_the_same_everywhere(ask: Matcher, name: str, student: Student | None) -> None:
    """A name means the same student as a folder, a folder of a team, or a row of an LMS file."""
    assert ask(name) == student


@pytest.mark.parametrize(("name", "student"), SURE)
def test_grader_mark_matches_the_same(name: str, student: Student | None, tmp_path: Path) -> None:
    """`grader mark` finds the same student by a name."""
    assert in_gradebook(name, tmp_path) == student


@pytest.mark.parametrize("name", ["AASH", "ANN@example.org"])
def test_case_never_matters(name: str, tmp_path: Path) -> None:
    """Logins and addresses may differ in case."""
    assert [ask(name) for ask in (in_roster, in_a_team, in_lms)] == [ANN] * 3
    assert in_gradebook(name, tmp_path) == ANN


@pytest.mark.parametrize(("name", "roster", "team"), [("bea", BEA, BEA), ("cruz", None, CAL), ("ash", None, None)])
def test_the_weakest_identifiers(name: str, roster: Student | None, team: Student | None) -> None:
    """The local part of an address counts for a folder, a surname in a team only, and neither in an LMS file."""
    assert (in_roster(name), in_a_team(name), in_lms(name)) == (roster, team, None)


def test_exact_case_takes_precedence() -> None:
    """Beside the exact name, another case matches nobody."""
    grades = [LmsGrade(Student(key), Decimal(1)) for key in ("alice", "ALICE")]
    found = join([LmsStudent(1, "alice", Student("", login="alice"))], grades)
    assert found[1].student.key == "alice"


def test_lms_numbers_take_precedence() -> None:
    """A number takes precedence over a name, and a name matches nobody whose number differs."""
    people = Roster(map(RosterEntry, CLASS))
    assert people.match(Student("x", "Ann Ash", canvas="5")).position == 1
    assert people.match(Student("x", moodle="6")).position == 1
    found = people.match(Student("x", "Bea Ash", moodle="7"))
    assert (found.position, found.doubt) == (None, "has the name of 200, but another number")


def test_unmatched_submissions_match_an_lms_by_number_only() -> None:
    """A folder named Ann Ash gets no row of an LMS file; one with the LMS's number does."""
    row = LmsStudent(1, "Ann Ash", Student("", "Ann Ash", login="aash", canvas="7"))
    unmatched = LmsGrade(Student("aash", "Ann Ash"), Decimal(1), is_on_roster=False)
    numbered = LmsGrade(Student("aash", "Ann Ash", canvas="7"), Decimal(1), is_on_roster=False)
    assert not join([row], [unmatched])
    assert join([row], [unmatched, LmsGrade(ANN, Decimal(2))])[1].student == ANN
    assert join([row], [numbered])[1] == numbered


@given(st.lists(st.sampled_from("abAB"), min_size=1, max_size=5), st.lists(st.sampled_from("abAB"), max_size=5))
def test_only_unique_pairs_match(rows: list[str], keys: list[str]) -> None:
    """A row has a grade exactly if one row and one student share its value, exactly or else ignoring case."""
    grades = [LmsGrade(Student(key, login=f"{key}{index}"), Decimal(index)) for index, key in enumerate(keys)]
    found = join([LmsStudent(index, row, Student("", login=row)) for index, row in enumerate(rows)], grades)
    for index, row in enumerate(rows):
        exact = [grade for grade in grades if grade.student.key == row]
        if rows.count(row) == 1 and len(exact) == 1:
            assert found[index] == exact[0]
        elif exact or keys.count(row.swapcase()) != 1 or rows.count(row) > 1:
            assert index not in found


def test_empty_identifiers_match_nothing() -> None:
    """An empty field is no identifier: two students without a number are not the same."""
    people = People([clues_of(Student("a")), clues_of(Student("b"))])
    assert set(people.clues[0]) == {Clue.EXACT_ID, Clue.ANY_CASE}
    assert people.find({Clue.EXACT_ID: ("",)}, (Clue.EXACT_ID,)).people == ()


@pytest.mark.parametrize(
    ("name", "form"),
    [
        ("Doe, Jane", "doejane"),
        ("O'Neil-Smith, Zoë", "oneilsmithzoë"),
        ("_12_, x", "12x"),
        ("לוי, עדה", "לויעדה"),
        ("!?", ""),
    ],
)
def test_names_in_canvas_files(name: str, form: str) -> None:
    """Lower-case letters, marks, digits and underscores of any script are kept."""
    assert canvas_name(name) == form


@given(st.lists(st.from_regex(r"[^\W_]{1,8}", fullmatch=True), min_size=1, max_size=6))
def test_canvas_may_sort_by_any_word(words: list[str]) -> None:
    """Wherever the surname begins, the sortable name is among the known ones."""
    forms = set(canvas_names(" ".join(words)))
    for index in range(len(words)):
        assert canvas_name(f"{' '.join(words[index:])}, {' '.join(words[:index])}") in forms


@given(st.text(max_size=30))
def test_normalisation_is_idempotent(name: str) -> None:
    """Normalising a name twice changes nothing, and both orders of a name are equal."""
    plain = plain_name(name.replace(",", " "))
    assert plain_name(plain) == plain
    assert plain_name("Ash, Ann") == plain_name("ann  ASH")
    assert surname("Ash, Ann") == surname("Ann Ash") == "ash"
