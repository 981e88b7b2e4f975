"""The student whom a person types: the only one who fits, or a list of those who do."""

import unicodedata
from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.classroom.roster.roster import Student
from grader.classroom.roster.typed_names import as_number, find_typed, number_in, read_points

pytestmark = pytest.mark.slow

ASH = Student("s1", "Ash, Ann Marie", "ann.ash@example.org", "aash", canvas="101")
BIRCH = Student("s2", "Jörg Birch-Müller", "JM@example.org", "jm2", moodle="77")
CEDAR = Student("s3", "Ann Cedar", "cedar@example.org", "cedar")
DOGWOOD = Student("s4", "Søren Strauß", login="MÜLLER-s4")
ELM = Student("elm bea_104")  # a folder of nobody on the roster
CLASS = (ASH, BIRCH, CEDAR, DOGWOOD, ELM)
ADVICE = "; advice"


@pytest.mark.parametrize(
    ("student", "names"),
    [
        (
            ASH,
            "Ann Marie Ash; Ash, Ann Marie; Ash, Ann; ann ash; ASH; Marie; aash; AASH; 101; ann.ash",
        ),
        (
            BIRCH,
            "Jörg Birch-Müller; Müller, Jörg; MÜLLER; jörg; birch; jm@Example.org; JM; 77; Jörg  müller",
        ),
        (CEDAR, "cedar; Ann Cedar; S3; cedar ann"),
        (DOGWOOD, "strauss; Strauß; søren; müller-S4"),
        (ELM, "bea; elm bea; elm bea_104"),
    ],
)
def test_the_only_student_who_fits(student: Student, names: str) -> None:
    """By id, login, address, number, and any words of the name, in any case and however accents are encoded."""
    for name in names.split("; "):
        for form in ("NFC", "NFD"):
            assert find_typed(CLASS, unicodedata.normalize(form, name), ADVICE) == student, name


@pytest.mark.parametrize(
    ("name", "why"),
    [
        (
            "Ann",
            "'Ann' is ambiguous: it may be 's1' (Ash, Ann Marie) or 's3' (Ann Cedar); use one of these ids",
        ),
        (
            "Jorg Birch-Muller",
            "there is no student 'Jorg Birch-Muller' in the gradebook; did you mean 'Jörg Birch-Müller'?",
        ),
        ("Cedr", "there is no student 'Cedr' in the gradebook; did you mean 'cedar'?"),
        ("102", "there is no student '102' in the gradebook; advice"),
        ("s5", "there is no student 's5' in the gradebook; advice"),
        ("MULLER-s5", "there is no student 'MULLER-s5' in the gradebook; advice"),
        (
            "MULLER-s4",
            "there is no student 'MULLER-s4' in the gradebook; did you mean 'MÜLLER-s4'?",
        ),
        ("Zelkova", "there is no student 'Zelkova' in the gradebook; advice"),
        ("", "there is no student '' in the gradebook; advice"),
        (",", "there is no student ',' in the gradebook; advice"),
        ("-", "there is no student '-' in the gradebook; advice"),
    ],
)
def test_who_is_not_found(name: str, why: str) -> None:
    """Several who fit are listed; a name that is close is suggested, but none with other digits."""
    with pytest.raises(InputError) as caught:
        find_typed(CLASS, name, ADVICE)
    assert str(caught.value) == why


def test_an_identifier_of_one_and_the_name_of_another() -> None:
    """A login that is the surname of another student finds neither."""
    with pytest.raises(
        InputError, match=r"it may be 's2' \(Jörg Birch-Müller\) or 's9' \(Zoe Zelkova\)"
    ):
        find_typed((*CLASS, Student("s9", "Zoe Zelkova", login="birch")), "birch", ADVICE)


@pytest.mark.parametrize(
    ("typed", "key"),
    [
        ("Fir, Li", "f1"),
        ("Li Fir", "f1"),
        ("Fir, Li Mei", "f2"),
        ("Li, Fir", "f3"),
        ("Mei", "f2"),
        ("li@example.org", "f4"),
        ("77", "f5"),
        ("li", "f6"),
    ],
)
def test_what_is_equal_comes_before_what_is_similar(typed: str, key: str) -> None:
    """Of names that contain each other, and of two in opposite orders, the exact one is meant."""
    students = [
        Student("f1", "Fir, Li"),
        Student("f2", "Fir, Li Mei"),
        Student("f3", "Li, Fir"),
        Student("f4", "Gum, 77", "li@example.org"),
        Student("f5", "li@example.org Hazel", canvas="77"),
        Student("f6", sis="li"),
    ]
    assert find_typed(students, typed, ADVICE).key == key
    with pytest.raises(InputError, match="is ambiguous"):
        find_typed(students, "Fir", ADVICE)


def test_two_students_of_one_name_are_ambiguous() -> None:
    """A whole name is exact for both."""
    students = [Student("g1", "Ivy, Jo"), Student("g2", "Jo Ivy")]
    with pytest.raises(InputError, match="'Jo Ivy' is ambiguous"):
        find_typed(students, "Jo Ivy", ADVICE)


def test_at_most_ten_are_listed() -> None:
    """The others are counted."""
    many = [Student(f"s{number:02}", f"Kim{number} Müller") for number in range(13)]
    with pytest.raises(
        InputError,
        match=r"it may be 's00' \(Kim0 Müller\), .*'s09' \(Kim9 Müller\).* 3 more; use one",
    ):
        find_typed(many, "Müller", ADVICE)


@given(st.text() | st.decimals(-1, 5, places=4).map(str))
def test_any_text_is_points_or_refused(text: str) -> None:
    """Any text is refused or gives points between 0 and the maximum, with at most 4 decimals."""
    try:
        points = read_points(text, "essay", Decimal("4.25"))
    except InputError:
        number = number_in(text)
        assert number is None or not 0 <= number <= Decimal("4.25") or number != round(number, 4)
        return
    assert 0 <= points <= Decimal("4.25") and points * 10_000 % 1 == 0 and not points.is_signed()


@given(
    st.integers(0, 10**12),
    st.integers(0, 3),
    st.sampled_from(("{}", "{}.0", "{},00", "{:.5E}", "{:.2E}")),
)
def test_ids_that_a_spreadsheet_changed(number: int, zeros: int, shown: str) -> None:
    """A number without its leading zeros, or rounded, may be that id; the id itself, and no other number, is none."""
    key = "0" * zeros + str(number)
    cell = shown.format(number)
    assert as_number(cell, ("zoe", key, str(number * 2 + 7))) == ([] if cell == key else [key])


def test_an_id_without_its_zeros_is_suggested() -> None:
    """It is no match."""
    with pytest.raises(
        InputError, match=r"there is no student '12' in the gradebook; did you mean '0012'\?"
    ):
        find_typed((*CLASS, Student("0012")), "12", ADVICE)
