"""Trees: paths find entries, however their keys are written; what is too much to look through is not decided."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import MissingElement, NotDecided
from grader.base.source import Location
from grader.files.tree import make_tree, overlaid
from grader.ros.package.finding import read_packages
from grader.ros.package.trees import Search, TreeEntry, is_path, read_tree, split_path
from tests.examples import examples

pytestmark = pytest.mark.slow


def tree_of(text: str, file: str = "a.yaml") -> TreeEntry:
    """Return the tree of a file of a package."""
    texts = {"package.xml": "<package format='3'><name>hub</name></package>", file: text}
    tree = overlaid(
        make_tree("work", (), ()), {f"hub/{path}": it.encode() for path, it in texts.items()}
    )
    [package] = read_packages(tree, "urdf/hub.urdf")
    return read_tree(package, file)


def texts_at(tree: TreeEntry, path: str) -> list[str | None]:
    """Return the texts at a path."""
    return [it.text for it in Search().find(tree, split_path(path, is_xml=tree.is_xml))]


PATHS = [
    ("a: {b: {c: 1}}", "a.b.c", ["1"]),
    ("a.b: {c: 1}", "a.b.c", ["1"]),
    ("a: {b.c: 1}", "a.b.c", ["1"]),
    ("a.b.c: 1", "a.b.c", ["1"]),
    ("{a: {b: 1}, a.b: 2}", "a.b", ["1", "2"]),
    ("/**: {ros__parameters: {rate: 5}}", "/**.ros__parameters.rate", ["5"]),
    ("a: [{b: 1}, {b: 2}, 3, [4]]", "a.b", ["1", "2"]),
    ("a: [{b: 1, c: 1}, {b: 2, c: 2}]", "a[b=2].c", ["2"]),
    ("a: [{b: {d: x.y}, c: 1}]", "a[b.d=x.y].c", ["1"]),
    ("[{b: 1}, {b: 2}]", "[b=1]", [None]),
    ("[{b: 1}, {b: 2}]", "b", ["1", "2"]),
    ("a: {b: 1}", "a[b=1].b", ["1"]),
    ("a: {b: 1}", "a[b=2].b", []),
    ("a: {b: 1}", "a[b=1]c.b", []),
    ("a: 1", "a.b", []),
    ("a: 1", "", [None]),
]


@pytest.mark.parametrize(("text", "path", "expected"), PATHS)
def test_a_path_finds_entries_of_yaml(text: str, path: str, expected: list[str | None]) -> None:
    """Keys may be nested or have dots; lists are looked through; conditions choose rows and tables."""
    assert texts_at(tree_of(text), path) == expected


@given(st.lists(st.sampled_from(["a", "b", "rate", "joint_1"]), min_size=1, max_size=5), st.data())
@examples(50)
def test_every_way_to_nest_a_key_is_found(words: list[str], data: st.DataObject) -> None:
    """Whichever dots of a key are nestings: ROS 2 reads the same parameter."""
    text, depth = words[0], 0
    for word in words[1:]:
        if data.draw(st.booleans()):
            depth += 1
            text += ":\n" + " " * depth + word
        else:
            text += f".{word}"
    assert texts_at(tree_of(f"{text}: 1"), ".".join(words)) == ["1"]


def test_elements_and_attributes_are_found_with_their_places() -> None:
    """Below the root; text in comments does not count, and a quote may be of either kind."""
    tree = tree_of(
        "<sdf>\n<!-- <m/> -->\n<m name='a/b'><p>1 <!-- 3 -->2</p></m>\n<m name='c'/></sdf>", "a.sdf"
    )
    [found] = Search().find(tree, split_path("m[@name='a/b']/p", is_xml=True))
    assert (found.text, found.place) == ("1 2", Location("hub/a.sdf", 3, 15))
    [name] = Search().find(tree, split_path('m[@name="c"]/@name', is_xml=True))
    assert (name.text, name.place) == ("c", Location("hub/a.sdf", 4, 4))


def test_a_path_has_closed_brackets() -> None:
    """A condition is a key and a value; quotes are of one kind."""
    assert all(
        map(
            is_path,
            (
                "",
                "a.b",
                "a/@b",
                "a[b=c].d",
                "[a=/b].c",
                "a[@b='c']/d",
                'a[b="[x]"]'.replace("[x]", "x"),
            ),
        )
    )
    assert not any(map(is_path, ("a[b", "a[b]", "a]b", "a[b='c\"]")))


def test_aliases_that_multiply_entries_are_not_looked_through() -> None:
    """A small file can have more entries than can be looked at."""
    rows = "\n".join(f"b{i}: &b{i} [{', '.join([f'{{x: *b{i - 1}}}'] * 9)}]" for i in range(1, 9))
    tree = tree_of(f"b0: &b0 1\n{rows}")
    with pytest.raises(NotDecided, match="too many entries"):
        texts_at(tree, "b8.x.x.x.x.x.x.x.x")


def test_a_file_that_is_broken_is_missing_with_its_line() -> None:
    """The first criterion that asks for it fails, and names the line."""
    with pytest.raises(MissingElement, match=r"a\.yaml is not readable as YAML") as caught:
        tree_of("a: 1\nb: [", "a.yaml")
    assert caught.value.location == Location("hub/a.yaml", 2, 5)
