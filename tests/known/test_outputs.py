"""Each row of outputs.toml, and each symptom of a rule, knows what its program says, by the format string of the source."""

import re
import string
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import pytest

from grader.ros.known.output_rows import OutputRow
from grader.workspace.api import RULES
from grader.workspace.log.explaining import known_rows
from grader.workspace.log.log_messages import read_messages
from grader.workspace.rules.problem_kinds import EVERY_KIND

_SAID = tomllib.loads(Path(__file__).with_name("outputs_said.toml").read_text("utf-8"))["said"]
# Repository and commit or version, a file, and its line.
_SOURCE = re.compile(r"[\w.-]+/[\w.-]+ [\w.]+, [\w./-]+:\d+")


def _text_of(said: Mapping[str, Any]) -> str:
    values = iter(said.get("values", ()))
    return re.sub(r"\{\}|%s", lambda _: next(values), said["format"])


@pytest.mark.parametrize("said", _SAID, ids=lambda said: said["output"])
def test_a_row_knows_the_text_of_its_source(said: Mapping[str, Any]) -> None:
    """It does so behind a prefix as well, and finds the names in it."""
    text = _text_of(said)
    for log in (text, f"[ERROR] [17.5] [node]: {text}"):
        [message] = read_messages(log.encode())
        rows = {row.name: row.compiled.search(message.text) for row in known_rows()}
        match = rows[said["output"]]
        assert match is not None
        names = {name: value or "" for name, value in match.groupdict().items()}
        assert names == said["names"]


def test_each_row_has_a_text() -> None:
    """No row is without one, and no two have one name."""
    names = [row.name for row in known_rows()]
    assert len(names) == len(set(names))
    assert {said["output"] for said in _SAID} == set(names)


@pytest.mark.parametrize("row", known_rows(), ids=lambda row: row.name)
def test_a_row_names_what_exists(row: OutputRow) -> None:
    """Its rules are rules or codes, its groups are those of its pattern, and its source has a line."""
    for rule in row.rules:
        assert rule in RULES or any(kind.code.startswith(rule) for kind in EVERY_KIND), rule
    groups = {*row.compiled.groupindex}
    assert {*row.within} <= groups
    for text in (row.otherwise, row.key):
        fields = {field for _, field, _, _ in string.Formatter().parse(text) if field is not None}
        assert fields <= groups | {"logger", "reason"}
    for source in row.source.split("; "):
        assert _SOURCE.match(source), source
    assert row.sentence.endswith(".")
    assert bool(row.key) == (row.place in ("parameter", "text"))
    assert re.search(row.pattern, row.example)
    # Codes of problems explain only what has names, or is of a program that the workspace starts.
    assert row.within or row.processes or row.place or row.follows or {*row.rules} <= RULES.keys()
