"""The line found for a key of a TOML file is the line that it is written on."""

import tomllib
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grader.grading.toml_file import TomlPath as Path
from grader.grading.toml_file import key_lines, line_of


def test_tables_and_keys_have_lines() -> None:
    """Headers, their keys, and arrays of tables are found; lines count from 1, indices from 0."""
    text = """
id = "r"

[[part]]
id = "a"
[[part]]  # the second
id = "b"

[[criterion]]
  id = "c"
  [criterion.with]
  link = "l"
  [criterion.with.joints]
  j = "l"
[[criterion]]
id = "d"
[criterion.with]
link = "m"
[other]
x = 1
"""
    expected: dict[Path, int] = {
        (): 1,
        ("id",): 2,
        ("part", 0): 4,
        ("part", 0, "id"): 5,
        ("part", 1): 6,
        ("part", 1, "id"): 7,
        ("criterion", 0): 9,
        ("criterion", 0, "id"): 10,
        ("criterion", 0, "with"): 11,
        ("criterion", 0, "with", "link"): 12,
        ("criterion", 0, "with", "joints"): 13,
        ("criterion", 0, "with", "joints", "j"): 14,
        ("criterion", 1): 15,
        ("criterion", 1, "id"): 16,
        ("criterion", 1, "with"): 17,
        ("criterion", 1, "with", "link"): 18,
        ("other",): 19,
        ("other", "x"): 20,
    }
    lines = key_lines(text)
    assert {path: line_of(lines, path) for path in expected} == expected


@pytest.mark.parametrize(
    ("path", "line"),
    [
        (("part", 0, "id"), 2),
        (("part", 0, "points"), 1),
        (("part", 0, "with", "deep", 3), 3),
        (("part", 1, "title"), 4),
        (("nothing",), 1),
        ((), 1),
    ],
)
def test_a_missing_key_has_the_line_of_its_table(path: Path, line: int) -> None:
    """A missing key has the line of its table, or the first line of the file."""
    assert line_of(key_lines("[[part]]\nid = 1\nwith = { deep = [] }\n[[part]]\n"), path) == line


@pytest.mark.parametrize(
    "value",
    [
        "'''\n[a]\nb = 1\n'''",
        '"""\n[a]\n\\""" b = 1 \\\\"""',
        '"""\\\n   joined \\\n   """',
        "[\n1, # ]\n2,\n\n]",
        '[ [ "]" ], [ \'[\' ],\n[ "#" ] ]',
        '{ a = 1, b = [ { c = "}" } ] }',
        "'#'",
        '"\\"#"',
        "1979-05-27T07:32:00-08:00",
        "1.5e-3",
        "''''''",
        '""""""',
        '"\\\\"',
        "'\\'",
        "'a\"b' # \"",
        "\"it's\" # it's",
    ],
)
def test_keys_after_a_value_have_their_lines(value: str) -> None:
    """However a value is written, the next key and the next table have their own lines."""
    text = f"x = {value}\ny = 1\n\n[z]\nw = {value}\nv = 1\n"
    assert tomllib.loads(text)["z"]["v"] == 1
    lines, height = key_lines(text), value.count("\n")
    assert (lines["x",], lines["y",], lines["z",]) == (1, 2 + height, 4 + height)
    assert (lines["z", "w"], lines["z", "v"]) == (5 + height, 6 + 2 * height)


@pytest.mark.parametrize(
    "value",
    ['"""a""""', '"""a"""""', "'''a''''", "'''a'''''", '["""a"""", "["]', "['''a'''', '[']"],
)
def test_a_text_may_end_in_quotes(value: str) -> None:
    """One or two quotes before the closing three belong to the string."""
    text = f"x = {value} # \" '\ny = 1\n"
    assert set(tomllib.loads(text)) == {"x", "y"}
    assert key_lines(text)["y",] == 2


@pytest.mark.parametrize(
    ("key", "name"),
    [
        ("a", "a"),
        ("a-b_1", "a-b_1"),
        ("1", "1"),
        ('"a b"', "a b"),
        ("'a b'", "a b"),
        ('"a.b"', "a.b"),
        ('"a#b"', "a#b"),
        ('"["', "["),
        ('"="', "="),
        ('""', ""),
        ("'it\"s'", 'it"s'),
        ("'\"quoted\"'", '"quoted"'),
        ("\"'quoted'\"", "'quoted'"),
        ('"\\u0061"', "a"),
        ('"a\\"b"', 'a"b'),
        ('"tab\\t"', "tab\t"),
    ],
)
def test_a_key_may_be_quoted(key: str, name: str) -> None:
    """A quoted key is the text in the quotes, on a line of its own and in a header."""
    text = f"\n{key} = 1\n\n[t . {key}] # ]\nx = 1\n[[ u ]]\n{key} = 2\n"
    assert tomllib.loads(text) == {name: 1, "t": {name: {"x": 1}}, "u": [{name: 2}]}
    lines = key_lines(text)
    assert (lines[name,], lines["t", name], lines["t", name, "x"]) == (2, 4, 5)
    assert (lines["u", 0], lines["u", 0, name]) == (6, 7)


def test_implicit_tables_have_the_line_of_the_first_below_them() -> None:
    """A table that is only part of a longer header has the line of the first such header."""
    text = "a.b.c = 1\na.d = 2\n[x.y]\nz.w = 1\n[x.v]\n[[l]]\nm.n = 1\n"
    lines = key_lines(text)
    assert (line_of(lines, ("a",)), line_of(lines, ("a", "b")), line_of(lines, ("a", "d"))) == (1, 1, 2)
    assert (line_of(lines, ("x",)), line_of(lines, ("x", "y", "z")), line_of(lines, ("x", "v"))) == (3, 4, 5)
    assert (line_of(lines, ("l",)), line_of(lines, ("l", 0, "m"))) == (6, 7)


def test_nested_arrays_of_tables_are_counted_separately() -> None:
    """An inner array restarts in every outer table, and the outer one continues after it."""
    text = "[[a]]\n[[a.b]]\nx = 1\n[[a.b]]\ny = 1\n[a.b.c]\nz = 1\n[[a]]\n[[a.b]]\nw = 1\n[d]\n[[d.e]]\nv = 1\n"
    lines = key_lines(text)
    expected: dict[Path, int] = {
        ("a", 0): 1,
        ("a", 0, "b", 0): 2,
        ("a", 0, "b", 0, "x"): 3,
        ("a", 0, "b", 1): 4,
        ("a", 0, "b", 1, "y"): 5,
        ("a", 0, "b", 1, "c"): 6,
        ("a", 0, "b", 1, "c", "z"): 7,
        ("a", 1): 8,
        ("a", 1, "b", 0): 9,
        ("a", 1, "b", 0, "w"): 10,
        ("d",): 11,
        ("d", "e", 0): 12,
        ("d", "e", 0, "v"): 13,
    }
    assert {path: line_of(lines, path) for path in expected} == expected


def test_an_empty_text_has_a_first_line() -> None:
    """Everything that is missing in an empty file has line 1."""
    for text in ("", "\n", "# x", "\n\n# [a]\n"):
        assert key_lines(text) == {(): 1}


# --- Any text ---------------------------------------------------------------------------------------------------------

_TROUBLE = "ab \t\n\r\"'#[]{}=,.\\-1\u00e9\u2028\U0001f916"
_texts = st.text(_TROUBLE, max_size=12)
_comments = st.sampled_from(["", "", " # a comment", '\t# [x] = \' """ {', "#'''", "  "])
_bare = st.text("abcXYZ019_-", min_size=1, max_size=6)
_numbers = st.sampled_from(["0", "-1", "+7", "1_000", "0xff", "0o7", "0b1", "1.5", "-2e-3", "6.5E+2", "inf", "-nan"])
_others = st.sampled_from(
    ["true", "false", "1979-05-27", "07:32:00.5", "1979-05-27T07:32:00Z", "1979-05-27 07:32:00-08:00"]
)


def basic(text: str) -> str:
    """Return a basic string on one line."""
    escapes = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}
    return '"' + "".join(escapes.get(character, character) for character in text) + '"'


def many_lines(text: str) -> str:
    """Return a multi-line basic string with its line endings; quotes are unescaped where possible."""
    safe = text.replace("\\", "\\\\").replace("\r", "\\r")
    return '"""' + safe.replace('"""', '""\\"') + ('"""' if not safe.endswith('"') else '\\n"""')


def literal(text: str) -> str:
    """Return a literal string, multi-line if needed; characters that it cannot contain are removed."""
    plain = text.replace("'", "").replace("\r", "")
    return f"'''\n{plain}'''" if "\n" in plain else f"'{plain}'"


_strings = st.one_of(_texts.map(basic), _texts.map(many_lines), _texts.map(literal))
_simple = st.one_of(_strings, _numbers, _others)
_gaps = st.sampled_from([" ", "", "\n", " # ] '\n", '\n\n\t# """\n', "\t"])


@st.composite
def arrays(draw: st.DrawFn, inner: st.SearchStrategy[str]) -> str:
    """Return an array over one or many lines, with comments in it."""
    items = draw(st.lists(inner, max_size=3))
    inside = "".join(draw(_gaps) + item + draw(_gaps) + "," for item in items)
    return "[" + inside + draw(_gaps) + "]"


@st.composite
def inline_tables(draw: st.DrawFn, inner: st.SearchStrategy[str]) -> str:
    """Return an inline table with unique keys."""
    values = draw(st.lists(inner, max_size=3))
    return "{" + ", ".join(f" k{index} = {value}" for index, value in enumerate(values)) + " }"


_values = st.recursive(_simple, lambda inner: st.one_of(arrays(inner), inline_tables(inner)), max_leaves=6)


@st.composite
def documents(draw: st.DrawFn) -> tuple[str, dict[Path, int]]:
    """Return a TOML text of tables, arrays of tables and keys, with the line of each."""
    text = ""
    written: dict[Path, int] = {}
    counts: dict[str, int] = {}
    names = iter(range(1000))

    def put(line: str, path: Path) -> None:
        nonlocal text
        text += "".join(draw(st.lists(st.sampled_from(["\n", "  \n", "# [c]\n", "\t# 'x\n"]), max_size=2)))
        text += draw(st.sampled_from(["", "  ", "\t"]))
        written[path] = text.count("\n") + 1
        text += line + draw(_comments) + "\n"

    def key() -> tuple[str, str]:
        """Return a new name, and one way to write it."""
        name = f"{next(names)}x{draw(_bare)}"  # the number and its x are no other name's
        return draw(st.sampled_from([name, f'"{name}"', f"'{name}'", f' "{name}" '])), name

    def keys(table: Path) -> None:
        for value in draw(st.lists(_values, max_size=3)):
            shown, name = key()
            equals = draw(st.sampled_from(["=", " = ", "\t=  "]))
            put(shown + equals + value, (*table, name))

    keys(())
    for kind in draw(st.lists(st.sampled_from(["table", "array", "again", "below"]), max_size=6)):
        if kind == "table" or not counts:
            shown, name = key()
            array = kind == "array"
            counts |= {name: 0} if array else {}
            table: Path = (name, 0) if array else (name,)
            put(f"[[{shown}]]" if array else f"[{shown}]", table)
        elif kind == "array":
            shown, name = key()
            counts[name] = 0
            table = (name, 0)
            put(f"[[ {shown} ]]", table)
        elif kind == "again":
            name = draw(st.sampled_from(sorted(counts)))
            counts[name] += 1
            table = (name, counts[name])
            put(f'[["{name}"]]', table)
        else:
            name = draw(st.sampled_from(sorted(counts)))
            shown, inner = key()
            table = (name, counts[name], inner)
            put(f"[{name} . {shown}]", table)
        keys(table)
    return text, written


def value_at(data: Any, path: Path) -> Any:
    """Return the value of a parsed document at a path."""
    for step in path:
        data = data[step]
    return data


def paths_of(data: Any, path: Path = ()) -> Iterator[Path]:
    """Yield every path into a parsed document."""
    yield path
    if isinstance(data, dict):
        for key, value in data.items():
            yield from paths_of(value, (*path, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from paths_of(value, (*path, index))


@settings(deadline=None, max_examples=300)
@given(documents(), st.booleans())
def test_every_key_has_its_line(document: tuple[str, dict[Path, int]], windows: bool) -> None:
    """Whatever values, comments and blank lines surround it, a key has the line that it was written on."""
    text, written = document
    data = tomllib.loads(text)
    for path in written:
        value_at(data, path)
    lines = key_lines(text.replace("\n", "\r\n") if windows else text)
    assert {path: line_of(lines, path) for path in written} == written


@settings(deadline=None, max_examples=100)
@given(documents())
def test_every_path_has_a_line_inside_the_text(document: tuple[str, dict[Path, int]]) -> None:
    """A nested value has at least the line of its key, so every path has a line."""
    text, written = document
    lines = key_lines(text)
    for path in paths_of(tomllib.loads(text)):
        known = path
        while known not in written and known:
            known = known[:-1]
        if known:
            assert line_of(lines, path) == written[known]
