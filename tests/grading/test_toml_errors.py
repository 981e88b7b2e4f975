"""A rubric that is not TOML: the message says what is wrong, where, and what to do, in one line."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.errors import RubricError
from grader.grading.rubric import shipped_rubrics
from grader.grading.toml_file import read_toml
from tests.command_line import run_with_input
from tests.examples import examples

HEAD = 'id = "lab"\ntitle = "Lab"\n'
BRACES = "a table in braces must be on one line: join the lines, or write it as a [table] after the other keys"
END = 'the string has no closing quote on its line: add it, or put a long string between """ and """'
COMMA = "a comma is missing before {}, or a list above has no closing bracket"

# What follows the first two lines, and the complaint about it.
MISTAKES = [
    ('urdf = "robot.urdf', f"3:19: {END}"),
    ("urdf = 'robot.urdf\nabout = 'a'", f"3:19: {END}"),
    ('urdf = robot.urdf"', '3:8: a string needs quotes: write "robot.urdf"'),
    ('with = { link = lidar", on = "base" }', '3:17: a string needs quotes: write "lidar"'),
    ("urdf = robot", '3:8: a string needs quotes: write "robot"'),
    ("about = The left wheel # big", '3:9: a string needs quotes: write "The left wheel"'),
    ("requires = [box, wheel]", '3:13: a string needs quotes: write "box"'),
    ("rigid = True", "3:9: write true and false in lower case, not True"),
    ("with = { rigid = FALSE }", "3:18: write true and false in lower case, not FALSE"),
    ("rigid = Truest", '3:9: a string needs quotes: write "Truest"'),
    ("folders = [“Lab 6”]", "3:12: “ is not a TOML quote: write straight quotes, \" or '"),
    ("urdf = ‘robot.urdf’", "3:8: ‘ is not a TOML quote: write straight quotes, \" or '"),
    ('urdf = "robot.urdf”', "3:20: ” is not a TOML quote: write straight quotes, \" or '"),
    ("size = [1 2]", f"3:11: {COMMA.format(2)}"),
    ('requires = ["a" "b"]', "3:17: " + COMMA.format('"b"')),
    ('requires = [\n  "a"\n  "b b"\n]', "5:3: " + COMMA.format('"b b"')),
    ("size = [1, 2\nurdf = 'a'", f"4:1: {COMMA.format('urdf')}"),
    ("with = {\n  a = 1,\n}", f"3:9: {BRACES}"),
    ("with = { a = 1,  # metres\n  b = 2 }", f"3:18: {BRACES}"),
    ("with = { a = 1\n  b = 2 }", f"3:15: {BRACES}"),
]

# Any other mistake, and what tomllib says of it.
OTHERS = [
    ("points = ?", "3:10: invalid value: points = ?"),
    ("points =", "3:9: invalid value: points ="),
    ("points 3", "3:8: expected '=' after a key in a key/value pair: points 3"),
    ("a = 0,5", "3:6: expected newline or end of document after a statement: a = 0,5"),
    ('id = "b"', '3:9: cannot overwrite a value: id = "b"'),
    ("[late]\na = 1\n[late]", "5:6: cannot declare ('late',) twice: [late]"),
    ('reference = "C:\\Users"', '3:18: invalid hex value: reference = "C:\\Users"'),
    ("requires = [", "4:1: invalid value: an empty line"),
    ('feedback = """Look.\nurdf = "a"', "5:1: unterminated string: an empty line"),
    ("a =\u00a01", "3:4: invalid value: a =\\xa01"),
]


def complaints(folder: Path, data: bytes) -> list[str]:
    """Return the mistakes that the command line reports, without the name of the file; nothing else is printed."""
    (folder / "lab.toml").write_bytes(data)
    done = run_with_input(("rubric", "check", "lab.toml"), b"", folder=folder)
    assert (done.returncode, done.stdout) == (2, b"")
    lines = done.stderr.decode().removesuffix("\n").split("\n")
    assert all(line.startswith("grader: lab.toml:") for line in lines)
    return [line.removeprefix("grader: lab.toml:") for line in lines]


@pytest.mark.parametrize(("text", "expected"), MISTAKES + OTHERS, ids=[text for text, _ in MISTAKES + OTHERS])
def test_a_mistake_is_explained(text: str, expected: str, tmp_path: Path) -> None:
    """The line has the place, and what to do or what tomllib says."""
    assert complaints(tmp_path, f"{HEAD}{text}\n".encode()) == [expected]


@pytest.mark.parametrize(
    ("data", "expected"),
    [
        (HEAD.encode("utf-16"), " this is UTF-16 text; save it as UTF-8"),
        (b"\xfe\xff" + HEAD.encode("utf-16-be"), " this is UTF-16 text; save it as UTF-8"),
        (
            HEAD[:8].encode("utf-16-le"),
            "1:2: expected '=' after a key in a key/value pair: i\\x00d\\x00 \\x00=\\x00 \\x00\"\\x00l\\x00a\\x00",
        ),
        (f"{HEAD}about = 'höhe'".encode("latin-1"), "3: this is not UTF-8 text; save it as UTF-8"),
        (b"a = 1\rb = 2", "1:6: expected newline or end of document after a statement: a = 1\\x0db = 2"),
        (b"b = 1\n" + b"a." * 20_000 + b"a = 1", "2: a key has more than 20 parts"),
        (b"[" + b" 'a' ." * 20 + b"a]", "1: a key has more than 20 parts"),
        (b"b = { c = 1, " + b'"a".' * 20 + b"a = 1 }", "1: a key has more than 20 parts"),
        (b".".join([b'"\\""'] * 15_000) + b" = 1", "1: a key has more than 20 parts"),
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


def test_long_lines_are_cut(tmp_path: Path) -> None:
    """Only the text around the mistake is looked at and shown."""
    for text in ("a = " + "b" * 1_000_000, "b" * 1_000_000 + " c", "a = [" + "1 " * 500_000):
        (complaint,) = complaints(tmp_path, text.encode())
        assert complaint.startswith("1:")
        assert len(complaint) < 500


SHIPPED = next(iter(shipped_rubrics().values())).read_text(encoding="utf-8")[:3000]


@examples(20)
@given(st.integers(0, len(SHIPPED)), st.integers(0, 3), st.text("\"'[]{}=,.\n\r#\\ aT1“\0\u00a0", max_size=3))
def test_no_text_is_a_crash(at: int, deleted: int, inserted: str) -> None:
    """Whatever a typing error does to a rubric, it is TOML, or there is one complaint with a place."""
    text = SHIPPED[:at] + inserted + SHIPPED[at + deleted :]
    try:
        read_toml(text.encode(), Path("lab.toml"))
    except RubricError as error:
        (complaint,) = error.complaints
        _, line, column, what = complaint.split(":", 3)
        assert 1 <= int(line) <= text.count("\n") + 1
        assert int(column) >= 1
        assert what.isprintable()
