"""Numbers are read by urdfdom's rule, which is implemented here a second time, character by character."""

from fractions import Fraction
from math import inf, isclose

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.base.element_edits import format_number as written_number
from grader.ros.urdf.numbers import NumberError, number, numbers, rgba, vector, version_in
from tests.examples import examples
from tests.work import limited_work

_SPACE = " \t\n\v\f\r"
_DIGITS = "0123456789"


def expected_number(text: str) -> float | None:
    r"""Return a number by the rule: `[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?` in ASCII, white space before, none after."""
    rest = text.lstrip(_SPACE)
    sign = -1 if rest[:1] == "-" else 1
    rest = rest[1:] if rest[:1] in ("+", "-") else rest
    whole = rest[: len(rest) - len(rest.lstrip(_DIGITS))]
    rest = rest[len(whole) :]
    part = ""
    if rest[:1] == ".":
        rest = rest[1:]
        part = rest[: len(rest) - len(rest.lstrip(_DIGITS))]
        rest = rest[len(part) :]
    if not whole and not part:
        return None
    power = 0
    if rest[:1] in ("e", "E"):
        rest = rest[1:]
        negative = rest[:1] == "-"
        rest = rest[1:] if rest[:1] in ("+", "-") else rest
        if not rest or rest.strip(_DIGITS):
            return None
        power = -int(rest) if negative else int(rest)
        rest = ""
    if rest:
        return None
    digits = int(whole + part or "0")
    if digits == 0:
        return sign * 0.0
    power -= len(part)
    if abs(power) > 100_000:
        return None if power > 0 else sign * 0.0
    try:
        return float(sign * digits * Fraction(10) ** power)
    except OverflowError:
        return None


def expected_numbers(text: str) -> list[float] | None:
    """Split at U+0020 only, ignoring empty pieces; every piece is a number."""
    values = [expected_number(piece) for piece in text.split(" ") if piece]
    known = [value for value in values if value is not None]
    return known if len(known) == len(values) else None


def read(text: str) -> float | None:
    """Return the result of `number` for a text."""
    try:
        return number(text)
    except NumberError:
        return None


def read_vector(text: str) -> tuple[float, float, float] | None:
    """Return the result of `vector` for a text."""
    try:
        return vector(text)
    except NumberError:
        return None


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.1 + 0.2, "0.3"),
        (-0.0, "0"),
        (1e-9, "1e-09"),
        (1e-14, "0"),
        (1e-5, "0.00001"),
        (12345678.0, "12345678"),
        (inf, "inf"),
    ],
)
def test_numbers_are_written_as_a_person_would(value: float, text: str) -> None:
    """In few characters, without an exponent unless the number is tiny, as those of an inertia are."""
    assert written_number(value) == text


_relevant = st.text(
    "0123456789+-.eE \t\n\r\v\f,xXnNaAiIfF_$u\u00a0\u2212\u0661\uff11\x1f\x85\u2028\udc80",
    max_size=12,
)
_digits = st.text(_DIGITS, max_size=4)
_likely = st.builds(
    "".join,
    st.tuples(
        st.sampled_from(("", " ", "\t", "\n", "  ")),
        st.sampled_from(("", "+", "-", "--", "\u2212")),
        _digits,
        st.sampled_from(("", ".", ",", "..")),
        _digits,
        st.sampled_from(("", "e", "E", "e+", "e-", "E-", "ee")),
        _digits,
        st.sampled_from(("", "", "", " ", "\t", "\n", "f", "\0", "\x1c")),
    ),
)


@examples(60)
@given(text=_relevant | _likely)
@example(text="1.7976931348623157e308")
@example(text="1.7976931348623159e308")
@example(text="1e-400")
@example(text="4.9e-324")
@example(text="2.4e-324")
@example(text="9007199254740993")
@example(text="0.1000000000000000055511151231257827021181583404541015625")
@example(text="1" * 308)
@example(text="1" * 310)
@example(text="." + "0" * 400 + "1e401")
@example(text="1" * 400 + "e-400")
@example(text="0e999999999")
@example(text="-0")
def test_number_follows_the_rule(text: str) -> None:
    """The same texts are numbers, with exactly the same value; for others the reason is a NumberError."""
    expected, actual = expected_number(text), read(text)
    assert repr(actual) == repr(expected)


@examples(60)
@given(text=st.lists(_likely | _relevant | st.just("1"), max_size=5).map(" ".join))
@example(text="1 2 3")
@example(text="  1   2 3  ")
@example(text="1\t2\t3")
@example(text="1 2\t 3")
@example(text="1 2 \t3")
@example(text="1, 2, 3")
@example(text="1 2 3 4")
@example(text="1 2")
@example(text="")
@example(text=" ")
@example(text="1 2 1e400")
@example(text="1 2 " + "9" * 400)
def test_vector_follows_the_rule(text: str) -> None:
    """Three numbers between spaces, and nothing else."""
    expected, actual = expected_numbers(text), read_vector(text)
    if expected is None or len(expected) != 3:
        assert actual is None
    else:
        assert repr(actual) == repr(tuple(expected))


@examples(60)
@given(text=st.lists(_likely | _relevant, max_size=5).map(" ".join))
def test_lists_of_any_length(text: str) -> None:
    """`numbers` accepts any count; `rgba` only channels in 0..1, and distinguishes a wrong count from a wrong number."""
    expected = expected_numbers(text)
    try:
        assert repr(numbers(text)) == repr(expected)
    except NumberError:
        assert expected is None
    try:
        colour = rgba(text)
    except NumberError:
        assert expected is None or not all(0 <= value <= 1 for value in expected)
    else:
        assert expected is not None
        assert all(0 <= value <= 1 for value in expected)
        assert colour == (tuple(expected) if len(expected) == 4 else None)


@given(text=st.text(max_size=30) | _relevant)
def test_only_number_errors_are_raised(text: str) -> None:
    """Any text is a number, or refused with a printable reason of one line."""
    for function in (number, vector, rgba, numbers):
        try:
            function(text)
        except NumberError as error:
            assert str(error)
            assert str(error).encode()
            assert "\n" not in str(error)
    version_in(text)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "empty"),
        (" ", "empty"),
        ("1,5", "comma"),
        ("1, 2", "comma"),
        ("${pi}", "xacro"),
        ("1 ", "^(?!.*tab).*space"),
        ("1\t", "tab or a line break"),
        ("\u22121", "ASCII"),
        ("1\u00a0", "ASCII"),
        ("\u201c1\u201d", "typographic quote"),
        ("pi/2", "'pi/2' is not a number"),
        ("nan", "'nan' is not a number"),
        ("1e400", "too large"),
        ("0x10", "'0x10' is not a number"),
        ("90deg", "'90deg' is not a number"),
    ],
)
def test_reasons(text: str, reason: str) -> None:
    """The message says what is wrong with the text."""
    with pytest.raises(NumberError, match=reason):
        number(text)


@pytest.mark.parametrize("count", [0, 1, 2, 4, 7])
def test_a_wrong_count_is_reported(count: int) -> None:
    """The message says how many numbers there are and how many are needed."""
    with pytest.raises(NumberError, match=f"^it has {count} numbers?, expected 3"):
        vector(" ".join(["1"] * count))


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        "1" * 1_000_000 + "x",
        "1" * 1_000_000,
        "0." + "1" * 1_000_000,
        "." * 1_000_000,
        "\t" * 1_000_000 + "x",
        "1e" * 500_000,
    ],
    ids=["digits-and-x", "digits", "fraction", "dots", "tabs-and-x", "exponents"],
)
def test_long_texts_take_linear_time(text: str) -> None:
    """A megabyte is read or refused at once, with a message that does not repeat it."""
    for function in (number, vector, rgba):
        with limited_work(1_000):
            try:
                function(text)
            except NumberError as error:
                assert len(str(error)) < 500


@given(value=st.floats(allow_nan=False, allow_infinity=False))
def test_python_writes_what_ros_reads(value: float) -> None:
    """A float's repr is a number with the same value; so are three of them."""
    assert number(repr(value)) == value
    assert vector(f"{value!r} {value:.17g} {value:.16e}") == (value, value, value)
    assert isclose(number(f"{value:.6e}"), value, rel_tol=1e-6, abs_tol=1e-323)


def test_versions() -> None:
    """Two numbers that C's strtol reads, with a point between; a last point counts for nothing."""
    for text in ("1.0", " 1.0", "01.00", "+1.0", "1.+0", "1.0.", f"1.{2**32}"):
        assert version_in(text) == (1, 0)
    assert version_in("1.1") == (1, 1)
    assert version_in("2.0") == (2, 0)
    refused = (
        "1",
        "",
        "1.0.0",
        "1.",
        ".0",
        "1.0 ",
        "a.b",
        "-1.0",
        "1,0",
        "1.0x",
        "\u0661.0",
    )
    assert [version_in(text) for text in refused] == [None] * len(refused)
