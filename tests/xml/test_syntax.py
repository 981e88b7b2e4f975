"""Broken XML: how far a parser reads it, and the edits after which it can be read."""

from itertools import product

import pytest

from grader.edits import edited
from grader.source import Source
from grader.xml.pieces import Rules, remaining, scan
from grader.xml.syntax import syntax_proposals
from tests.examples import light
from tests.work import limited_work

TAGS = (
    ('<parent="base_link"/>', '<parent link="base_link"/>', "the name of an attribute is missing"),
    ('<origin="0 0 0.1" rpy="0 0 0"/>', '<origin xyz="0 0 0.1" rpy="0 0 0"/>', "the name of an attribute is missing"),
    ('<origin xyz="0 0 1" ="0 0 0" />', '<origin xyz="0 0 1" rpy="0 0 0" />', "the name of an attribute is missing"),
    ('<joint name="a", type="fixed"/>', '<joint name="a" type="fixed"/>', "a comma between attributes"),
    ("<joint name=a type=fixed/>", '<joint name="a" type="fixed"/>', "a quote is missing"),
    ("<link name=\u201ca\u201d/>", '<link name="a"/>', "typographic quotes"),
    ('<mesh filename="package://a/b.stl scale="1 1 1"/>', '<mesh filename="package://a/b.stl" scale="1 1 1"/>',
     "a quote is missing"),
    ('<originxyz="0 0 1"/>', '<origin xyz="0 0 1"/>', "a space in a tag is missing"),
    ("<link><\\link>", "<link></link>", "a backslash in a tag"),
    ("<- a comment ->", "<!-- a comment -->", "a malformed comment"),
    ('<origin xyz="0 0 1" xyz="0 0 2"/>', '<origin xyz="0 0 1" rpy="0 0 2"/>', "a duplicate attribute"),
    ('<child link="a" <!-- the wheel --> />', '<child link="a" />', "a comment inside a tag"),
)  # fmt: skip
ANY = (
    ("<a><b>1</b><c>2</a>", "<a><b>1</b><c>2</c></a>", "a closing tag is missing"),
    ("<a><b>1<b></a>", "<a><b>1</b></a>", "the / of a closing tag is missing"),
    ("<a><b>1</d></a>", "<a><b>1</b></a>", "the name of a closing tag"),
    ("<a><b>1</b></b></a>", "<a><b>1</b></a>", "an extra closing tag"),
    ("<a>b>1</b></a>", "<a><b>1</b></a>", "the < of a tag is missing"),
    ("<a><b>1 & 2</b></a>", "<a><b>1 &amp; 2</b></a>", "an & that is not escaped"),
    ("<a><!-- 1 -- 2 --></a>", "<a><!-- 1 - 2 --></a>", "a malformed comment"),
    (' <?xml version="1.0"?><a/>', " <a/>", "an XML declaration that is not at the top"),
    ("<a/>text", "<a/>", "text that is no XML"),
    ("<a><b x=1/><c>2</a>", '<a><b x="1"/><c>2</c></a>', "a quote is missing and a closing tag is missing"),
)


HOSTILE = (
    *("<link " * 60_000, "<a>" * 100_000, "<" * 400_000, '<a b="' * 60_000, "<!--" * 90_000, "<?a?>" * 80_000),
    *("<a" + " " * 200_000 + "b", "<a>" + "x " * 200_000 + "<b></a>", "<!--" + "-" * 100_000 + " " * 100_000),
    *("<" + "-" * 200_000, "<robot>" + "link " * 80_000 + "</x>", "<a " + "=" * 200_000, "<a " + "b" * 200_000),
)

COSTLY = (1, 5, 7, 11)


def fixed(text: str, *, is_urdf: bool) -> list[tuple[str | None, str]]:
    """Return the texts after the edits that are found, and what was wrong with each."""
    found = syntax_proposals(Source("file", text), is_urdf=is_urdf, is_strict=not is_urdf)
    return [(edited(text, "file", proposal.edits), proposal.cause) for proposal in found]


@pytest.mark.parametrize(("tag", "meant", "cause"), TAGS)
def test_a_malformed_tag_of_a_urdf_is_written_as_it_is_meant(tag: str, meant: str, cause: str) -> None:
    """A malformed tag is written with its name, and with each attribute that it has, in quotes."""
    before, after = '<robot name="r"><joint name="j" type="fixed">', "</joint></robot>"
    assert fixed(f"{before}{tag}{after}", is_urdf=True)[0] == (f"{before}{meant}{after}", cause)


@pytest.mark.parametrize(("text", "meant", "cause"), ANY)
def test_any_xml_is_corrected_without_its_format(text: str, meant: str, cause: str) -> None:
    """The same search corrects XML of which nothing is known; several errors are found one after the other."""
    assert (meant, cause) in fixed(text, is_urdf=False)


def test_the_format_of_a_urdf_tells_where_elements_end() -> None:
    """Two elements that are not closed end before the tags that may not be in them."""
    text = '<robot name="r"><link name="a"><link name="b"><visual></link></robot>'
    assert (
        fixed(text, is_urdf=True)[0][0]
        == '<robot name="r"><link name="a"></link><link name="b"><visual></visual></link></robot>'
    )


@pytest.mark.parametrize("text", ["", "text", "<a><b/></a>", "\0"])
def test_nothing_is_found_where_no_edit_helps(text: str) -> None:
    """A text without a tag and one that can be read have no edits."""
    assert not fixed(text, is_urdf=False)


@pytest.mark.parametrize(
    ("text", "is_urdf"),
    light(product(HOSTILE, (False, True)), lambda row: row[0] in [HOSTILE[index] for index in COSTLY]),
)
def test_hostile_text_costs_bounded_work(text: str, is_urdf: bool) -> None:
    """The work for 400 KB of nothing but errors is bounded."""
    with limited_work(40_000_000):
        fixed(text, is_urdf=is_urdf)


@pytest.mark.parametrize(
    ("text", "unread"),
    [
        ("<a><b/></a>", -1),
        ("<a></b></a>", 8),
        ("<a><b></a>", 4),
        ("<a><b/>", 0),
        ("<a><!-- </a>", 9),
        ("<a/> text", 4),
        ("<a><!-- <b> --></a>", -1),
    ],
)
def test_remaining_text_is_what_tinyxml2_does_not_read(text: str, unread: int) -> None:
    """The rest of a text is counted from its first error; a tag that is still open at the end leaves nothing."""
    assert remaining(text) == unread


def test_a_bracket_is_missing_in_text_only() -> None:
    """What looks like a tag without its < is an error between the tags of a URDF, not in a comment or a value."""
    text = '<robot name="link>"><!-- link name> -->link name="a"></link> visual></robot>'
    stop = scan(text, Rules(is_urdf=True))
    assert (stop.wrong is not None and stop.wrong.form, text[stop.at : stop.at + 8]) == ("text", "link nam")
    other = scan(text, Rules()).wrong
    assert other is not None and other.form == "close"
