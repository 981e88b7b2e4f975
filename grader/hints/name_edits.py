"""Edits of names that do not agree, where they are used or where they are defined, and of values of parameters."""

import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from os.path import commonprefix
from typing import Any

from grader.checks.parameters import measured, value_of
from grader.errors import MissingElement, NotDecided
from grader.hints.edits import Proposal
from grader.package.package import CMAKE, MANIFEST
from grader.source import Edits
from grader.submission.submission import Submission
from grader.workspace.names import Correction, Family
from grader.workspace.reading import wrong_names

_MAX_KEY = 400  # characters from a key to its value
_SEPARATED = re.compile(r".*[./:]")
_WITH_ALL = (f"/{CMAKE}", f"/{MANIFEST}")  # files in which a name stands several times for one thing


def name_proposals(submission: Submission, family: Family) -> Iterator[Proposal]:
    """Yield the edits with which the names of a family agree: those that correct most at once, then those of the uses.

    A name that a file puts together from pieces has none.
    """
    wrong = wrong_names(submission, family)
    ways = [[edits for it in one.corrections if (edits := correction_edits(submission, it))] for one in wrong]
    if not all(ways):
        return
    uses = Counter(edits for each in ways for edits in each)
    chosen = [[max(each, key=lambda edits: uses[edits]) for each in ways]]
    chosen += [[each[0] for each in ways], [each[-1] for each in ways]]
    for rank, each in enumerate(chosen):
        edits = tuple(dict.fromkeys(edit for edits in each for edit in edits))
        names = {edit.old for edit in edits}
        cause = f"the name `{min(names)}`" if len(names) == 1 else "names that do not agree"
        yield Proposal(edits, cause, rank=rank)


def value_proposals(submission: Submission, wanted: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield the edit that gives a parameter the value that `parameter_is` asks for, where one is written plainly."""
    name, meant = wanted["parameter"], wanted.get("value")
    try:
        value, at = value_of(submission, wanted["node"], name)
        if "measure" in wanted:
            meant = round(measured(submission, wanted["measure"], wanted.get("links", [])), 9)
    except (MissingElement, NotDecided):
        return
    source, key = submission.source(at.path), re.escape(name.rpartition(".")[2])
    if source is None:
        return
    plain = re.compile(rf"(?<![\w-]){key}[\"']?\s*:\s*[\"']?({re.escape(str(value))})(?!\w)", re.IGNORECASE)
    offset = source.offset(at.line, at.column)
    found = next((it for it in plain.finditer(source.text) if it.end() > offset), None)
    if found is not None and isinstance(meant, str | int | float):
        new = str(float(meant)) if isinstance(value, float) and type(meant) is int else str(meant)
        yield Proposal((source.edit(*found.span(1), new),), f"the value of `{name}`")


def correction_edits(submission: Submission, correction: Correction) -> Edits:
    """Return the edits that make a correction in the text; none where the name is not written there as a whole."""
    at, source = correction.location, submission.source(correction.location.path)
    if source is None:
        return ()
    for old, new in _as_written(correction.old, correction.new):
        spans = [it.span() for it in re.finditer(rf"(?<![\w-]){re.escape(old)}(?![\w-]|\.\w)", source.text)]
        if not f"/{at.path}".endswith(_WITH_ALL):
            spans = _meant(source.text, old, spans, source.offset(at.line, at.column))
        if spans:
            return tuple(source.edit(*span, new) for span in spans)
    return ()


def _as_written(old: str, new: str) -> Iterator[tuple[str, str]]:
    """Yield two names without the slash that begins them, and without the folders or tables that both are in."""
    yield old.strip("/"), new.strip("/")
    shared = _SEPARATED.match(commonprefix((old, new)))  # noqa: RUF071  of names, not of paths
    if shared is not None and len(shared[0]) < min(len(old), len(new)):
        yield old[shared.end() :], new[shared.end() :]


def _meant(text: str, name: str, spans: Sequence[tuple[int, int]], at: int) -> list[tuple[int, int]]:
    """Return the occurrence of a name that a place is about: its key, else the first behind it, or the last before."""
    key = re.compile(rf"{re.escape(name)}[\"']?\s*:\s*(?:\{{?\s*(?:ros__parameters|type)\s*:\s*)?")
    before, after = [it for it in spans if it[0] < at], [it for it in spans if it[0] >= at]
    if before and at - before[-1][0] < _MAX_KEY and key.fullmatch(text, before[-1][0], at):
        return before[-1:]
    return after[:1] or before[-1:]
