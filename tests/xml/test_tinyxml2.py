"""TinyXML2's dialect: never a crash, always XML that lxml reads, and the same tree if no translation is needed."""

from itertools import product

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st
from lxml import etree

from grader.ros.urdf.reader import read_urdf
from grader.ros.xml.parsing import is_plain
from grader.ros.xml.tinyxml2 import MAX_NAME_LENGTH, Scan, scan
from grader.ros.xml.xml_problems import MISPLACED_DECLARATION
from tests.examples import examples, spread
from tests.urdf.random_text import data
from tests.work import limited_work

_PARSER = etree.XMLParser(
    resolve_entities=False, no_network=True, load_dtd=False, remove_comments=True, remove_pis=True
)


def decoded(raw: bytes) -> str:
    """Return a file's text as the reader decodes it."""
    return raw.decode("utf-8", "surrogateescape")


def assert_sound(scan: Scan, text: str) -> None:
    """Assert that the XML parses and has the offset of the < of each element, or that there is a reason or no robot.

    Of the defects that ROS 2 rejects, only a misplaced declaration leaves the elements around it readable.
    """
    for found in scan.differences:
        assert 0 <= found.offset <= len(text)
        assert found.message
    if not scan.xml:
        return
    root = etree.fromstring(scan.xml, _PARSER)
    assert root.tag == "robot"
    assert len(list(root.iter())) == len(scan.offsets)
    assert all(text[offset] == "<" for offset in scan.offsets)
    assert scan.offsets == sorted(scan.offsets)
    fatal = {found.kind for found in scan.differences if found.kind.effect == "rejects"}
    assert fatal <= {MISPLACED_DECLARATION}


@examples(60)
@given(raw=data)
@example(raw=b"")
@example(raw=b"<robot name='&#;'/>")
@example(raw=b"<robot a=\x1cb/>")
@example(raw=b"<robot \x1c/>")
@example(raw=b"<robot\xc2\x85name='r'/>")
@example(raw=b"\xff\xfe<\0r\0")
def test_translation_is_sound(raw: bytes) -> None:
    """Any bytes are translated or refused, and the translation is XML with its offsets."""
    text = decoded(raw)
    assert_sound(scan(text), text)


@examples(30)
@given(text=st.text(max_size=200))
def test_any_text_is_translated_or_refused(text: str) -> None:
    """Text without any tags in mind."""
    assert_sound(scan(text), text)


# --- Where lxml and TinyXML2 agree ------------------------------------------------------------------------------------

_tag = st.sampled_from(("link", "joint", "a", "_b", "c.d-e", "visual", "box", "A1"))
_value = st.lists(
    st.sampled_from(
        (
            "base",
            " ",
            "  ",
            "0.5",
            "&amp;",
            "&lt;",
            "&gt;",
            "&quot;",
            "&apos;",
            "&#65;",
            "&#x41;",
            "é",
            "&#233;",
        )
    )
    | st.sampled_from(
        (
            "&#9;",
            "&#10;",
            "&#13;",
            "&#x20;",
            "'",
            ">",
            "=",
            "/",
            "&#128;",
            "&#x1F916;",
            "\U0001f916",
            "]]",
        )
    ),
    max_size=4,
).map("".join)
_blank = st.sampled_from(("", " ", "\n", "\r\n", "\t", "  \n"))
_gap = st.sampled_from((" ", "\n", "\r\n", "\t", "  \n"))
_between = st.sampled_from(
    (
        "",
        " ",
        "\n",
        "\r\n",
        "text",
        "<!---->",
        "<!-- <link/> -->",
        "<!-- ' -->",
        '<!-- " -->',
        "&amp;",
        "&#65;",
        ">",
        "'",
        '="',
    )
)
_start = st.sampled_from(
    (
        "",
        "\ufeff",
        '<?xml version="1.0"?>',
        "<?xml version='1.0' encoding='utf-8'?>\n",
        "<!-- first -->",
        "\n",
        " \r\n",
    )
)


@st.composite
def _elements(draw: st.DrawFn, tag: str, depth: int) -> str:
    names = draw(
        st.lists(
            st.sampled_from(("name", "xyz", "type", "a", "b-c", "_d")), unique=True, max_size=3
        )
    )
    attributes = "".join(
        f'{draw(_gap)}{name}{draw(_blank)}={draw(_blank)}"{draw(_value)}"'
        if draw(st.booleans())
        else f"{draw(_gap)}{name}={draw(_blank)}'{draw(_value).replace(chr(39), '')}'"
        for name in names
    )
    opening = f"<{tag}{attributes}{draw(_blank)}"
    if depth == 0 or (tag != "robot" and draw(st.booleans())):
        return f"{opening}/>"
    children = [
        draw(_elements(draw(_tag), depth - 1)) + draw(_between)
        for _ in range(draw(st.integers(0, 3)))
    ]
    return f"{opening}>{draw(_between)}{''.join(children)}</{tag}{draw(_blank)}>"


_robots = st.builds("{}{}{}".format, _start, _elements("robot", 3), _blank)


def tree(root: etree._Element) -> list[tuple[str, dict[str, str]]]:
    """Return tags and attributes in document order."""
    return [
        (str(element.tag), {str(k): str(v) for k, v in element.attrib.items()})
        for element in root.iter()
    ]


def assert_same_if_plain(text: str) -> None:
    """Assert that the translation has the same tags and attributes if the text is plain and lxml reads it."""
    raw = text.encode()
    if is_plain(raw):
        try:
            root = etree.fromstring(raw, _PARSER)
        except etree.XMLSyntaxError:
            return
        assert tree(root) == tree(etree.fromstring(scan(text).xml, _PARSER))


@pytest.mark.slow
@examples(30)
@given(text=_robots)
def test_plain_text_means_the_same_to_lxml(text: str) -> None:
    """If no translation is needed, lxml reads the same tags and attributes from the text and the translation."""
    assume(is_plain(text.encode()))
    assert_same_if_plain(text)


@examples(60)
@given(
    values=st.lists(st.text("a=\"'\n\r\t <!-&;", max_size=5), min_size=1, max_size=3),
    quote=st.sampled_from("\"'"),
    gap=st.sampled_from(("", " ", "\n", "\t")),
    between=st.text("a=\"'\n >-", max_size=6),
)
@example(values=["a\nb"], quote="'", gap=" ", between="")
@example(values=["=", "a\nb"], quote="'", gap="", between="")
@example(values=["='", "\n"], quote='"', gap="", between='="')
def test_values_with_line_breaks_are_not_plain(
    values: list[str], quote: str, gap: str, between: str
) -> None:
    """lxml turns a line break or tab in a value into a space, TinyXML2 keeps it: such a text needs the translation."""
    attributes = "".join(
        f" a{n}={gap}{quote}{value.replace(quote, '')}{quote}" for n, value in enumerate(values)
    )
    assert_same_if_plain(
        f"<robot{attributes}><!--{between}-->{between}<b{attributes}/>{between}</robot>"
    )


def assert_alike_if_plain(raw: bytes) -> None:
    """Assert the same of any bytes, except of names that XML and TinyXML2 read differently, and of deep trees."""
    if not is_plain(raw):
        return
    try:
        root = etree.fromstring(raw, _PARSER)
    except etree.XMLSyntaxError:
        return
    if root.tag != "robot" or root.xpath(
        "//*[count(ancestor::*) > 30]"
    ):  # deeper ones are not translated
        return
    translated = tree(etree.fromstring(scan(decoded(raw)).xml, _PARSER))
    for (tag, attributes), (other, others) in zip(tree(root), translated, strict=True):
        if _is_plain_name(tag.replace("_", "a")):
            assert tag == other
        assert _plain_names(attributes) == _plain_names(others)


def _plain_names(attributes: dict[str, str]) -> dict[str, str]:
    return {name: value for name, value in attributes.items() if _is_plain_name(name)}


def _is_plain_name(name: str) -> bool:
    """Return whether a name is kept: long ones, and those that XML reserves, are replaced or omitted."""
    return (
        name.isascii()
        and name.isalnum()
        and len(name) < MAX_NAME_LENGTH
        and not name.lower().startswith("xml")
    )


@pytest.mark.slow
@examples(60)
@given(raw=data)
def test_plain_soup_means_the_same_to_lxml(raw: bytes) -> None:
    """Also for text without meaning, except names that XML and TinyXML2 read differently."""
    assume(is_plain(raw))
    assert_alike_if_plain(raw)


@pytest.mark.slow
@examples(30)
@given(text=_robots)
def test_both_readings_give_the_same_robot(text: str) -> None:
    """An empty CDATA section forces the translation: robot, problems and locations stay the same."""
    head, end, tail = text.rpartition("</")
    assume(end)
    assume(tail.startswith("robot"))
    plain, other = read_urdf(text.encode()), read_urdf(f"{head}<![CDATA[]]></{tail}".encode())
    assert other.robot == plain.robot
    assert other.verdict == plain.verdict
    assert [(problem.code, problem.message, problem.location) for problem in other.problems] == [
        (problem.code, problem.message, problem.location) for problem in plain.problems
    ]


@pytest.mark.parametrize(
    "text",
    [
        "<robot a='1\n2'/>",
        "<robot a='1\t2'/>",
        '<robot a="1\r\n2"/>',
        "<robot a = \n'x\ty'/>",
        "<robot><![CDATA[<a>]]></robot>",
        "<!DOCTYPE robot><robot/>",
        "<robot xmlns='u'/>",
        "<robot xmlns = 'u'/>",
        "<robot/><?pi?>",
        "<?xml version='1.1'?><robot/>",
        "<?xml version='1.0' encoding='latin-1'?><robot/>",
        "<?xml version='1.0' standalone='yes'?><robot/>",
        "<?xml version='1.0' encoding='utf-16'?><robot/>",
        "<robot/>\0",
    ],
)
def test_text_that_both_read_differently_is_not_plain(text: str) -> None:
    """Values with line breaks, CDATA, DOCTYPE, namespaces and odd declarations need the translation."""
    assert not is_plain(text.encode())


def test_a_declaration_and_a_comment_are_plain() -> None:
    """They are read by lxml, with the same result."""
    text = "<?xml version='1.0'?><!-- c --><robot a='1'/>"
    assert is_plain(text.encode())
    assert_same_if_plain(text)


_PIECES = (
    "<",
    ">",
    "&",
    "&#",
    "&#x",
    '="',
    "='",
    "<!",
    "<!--",
    "<?",
    "<a",
    "<a ",
    "<a>",
    "</a>",
    "\r",
)
_FRAMES = (
    "{}",
    "<robot {}",
    "<robot a='{}'/>",
    "<robot>{}</robot>",
    "<robot/>{}",
    "<robot/></x>{}",
)


@pytest.mark.slow
@pytest.mark.parametrize(("piece", "frame"), spread(product(_PIECES, _FRAMES), 18))
def test_a_long_file_of_one_piece(piece: str, frame: str) -> None:
    """Time is linear wherever the piece is: a quarter of a megabyte takes a bounded number of lines."""
    text = frame.format(piece * (2**18 // len(piece)))
    with limited_work(30_000_000):
        is_plain(text.encode())
        scan(text)
