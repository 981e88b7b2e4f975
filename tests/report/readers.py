"""Reading reports back as the programs do for which they are made. What such a program would refuse fails the test."""

import json
from collections.abc import Callable, Iterator, Mapping
from functools import cache, lru_cache
from importlib.metadata import distribution
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple

import cmarkgfm
import jsonschema
import pytest
from cmarkgfm.cmark import Options
from lxml import etree, html
from markdown_it import MarkdownIt
from markdown_it.token import Token

from grader.report.formats import Format, json_schema
from tests.report.workflow_commands import Command, commands

FOLDER = Path(__file__).parent
MARKDOWN = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])


@cache
def xml_schema(name: str) -> etree.XMLSchema:
    """Return one of the XML Schemas for JUnit's format that come with pyEDAA.Reports."""
    file = distribution("pyEDAA.Reports").locate_file(f"pyEDAA/Reports/Resources/{name}.xsd")
    return etree.XMLSchema(etree.parse(str(file)))


@cache
def json_validator(name: str) -> Any:
    """Return a validator for one of the schemas beside this file."""
    schema = json.loads((FOLDER / "schemas" / f"{name}.json").read_text(encoding="utf-8"))
    validator = jsonschema.validators.validator_for(schema, jsonschema.Draft202012Validator)
    validator.check_schema(schema)
    return validator(schema)


def read_json(text: str) -> Any:
    """Return data from JSON text without NaN and without duplicate keys."""
    return json.loads(text, parse_constant=pytest.fail, object_pairs_hook=_once)


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    assert len(found) == len(pairs), f"a key is there twice: {[key for key, _ in pairs]}"
    return found


def read_report(text: str) -> Any:
    """Return a report as JSON, valid under the schema that `grader schema report` prints."""
    data = read_json(text)
    jsonschema.Draft202012Validator(json_schema("report")).validate(data)
    return data


@lru_cache(maxsize=1)  # a text is read twice, to be checked and for its structure
def read_junit(text: str) -> Any:
    """Return the root of a JUnit report, valid under the XML Schemas of tools that write and read such files."""
    root = etree.fromstring(text.encode(), etree.XMLParser(resolve_entities=False))
    for name in ("Any-JUnit", "PyTest-JUnit"):
        xml_schema(name).assertValid(root)
    for suite in root:
        xml_schema("Ant-JUnit4").assertValid(suite)
    return root


def read_by_schema(name: str) -> Callable[[str], Any]:
    """Return a reader of JSON that is valid under one of the schemas beside this file."""

    def read(text: str) -> Any:
        data = read_json(text)
        json_validator(name).validate(data)
        return data

    return read


@lru_cache(maxsize=1)
def read_markdown(text: str) -> list[Token]:
    """Return the tokens of Markdown by CommonMark with tables and strikethrough, including inline tokens."""
    found: list[Token] = []
    for token in MARKDOWN.parse(text):
        found += [token] if token.type != "inline" else token.children or []
    return found


def read_as_github(text: str) -> Any:
    """Return the elements that GitHub makes of Markdown: its own parser, with autolinks and raw HTML."""
    made = cmarkgfm.github_flavored_markdown_to_html(text, Options.CMARK_OPT_UNSAFE)
    return html.fragment_fromstring(made, create_parent=True)


def read_commands(text: str) -> list[Command]:
    """Return the annotations in a text in which every line is a command."""
    found = commands(text)
    assert len(found) == text.count("\n")
    return found


# Text with very many backticks is plain text in Markdown instead of code, or an indented block instead of a fenced one.
_ALIKE = {"code_inline": "text", "code_block": "fence"}


def markdown_structure(text: str) -> Any:
    """Return the tokens of Markdown, and the elements that GitHub makes of it."""
    kinds = [_ALIKE.get(token.type, token.type) for token in read_markdown(text)]
    tags = [tag for tag in _tags(read_as_github(text)) if tag != "code"]
    return [kind for kind, _ in groupby(kinds)], tags


def junit_structure(text: str) -> Any:
    """Return the elements of a JUnit report."""
    return _tags(read_junit(text))


def commands_structure(text: str) -> Any:
    """Return the annotations with the names of their properties."""
    return [
        (command.name, [key for key, _ in command.properties]) for command in read_commands(text)
    ]


def json_structure(text: str) -> Any:
    """Return the keys of JSON with the types of their values."""
    return _shape(read_json(text))


def _tags(root: Any) -> list[str]:
    return [element.tag for element in root.iter()]


# A recast report has only the problems that nothing else reports.
_UNEQUAL = {"problems"}


def _shape(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _shape(item) for key, item in value.items() if key not in _UNEQUAL}
    if isinstance(value, list) and all(isinstance(item, str) for item in value):
        return "lines"
    return [_shape(item) for item in value] if isinstance(value, list) else type(value).__name__


def markdown_text(text: str) -> str:
    return str(read_as_github(text).text_content())


def junit_text(text: str) -> str:
    return "\n".join(
        piece
        for element in read_junit(text).iter()
        for piece in (*element.attrib.values(), element.text or "")
    )


def commands_text(text: str) -> str:
    return "\n".join(
        f"{command.get('title')}\n{command.get('file')}:{command.get('line')}\n{command.data}"
        for command in read_commands(text)
    )


def json_text(text: str) -> str:
    """Return all strings, all numbers with their keys, and locations as other formats write them."""
    data = json.loads(text)
    return "\n".join((*_values(data), json.dumps(data)))


def _values(value: Any) -> Iterator[str]:
    if isinstance(value, str):
        yield value
    elif isinstance(value, list):
        for item in value:
            yield from _values(item)
    elif isinstance(value, dict):
        if {"path", "line"} <= set(value):
            yield f"{value['path']}:{value['line']}"
        for item in value.values():
            yield from _values(item)


@lru_cache(maxsize=1)
def read_page(text: str) -> Any:
    """Return the root of an HTML page. It has the elements of its template only, and no event handler or style of its own."""
    root: Any = html.document_fromstring(text)
    for element in root.iter():
        assert not any(
            name.startswith("on") or name in ("style", "srcset") for name in element.attrib
        )
        assert element.get("src", "data:image/").startswith(
            "data:image/"
        )  # a picture of the submission
    return root


def page_structure(text: str) -> Any:
    """Return the elements of a page outside of drawings. A diff, like a drawing, has as many elements as its texts need."""
    return [
        element.tag
        for element in read_page(text).xpath("//*[not(ancestor::svg)]")
        if element.tag not in ("ins", "del", "span", "code")
    ]


def page_text(text: str) -> str:
    """Return the text that a page shows, with backticks around what it shows as code in sentences."""
    root: Any = html.document_fromstring(text)
    for element in root.xpath("//script | //style"):
        element.text = ""
    for element in root.xpath("//*[contains(@class, 'sentence')]//code"):
        element.text = f"`{element.text}`"
    return str(root.text_content())


_SVG_ELEMENTS = {"svg", "title", "desc", "style", "rect", "g", "path", "polygon", "text", "circle"}
_SVG_ATTRIBUTES = {
    "cx",
    "cy",
    "r",
    "transform",
    "class",
    "d",
    "fill",
    "fill-opacity",
    "height",
    "points",
    "role",
    "stroke",
    "viewBox",
    "width",
    "x",
    "y",
}


def read_svg(text: str) -> Any:
    """Return the root of a drawing, which has nothing but shapes and text: no script, link, style attribute or foreign element."""
    root = etree.fromstring(text.encode(), etree.XMLParser(resolve_entities=False))
    for element in root.iter():
        name = etree.QName(element)
        assert (name.namespace, name.localname in _SVG_ELEMENTS) == (
            "http://www.w3.org/2000/svg",
            True,
        ), element.tag
        assert set(element.attrib) <= _SVG_ATTRIBUTES, element.attrib
        assert name.localname != "style" or "url" not in str(element.text)
    return root


def svg_text(text: str) -> str:
    return "\n".join(
        filter(None, (element.text for element in read_svg(text).iter("{*}text", "{*}desc")))
    )


def gradescope_text(text: str) -> str:
    data = json.loads(text)
    return "\n".join(
        (
            json_text(text),
            markdown_text(data["output"]),
            *(markdown_text(test["output"]) for test in data["tests"]),
        )
    )


_TESTS = "it has a test for each criterion, and no room for anything else"
_NAMED = "of ten notices one names all that wait and all that are skipped"
_SUM = "it names what to fix, and gives the sum of the extra credit with the score"


class FormatReader(NamedTuple):
    """Functions that read a format back.

    `parse` reads it as its consumer does, `structure` returns its elements without the text in them, `text` its text.
    `excused` lists the facts that the format omits, with the reason.
    """

    parse: Callable[[str], Any]
    structure: Callable[[str], Any]
    text: Callable[[str], str]
    excused: Mapping[str, str] = {}


READERS: Mapping[Format, FormatReader] = {
    Format.TERMINAL: FormatReader(
        str.splitlines,
        lambda _: None,  # its lines have no structure
        str,
    ),
    Format.MARKDOWN: FormatReader(read_markdown, markdown_structure, markdown_text),
    Format.HTML: FormatReader(read_page, page_structure, page_text),
    Format.JSON: FormatReader(read_report, json_structure, json_text),
    Format.JUNIT: FormatReader(read_junit, junit_structure, junit_text),
    Format.GITHUB: FormatReader(
        read_commands,
        commands_structure,
        commands_text,
        dict.fromkeys(("message of pending", "found"), _NAMED) | {"earned bonus": _SUM},
    ),
    Format.GRADESCOPE: FormatReader(read_by_schema("gradescope"), json_structure, gradescope_text),
    Format.CLASSROOM50: FormatReader(
        read_by_schema("classroom50"),
        json_structure,
        json_text,
        dict.fromkeys(
            ("problem", "note", "aside", "package", "waits", "rubric", "version"), _TESTS
        ),
    ),
}


# They list what is wrong, and nothing else of a report.
FINDINGS = frozenset({Format.CONCISE, Format.SARIF, Format.CODEQUALITY})


def reader(kind: Format) -> FormatReader:
    """Return the reader of a format: its row, else one for JSON or text.

    Only a format with a row must contain every fact.
    """
    if kind is Format.SVG:
        return FormatReader(
            read_svg, lambda _: None, svg_text
        )  # its texts have as many lines as they need
    if (
        kind is Format.SARIF
    ):  # whose schema is that of https://github.com/SchemaStore/schemastore, under Apache-2.0
        return FormatReader(read_by_schema("sarif-2.1.0"), json_structure, json_text)
    is_json = kind.ending.endswith("json")
    return READERS.get(kind) or FormatReader(
        read_json if is_json else str, json_structure if is_json else lambda _: None, str
    )
