"""The line found for a key of a TOML file is the line that it is written on."""

import tomllib
from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.toml_file import TomlPath as Path
from grader.base.toml_file import find_line, key_lines
from tests.examples import examples

pytestmark = pytest.mark.slow


def test_a_missing_key_has_the_line_of_its_table() -> None:
    """A missing key has the line of its table, or the first line of the file, which an empty one has too."""
    lines = key_lines("[[part]]\nid = 1\nwith = { deep = [] }\n[[part]]\n")
    paths: tuple[Path, ...] = (
        ("part", 0, "points"),
        ("part", 0, "with", "deep", 3),
        ("part", 1, "title"),
        ("no",),
        (),
    )
    assert [find_line(lines, path) for path in paths] == [1, 3, 4, 1, 1]
    for text in ("", "\n", "# x", "\n\n# [a]\n"):
        assert key_lines(text) == {(): 1}


@pytest.mark.parametrize(
    "value",
    [
        "'''\n[a]\nb = 1\n'''",
        '"""\n[a]\n\\""" b = 1 \\\\"""',
        '"""\\\n   joined \\\n   """',
        "[\n1, # ]\n2,\n\n]",
        '[ [ "]" ], [ \'[\' ],\n[ "#" ] ]',
        '{ a = 1, b = [ { c = "}" } ] }',
        '"\\"#"',
        "1979-05-27T07:32:00-08:00",
        "''''''",
        '""""""',
        '"\\\\"',
        "'\\'",
        "'a\"b' # \"",
        "\"it's\" # it's",
        '"""a"""" # " \'',
        '"""a"""""',
        "'''a''''",
        "'''a'''''",
        '["""a"""", "["]',
        "['''a'''', '[']",
    ],
)
def test_keys_after_a_value_have_their_lines(value: str) -> None:
    """However a value is written, the next key and the next table have their own lines."""
    text = f"x = {value}\ny = 1\n\n[z]\nw = {value}\nv = 1\n"
    assert tomllib.loads(text)["z"]["v"] == 1
    lines, height = key_lines(text), value.count("\n")
    assert (lines["x",], lines["y",], lines["z",]) == (1, 2 + height, 4 + height)
    assert (lines["z", "w"], lines["z", "v"]) == (5 + height, 6 + 2 * height)


# --- Any text ---------------------------------------------------------------------------------------------------------

_TROUBLE = "ab \t\n\r\"'#[]{}=,.\\-1\u00e9\u2028\U0001f916"
_texts = st.text(_TROUBLE, max_size=12)
_comments = st.sampled_from(["", "", " # a comment", '\t# [x] = \' """ {', "#'''", "  "])
_bare = st.text("abcXYZ019_-", min_size=1, max_size=6)
_numbers = st.sampled_from(
    ["0", "-1", "+7", "1_000", "0xff", "0o7", "0b1", "1.5", "-2e-3", "6.5E+2", "inf", "-nan"]
)
_others = st.sampled_from(
    [
        "true",
        "false",
        "1979-05-27",
        "07:32:00.5",
        "1979-05-27T07:32:00Z",
        "1979-05-27 07:32:00-08:00",
    ]
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


_values = st.recursive(
    _simple, lambda inner: st.one_of(arrays(inner), inline_tables(inner)), max_leaves=6
)


@st.composite
def documents(draw: st.DrawFn) -> tuple[str, dict[Path, int]]:
    """Return a TOML text of tables, arrays of tables and keys, with the line of each."""
    text = ""
    written: dict[Path, int] = {}
    counts: dict[str, int] = {}
    names = iter(range(1000))

    def put(line: str, path: Path) -> None:
        nonlocal text
        text += "".join(
            draw(st.lists(st.sampled_from(["\n", "  \n", "# [c]\n", "\t# 'x\n"]), max_size=2))
        )
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


def paths_of(data: Any, path: Path = ()) -> Iterator[Path]:
    """Yield every path into a parsed document."""
    yield path
    if isinstance(data, dict):
        for key, value in data.items():
            yield from paths_of(value, (*path, key))
    elif isinstance(data, list):
        for index, value in enumerate(data):
            yield from paths_of(value, (*path, index))


@examples(40)
@given(documents(), st.booleans())
def test_every_key_has_its_line(document: tuple[str, dict[Path, int]], windows: bool) -> None:
    """Whatever surrounds it, a key has the line that it was written on, and a nested value has the line of its key."""
    text, written = document
    data = tomllib.loads(text)
    lines = key_lines(text.replace("\n", "\r\n") if windows else text)
    assert {path: find_line(lines, path) for path in written} == written
    for path in paths_of(data):
        known = path
        while known not in written and known:
            known = known[:-1]
        if known:
            assert find_line(lines, path) == written[known]
