"""YAML is read as PyYAML reads it, with the location of every value; no text makes it raise or grow."""

from contextlib import suppress
from itertools import islice
from typing import Any

import pytest
import yaml
from hypothesis import example, given
from hypothesis import strategies as st

from grader.ros.config.yaml_nodes import YamlFault, YamlNode, read_yaml
from tests.examples import examples
from tests.work import limited_work

TEXTS = st.text(st.characters(blacklist_categories=["Cs"]), max_size=12) | st.sampled_from(
    [
        "",
        "true",
        "1",
        "~",
        "null",
        "a: b",
        "- a",
        "#",
        "'",
        '"',
        "a\nb",
        "\n",
        " a ",
        "&a",
        "*a",
        "<<",
        "=",
        "é",
        "\u2028",
        "%",
    ]
)
VALUES = st.recursive(
    TEXTS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(TEXTS, inner, max_size=4),
    max_leaves=20,
)


def plain(node: YamlNode) -> Any:
    """Return a node's values without their locations."""
    if isinstance(node.value, dict):
        return {key: plain(item) for key, item in node.value.items()}
    return [plain(item) for item in node.value] if isinstance(node.value, list) else node.value


@examples(30)
@given(
    VALUES, st.booleans() | st.none(), st.sampled_from([None, "'", '"', "|", ">"]), st.booleans()
)
def test_agreement_with_pyyaml(
    value: Any, flow: bool | None, style: str | None, marked: bool
) -> None:
    """Structure and strings of any document equal those of PyYAML."""
    text = yaml.dump(
        value,
        Dumper=NoAliases,
        default_flow_style=flow,
        default_style=style,
        explicit_start=marked,
        allow_unicode=True,
    )
    assert plain(read_yaml(text.encode(), "a.yaml")) == yaml.load(text, Loader=yaml.BaseLoader)


class NoAliases(yaml.SafeDumper):
    """A dumper that writes equal values again instead of an alias."""

    def ignore_aliases(self, _: Any) -> bool:
        return True


@examples(30)
@given(
    st.binary(max_size=60) | st.text("[]{}:-,&*!|>'\"%@`#? \n\tab1\\", max_size=40).map(str.encode)
)
@example(b"a: *b")
@example(b"&a [*a]")
@example(b"? [a, b]\n: c")
@example(b"? {a: b}\n: c\n? {a: b}\n: d")
@example(b"%YAML 9.9\n--- a")
@example(b"%TAG ! !\n---\n!<x> a")
@example(b"!!python/object/apply:os.system [ls]")
@example("\ufeffa: b".encode())
@example("a: b".encode("utf-16"))
def test_any_text(data: bytes) -> None:
    """Any text is read or is a fault with a location; a text without aliases is read like PyYAML does."""
    try:
        found = read_yaml(data, "a.yaml")
    except YamlFault as fault:
        assert str(fault)
        assert fault.location.line > 0
        assert fault.location.column > 0
        return
    if b"*" in data or b"&" in data or data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return
    try:
        expected = next(
            islice(yaml.load_all(data.decode("utf-8", "replace"), Loader=yaml.CBaseLoader), 1), None
        )
    except (yaml.YAMLError, ValueError, TypeError):
        return
    assert plain(found) == ({} if expected is None else expected)


def test_locations() -> None:
    """Every value has its line and column, in characters."""
    root = read_yaml(
        "# café\nä: é\nlist:\n  - one\n  - {two: 2, drei: 'ü'}\n\"é\": |\n  text\n".encode(),
        "a.yaml",
    )
    found = {key: root.get(*key.split("/")) for key in ("ä", "list", "é")}
    items = found["list"].items if found["list"] is not None else []
    nodes = [*found.values(), *items, items[1].get("two"), items[1].get("drei")]
    locations = [(node.location.line, node.location.column) for node in nodes if node is not None]
    assert locations == [(2, 4), (4, 3), (6, 6), (4, 5), (5, 5), (5, 11), (5, 20)]
    assert all(node is not None and node.location.path == "a.yaml" for node in nodes)


def test_locations_after_a_byte_order_mark_and_with_crlf() -> None:
    """Neither a byte-order mark nor CRLF moves later locations."""
    root = read_yaml(b"\xef\xbb\xbfa: b\r\nc:\r\n  d: e\r\n", "a.yaml")
    one, two = root.get("a"), root.get("c", "d")
    assert one is not None
    assert two is not None
    assert (one.text, one.location.line, two.text, two.location.line, two.location.column) == (
        "b",
        1,
        "e",
        3,
        6,
    )


@pytest.mark.parametrize(
    ("text", "words", "line", "column"),
    [
        ("a: b: c", "mapping values are not allowed", 1, 5),
        ("a:\n\t- b", "cannot start any token", 2, 1),
        ("a: [b\nc: d", "did not find expected", 2, 2),
        ("a: *b", "there is no anchor for the alias b", 1, 4),
        ("a: 'b", "unexpected end of stream", 1, 6),
        ("a: \x01", "control characters are not allowed", 1, 1),
        ("a: \0", "control characters are not allowed", 1, 1),
        ("[" * 300, "the file is too deeply nested", 1, 1),
        ("- " * 300, "the file is too deeply nested", 1, 1),
    ],
)
def test_faults(text: str, words: str, line: int, column: int) -> None:
    """Text that is no YAML is a fault with its location."""
    with pytest.raises(YamlFault, match=words) as caught:
        read_yaml(text.encode(), "a.yaml")
    assert (caught.value.location.line, caught.value.location.column) == (line, column)


def test_quoted_strings_are_distinguished() -> None:
    """A quoted string differs from a plain one."""
    root = read_yaml(b"a: 'true'\nb: true\nc: \"1\"\nd: |\n  1\n", "a.yaml")
    assert {key: item.quoted for key, item in plain_items(root)} == {
        "a": True,
        "b": False,
        "c": True,
        "d": False,
    }


def plain_items(node: YamlNode) -> list[tuple[str, YamlNode]]:
    """Return the entries of a mapping."""
    return list(node.value.items()) if isinstance(node.value, dict) else []


def test_an_empty_text_is_an_empty_mapping() -> None:
    """Empty text, comments alone and an empty document contain nothing."""
    assert [plain(read_yaml(text, "")) for text in (b"", b"# a\n", b"---\n...\n", b"---\n")] == [
        {},
        {},
        "",
        "",
    ]


def test_first_document_only() -> None:
    """Text after the first document is not read, even if it is no YAML."""
    assert plain(read_yaml(b"a: b\n---\nc: [d\n", "")) == {"a": "b"}
    assert plain(read_yaml(b"--- a\n--- b\n", "")) == "a"


def test_the_last_of_equal_keys_counts() -> None:
    """As in PyYAML."""
    assert plain(read_yaml(b"a: 1\nb: 2\na: 3\n", "")) == {"a": "3", "b": "2"}


def test_keys_that_are_no_strings_are_kept_separately() -> None:
    """A list as a key hides nothing."""
    assert list(plain(read_yaml(b"? [a, b]\n: c\n? [d]\n: e\nf: g\n", "")).values()) == [
        "c",
        "e",
        "g",
    ]


def test_aliases_are_shared() -> None:
    """An alias is the same object as its value; the last anchor of a name before it counts."""
    root = read_yaml(b"a: &x {b: c}\nd: *x\ne: &x f\ng: *x\n? &k key\n: *k\n", "")
    assert root.get("a") is root.get("d")
    assert plain(root) == {"a": {"b": "c"}, "d": {"b": "c"}, "e": "f", "g": "f", "key": "key"}


def test_recursion_through_anchors_is_harmless() -> None:
    """A list or mapping may contain itself."""
    listed = read_yaml(b"&a [*a, b]", "")
    assert listed.items[0] is listed
    table = read_yaml(b"&a {b: *a, c: d}", "")
    assert table.get("b", "b", "b", "c") is table.get("c")
    assert table.get("c", "d") is None


def test_billion_laughs() -> None:
    """Aliases of aliases take no time and no memory."""
    lines = ["a0: &a0 [ha, ha]"] + [
        f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 60)
    ]
    with limited_work(200_000):
        root = read_yaml("\n".join(lines).encode(), "")
    last = root.get("a59")
    assert last is not None
    assert len(last.items) == 9
    assert last.items[0] is last.items[8] is root.get("a58")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("a: &a b\n" + "c: *a\n" * 1100, "the file has more than 1000 aliases"),
        ("- a\n" * 110_000, "the file has more than 25000 values"),
        ("{a: " * 50_000, "the file is too deeply nested"),
        ("[" * 100_000, "the file is too deeply nested"),
    ],
)
def test_bounds(text: str, words: str) -> None:
    """A file above the limits is a fault."""
    with limited_work(20_000_000), pytest.raises(YamlFault, match=words):
        read_yaml(text.encode(), "")


@pytest.mark.parametrize(
    "text", ["a" * 500_000, "a: '" + "b" * 500_000, "# " + "a" * 500_000, "a: |\n " + " " * 500_000]
)
def test_long_lines(text: str) -> None:
    """A long line takes linear time."""
    with limited_work(1_000), suppress(YamlFault):
        read_yaml(text.encode(), "")


@pytest.mark.parametrize("mark", ["", "\ufeff"])
@pytest.mark.parametrize("separator", ["\u2028", "\x85", "\r"])
def test_a_place_after_a_separator_is_that_of_an_editor(separator: str, mark: str) -> None:
    """YAML ends a line at every separator; a place counts the lines that git and editors count."""
    node = read_yaml(f'{mark}a: "x{separator}y"\nb: c\n'.encode(), "a.yaml").get("b")
    assert node is not None
    assert (node.location.line, node.location.column) == (2, 4)
