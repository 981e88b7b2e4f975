"""A rubric that is not TOML: the message says what is wrong, where, and what to do, in one line for each mistake."""

from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grader.errors import RubricError
from grader.grading.rubric import shipped_rubrics
from grader.grading.toml_causes import CAUSES
from grader.grading.toml_errors import toml_mistakes
from grader.grading.toml_file import read_toml
from tests.command_line import run_with_input

HEAD = 'id = "lab"\ntitle = "Lab"\n'
BRACES = "a table in braces must be on one line: join the lines, or write it as a [table] after the other keys"
ESCAPE = "a backslash begins an escape such as \\n: write paths with /, or the string in single quotes"
HEADER = "the header of a table must be one name in brackets on both sides, such as [[criterion]]"
SIDES = "the header of a table needs brackets on both sides, such as [[criterion]]"
RETURN = "a line ends in a carriage return only: save the file with the line endings of Linux or Windows"
DATE = "write a date and time as 2026-11-20T23:59:00+01:00"
UNIT = "a number must not have a unit: write the number alone"
CALCULATE = "TOML has no expressions: write the result"
END = 'the string has no closing quote on its line: add it, or put a long string between """ and """'

# What follows the first two lines, and the complaint about it.
MISTAKES = [
    ('urdf = "robot.urdf', f"3:19: {END}"),
    ("urdf = 'robot.urdf", f"3:8: {END}"),
    ("urdf = 'robot.urdf\nabout = 'a'", f"3:19: {END}"),
    ("requires = [", "4:1: the list that begins on line 3 has no closing ]"),
    ('urdf = robot.urdf"', "3:8: the string has no opening quote"),
    ('about = The left wheel"', "3:9: the string has no opening quote"),
    ('with = { link = lidar", on = "base" }', "3:17: the string has no opening quote"),
    ("points = = 1", "3:10: write = only once"),
    ("with = link = 'a' }", "3:8: write a table in braces, such as { key = 1 }"),
    ("points = ?", "3:10: this is not a TOML value: ?"),
    ("with = { \\a = 1 }", "3:10: there is no key here: \\a = 1 }"),
    ("urdf = robot", '3:8: a string needs quotes: write "robot"'),
    ("about = The left wheel # big", '3:9: a string needs quotes: write "The left wheel"'),
    ("requires = [box, wheel]", '3:13: a string needs quotes: write "box"'),
    ("folders = [“Lab 6”]", "3:12: “ is not a TOML quote: write straight quotes, \" or '"),
    ("urdf = ‘robot.urdf’", "3:8: ‘ is not a TOML quote: write straight quotes, \" or '"),
    ('urdf = "robot.urdf”', "3:20: ” does not close a string: write a straight quote, \" or '"),
    ("urdf = `a`", "3:8: a string needs straight quotes, \" or '"),
    (
        'feedback = "say "no" to it"',
        '3:18: there is a quote inside the string: write it as \\", or the string in single quotes',
    ),
    ("feedback = 'it's'", "3:16: there is a quote inside the string: write the string in double quotes"),
    ('feedback = """Look.\nurdf = "a"', "3:12: the string that begins here has no end: close it with three quotes"),
    ("feedback = '''Look.\n", "3:12: the string that begins here has no end: close it with three quotes"),
    ('a = """Look.\nb = """Look."""', '4:8: there is text after """: does a string above lack its closing """?'),
    ('feedback = ""Look.\nTwice."""', '3:14: a long string must begin with three quotes, """'),
    ('feedback = "Look \\\ntwice."', '4:1: a string over several lines must begin and end with """'),
    ('a = """Look.""\nb = """Look."""', '4:8: there is text after """: does a string above lack its closing """?'),
    ('reference = "C:\\Users\\me"', f"3:18: {ESCAPE}"),
    ('reference = "labs\\solution"', f"3:20: {ESCAPE}"),
    ("size = [1 2]", "3:11: a comma is missing before 2"),
    ('requires = ["a" "b"]', '3:17: a comma is missing before "b"'),
    ('requires = [\n  "a"\n  "b b"\n]', '5:3: a comma is missing before "b b"'),
    ("size = [1,, 2]", "3:11: there is no value before ,"),
    ("size = [1, 2\nurdf = 'a'", "4:1: the list that begins on line 3 has no closing ]"),
    ("size = [1, 2\n\n[[part]]", "5:1: the list that begins on line 3 has no closing ]"),
    ('joints = ["a": "b"]', "3:14: a list must not contain keys: write a table in braces, such as { key = 1 }"),
    ("size = (1, 2)", "3:8: write a list in square brackets, such as [0, 1]"),
    ('with = { link = "a" tolerance = 2 }', "3:21: a comma is missing before tolerance"),
    ("with = { a = 1 2 }", "3:16: the table in braces has no closing }, or a comma is missing"),
    ("with = { a = 1, }", "3:17: remove the comma before }"),
    ("with = {\n  a = 1,\n}", f"3:9: {BRACES}"),
    ("with = { a = 1,  # metres\n  b = 2 }", f"3:18: {BRACES}"),
    ("with = { a = 1\n  b = 2 }", f"3:15: {BRACES}"),
    ("with = { a: 1 }", "3:11: write = instead of :"),
    ("with = { a = 1, a = 2 }", "3:22: the table in braces has the key a twice"),
    ("with = { a = 1, a.b = 2 }", "3:24: the table in braces has a key twice: remove one of the two"),
    ('id = "b"', "3:1: the key id is already on line 1: remove one of the two"),
    ("[[part]]\nid = 'a'\ntitle = 'A'\nid = 'b'", "6:1: the key id is already on line 4: remove one of the two"),
    (
        "[[criterion]]\nwith = { a = 1 }\n[criterion.with]",
        "5:1: the table [criterion.with] is already on line 4: join the two",
    ),
    ("with.a = 1\nwith = { b = 2 }", "4:1: the key with is already on line 3: remove one of the two"),
    ("[late]\na = 1\n[late]", "5:1: the table [late] is already on line 3: join the two"),
    (
        "[criterion]\na = 1\n[criterion]",
        "5:1: write [[criterion]] in double brackets: there are several (another is on line 3)",
    ),
    (
        "[criterion]\na = 1\n[[criterion]]",
        "3:1: write [[criterion]] in double brackets: there are several (another is on line 5)",
    ),
    ("[[part]]\na = 1\n[part]", "5:1: write [[part]] in double brackets: there are several (another is on line 3)"),
    (
        "[criterion]\na = 1\n[criterion",
        "5:1: write [[criterion]] in double brackets: there are several (another is on line 3)",
    ),
    ("[late]\na = 1\n[late", "5:1: the table [late] is already on line 3: join the two"),
    ("rigid = True", "3:9: write true instead of True"),
    ("with = { rigid = FALSE }", "3:18: write false instead of FALSE"),
    ("rigid = yes", "3:9: write true instead of yes"),
    ("rigid = None", "3:9: TOML has no None: remove the key"),
    ("points =", "3:9: points has no value"),
    ("points = # three", "3:10: points has no value"),
    ("with = { link = , on = 'a' }", "3:17: there is no value before ,"),
    ("points == 1", "3:9: write = only once"),
    ("points 3", "3:8: a = is missing after points"),
    ("points", "3:7: points has no = and no value"),
    ("points: 3", "3:7: write = instead of :"),
    ("my key = 3", "3:4: a key must be one word: there is a space after my"),
    ("höhe = 3", "3:2: a key may contain only the letters a to z, digits, _ and -: put any other key in quotes"),
    ("= 3", "3:1: there is no key before ="),
    ("- a", "3:3: a = is missing after -"),
    ("&a", "3:1: a line must be a key with = and a value, or the header of a table in brackets: &a"),
    ("[[part]", f"3:7: {HEADER}"),
    ("[part", f"3:6: {HEADER}"),
    ("[[my part]]", f"3:6: {HEADER}"),
    ("part]]", f"3:5: {SIDES}"),
    ("[ [part] ]", "3:3: write [[ and ]] without a space between the brackets"),
    ("[[part]] id = 'a'", "3:10: write id on a line of its own"),
    ("a = 1 b = 2", "3:7: write b on a line of its own"),
    ("a = 1,", "3:6: a line must not end in a comma or semicolon: remove it"),
    ("a = 1;", "3:6: a line must not end in a comma or semicolon: remove it"),
    ("a = 1]", "3:6: there is no opening bracket for this one: remove it"),
    ("a = 'b' c", "3:9: there is text after the end of the value: c"),
    ("// points", "3:1: a comment begins with #"),
    ("a = 1 // points", "3:7: a comment begins with #"),
    ("a = .5", "3:5: a number needs a digit before the point, such as 0.5"),
    ("a = 5.", "3:6: a number needs a digit after the point, such as 5.0"),
    ("a = 0,5", "3:6: write a decimal point instead of a comma, such as 0.5"),
    ("a = 07", "3:6: a number must not begin with 0"),
    ("a = 10%", f"3:7: {UNIT}"),
    ("a = 2 mm", f"3:7: {UNIT}"),
    ("a = 1/2", f"3:6: {CALCULATE}"),
    ("rpy = [0, pi/2, 0]", f"3:11: {CALCULATE}"),
    ("due = 2026-11-20 23:59", f"3:18: {DATE}"),
    ("due = 20.11.2026", f"3:12: {DATE}"),
    ("due = 2026-13-20T23:59:00Z", f"3:11: {DATE}"),
    ("a =\u00a01", "3:4: there is an invisible character, U+00A0: delete it, and type a space if one belongs here"),
    ('a = "b\x0bc"', "3:7: there is a control character, U+000B: delete it"),
    ("a = 1\rb = 2", f"3:6: {RETURN}"),
    ("# a\rb", f"3:4: {RETURN}"),
    ('a = "b\0c"', "3:7: there is a null byte: save the file as UTF-8 text"),
    (
        "<<<<<<< HEAD\na = 1",
        "3:1: this is a git merge conflict marker: keep one of the two versions and remove the markers",
    ),
    ('a = "\\ud800"', '3:12: escaped character is not a Unicode scalar value: a = "\\ud800"'),
]


def complaints(folder: Path, data: bytes) -> list[str]:
    """Return the mistakes that the command line reports, without the name of the file; nothing else is printed."""
    (folder / "lab.toml").write_bytes(data)
    done = run_with_input(("rubric", "check", "lab.toml"), b"", folder=folder)
    assert (done.returncode, done.stdout) == (2, b"")
    lines = done.stderr.decode().removesuffix("\n").split("\n")
    assert all(line.startswith("grader: lab.toml:") for line in lines)
    return [line.removeprefix("grader: lab.toml:") for line in lines]


@pytest.mark.parametrize(("text", "expected"), MISTAKES, ids=[text for text, _ in MISTAKES])
def test_a_common_mistake_is_explained(text: str, expected: str, tmp_path: Path) -> None:
    """The line has the place, what is wrong, and what to do."""
    assert complaints(tmp_path, f"{HEAD}{text}\n".encode()) == [expected]


def test_every_cause_is_tested() -> None:
    """Each cause of the table explains a mistake above."""
    starts = {cause.message.partition("{")[0].strip() or cause.message.rpartition("}")[2] for cause in CAUSES}
    for start in starts:
        assert any(start.replace("}}", "}") in expected for _, expected in MISTAKES), start


def test_several_mistakes_are_reported_at_once(tmp_path: Path) -> None:
    """A mistake in one line hides no others; each has its own line in the file and in the output."""
    text = '\n[[part]]\nid = a\ntitle = "A\n[[criterion]]\npoints = 1,5\r\nsize = [1 2]\nwith = {\na = 1 2\n}\n'
    assert complaints(tmp_path, (HEAD + text).encode()) == [
        '5:6: a string needs quotes: write "a"',
        f"6:11: {END}",
        "8:11: write a decimal point instead of a comma, such as 0.5",
        "9:11: a comma is missing before 2",
        f"10:9: {BRACES}",
    ]
    assert len(complaints(tmp_path, b"a = b\n" * 100)) == 20


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (HEAD.encode("utf-16"), " this is UTF-16 text; save it as UTF-8"),
        (b"\xfe\xff" + HEAD.encode("utf-16-be"), " this is UTF-16 text; save it as UTF-8"),
        (HEAD.encode("utf-16-le"), "1:2: there is a null byte: save the file as UTF-8 text"),
        (f"{HEAD}about = 'höhe'".encode("latin-1"), "3: this is not UTF-8 text; save it as UTF-8"),
        (HEAD.replace("\n", "\r").encode(), f"1:11: {RETURN}"),
        (b"a = " + b"[" * 5000, " lists or tables are nested too deeply"),
        (b"a = " + b"9" * 5000, " a number has too many digits"),
        (b"a = 1e" + b"9" * 30, " a number has too many digits"),
    ],
)
def test_other_files_are_refused(data: bytes, expected: str, tmp_path: Path) -> None:
    """Another encoding, other line endings and extreme values are named."""
    assert complaints(tmp_path, data) == [expected]


def test_what_editors_write_is_accepted(tmp_path: Path) -> None:
    """A byte order mark, the line endings of Windows and tabs are not mistakes."""
    text = b"\xef\xbb\xbf" + f"{HEAD}about = 'a\tb'\n\t[late]\n".replace("\n", "\r\n").encode()
    assert list(read_toml(text, tmp_path)[1]) == ["id", "title", "about", "late"]


def test_long_lines_take_no_time() -> None:
    """The search for a cause is bounded: a line of a million characters is explained at once."""
    for text in (
        "a = " + "b" * 1_000_000,
        "b" * 1_000_000 + " c",
        'a = "' + '"b" ' * 250_000,
        "a = [" + "1 " * 500_000,
    ):
        (mistake,) = toml_mistakes(text)
        assert mistake.line == 1
        assert len(mistake.message) < 400


SHIPPED = next(iter(shipped_rubrics().values())).read_text(encoding="utf-8")[:3000]


@settings(deadline=None, max_examples=150)
@given(st.integers(0, len(SHIPPED)), st.integers(0, 3), st.text("\"'[]{}=,.\n\r#\\ aT1“\0\u00a0", max_size=3))
def test_no_text_is_a_crash(at: int, deleted: int, inserted: str) -> None:
    """Whatever a typing error does to a rubric, it is TOML, or there is at least one complaint, each with a place."""
    text = SHIPPED[:at] + inserted + SHIPPED[at + deleted :]
    try:
        read_toml(text.encode(), Path("lab.toml"))
    except RubricError as error:
        mistakes = toml_mistakes(text)
        assert len(error.complaints) == len(mistakes) > 0
        height = text.count("\n") + 1
        assert all(1 <= mistake.line <= height and mistake.column >= 1 for mistake in mistakes)
        assert all(mistake.message.isprintable() for mistake in mistakes)
