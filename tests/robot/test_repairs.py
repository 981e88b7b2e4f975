"""What a text that ROS 2 cannot read may stand for: numbers, and tags that are malformed."""

import pytest

from grader.robot.repairs.numbers import is_readable, readable
from grader.robot.repairs.pieces import Tree, pieces_of, remaining
from grader.robot.repairs.tags import rewrites
from grader.robot.repairs.texts import lost_brackets

NUMBERS = (
    ("xyz", "0,15 0 0,225", "0.15 0 0.225", "a decimal comma"),
    ("xyz", "0.15,0,0.225", "0.15 0 0.225", "commas between numbers"),
    ("xyz", "0,15; 0; 0,225", "0.15 0 0.225", "decimal commas and commas between numbers"),
    ("xyz", "0.15 0 0. 225", "0.15 0 0.225", "a space in a number"),
    ("xyz", "- 0.15 0.2 0", "-0.15 0.2 0", "a space after a sign"),
    ("xyz", "--0.15 0 0", "-0.15 0 0", "a double sign"),
    ("size", "600mm 400mm 200mm", "0.6 0.4 0.2", "a unit after a number"),
    ("rpy", "-90\u00b0 0 0", "-1.5708 0 0", "a unit after a number"),
    ("rpy", "pi/2 0 ${-pi / 2}", "1.5708 0 -1.5708", "an expression, which ROS 2 does not evaluate"),
    ("radius", "0.2/2", "0.1", "an expression, which ROS 2 does not evaluate"),
    ("rgba", "0,0.6,0,1", "0 0.6 0 1", "commas between numbers"),
    ("rgba", "0 153 0 255", "0 0.6 0 1", "the range of the colour: 0..255, not 0..1"),
    ("rgba", "0, 153, 0", "0 0.6 0 1", "commas between numbers"),
)


@pytest.mark.parametrize(("attribute", "text", "meant", "cause"), NUMBERS)
def test_numbers_are_written_as_ros_reads_them(attribute: str, text: str, meant: str, cause: str) -> None:
    """Numbers that ROS 2 cannot read are written as it reads them, named by the first mistake in them."""
    assert not is_readable(attribute, text)
    found = next(readable(attribute, text))
    assert is_readable(attribute, found.text)
    assert (found.text, found.cause) == (meant, cause)


@pytest.mark.parametrize(
    "text", ["0.15 zero 0", "0 0", "", "half of it", "${width} 0 0", "().__class__ 0 0", "9**9**9 0 0"]
)
def test_numbers_are_not_guessed(text: str) -> None:
    """What is no number, and what has too few of them, stands for nothing."""
    assert not list(readable("xyz", text))


@pytest.mark.parametrize("text", ["0 0 0.1", " 0.15 0 .2e1", "+1 -2 3."])
def test_numbers_that_ros_reads_need_no_repair(text: str) -> None:
    """Numbers that ROS 2 reads are left as they are."""
    assert is_readable("xyz", text)


TAGS = (
    ('<parent="base_link"/>', '<parent link="base_link"/>', "the name of an attribute is missing"),
    ('<origin="0 0 0.1" rpy="0 0 0"/>', '<origin xyz="0 0 0.1" rpy="0 0 0"/>', "the name of an attribute is missing"),
    ('<origin xyz="0 0 1" ="0 0 0" />', '<origin xyz="0 0 1" rpy="0 0 0" />', "a malformed tag"),
    ('<joint name="a", type="fixed">', '<joint name="a" type="fixed">', "a comma between attributes"),
    ("<joint name=a type=fixed>", '<joint name="a" type="fixed">', "the quotes, which are missing"),
    ("<link name=\u201ca\u201d/>", '<link name="a"/>', "typographic quotes"),
    ('<mesh filename="package://a/b.stl scale="1 1 1"/>', '<mesh filename="package://a/b.stl" scale="1 1 1"/>', "a quote is missing"),
    ('<originxyz="0 0 1"/>', '<origin xyz="0 0 1"/>', "the space after the name of a tag is missing"),
    ("<\\link>", "</link>", "a backslash in a tag"),
    ('<xml version="1.0"?>', '<?xml version="1.0"?>', "the XML declaration"),
    ("<- a comment ->", "<!-- a comment -->", "the start of a comment"),
)  # fmt: skip


@pytest.mark.parametrize(("tag", "meant", "cause"), TAGS)
def test_malformed_tag_is_written_as_it_is_meant(tag: str, meant: str, cause: str) -> None:
    """A malformed tag is written with its name, and with each attribute that it has, in quotes."""
    (piece,) = pieces_of(tag)
    found = next(rewrites(tag, piece))
    assert (found.new, found.cause) == (meant, cause)


def test_extent_of_a_tag_without_end() -> None:
    """A tag without its > ends before the next tag; a comment in a tag belongs to it."""
    text = '<a x="1"\n  <b <!-- c --> y="2"/>\n</a'
    assert [piece.text_in(text) for piece in pieces_of(text)] == ['<a x="1"', '<b <!-- c --> y="2"/>', "</a"]


@pytest.mark.parametrize(
    ("text", "unread"),
    [
        ("<a><b/></a>", -1),
        ("<a></b></a>", 8),
        ("<a><b></a>", 4),
        ("<a><b/>", 0),
        ("<a><!-- </a>", 9),
        ("<a/> text", 5),
        ("<a><!-- <b> --></a>", -1),
    ],
)
def test_remaining_text_is_what_tinyxml2_does_not_read(text: str, unread: int) -> None:
    """The rest of a text is counted from its first error; a tag that is still open at the end leaves nothing."""
    assert remaining(text) == unread
    assert (Tree.of(text).mismatch is not None) == (unread in (8, 4))


def test_lost_brackets_are_found_in_text_only() -> None:
    """What looks like a tag without its < is found between tags, not in a comment or a value."""
    text = '<robot name="link>"><!-- link name> -->link name="a"></link> visual></robot>'
    assert [text[at : at + 4] for at in lost_brackets(text)] == ["link", "visu"]
