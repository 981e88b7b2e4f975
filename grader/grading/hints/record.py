"""Hints as JSON text, which a gradebook stores, and back.

The graded URDF is stored without its path, so that two submissions whose files differ only in their names have the same
hints. A null at the end stands for a search that was not complete.
"""

import json
from collections.abc import Iterator
from dataclasses import replace
from decimal import Decimal
from typing import NamedTuple

from grader.grading.report import Hint, Report
from grader.source import Edit, Location

INCOMPLETE = "the search for hints ended at its limit: there may be more"
_MAIN = ""  # the path of the graded URDF


class StoredHint(NamedTuple):
    """A hint and the criteria whose results have it. The path of the graded URDF is empty."""

    criteria: tuple[str, ...]
    hint: Hint

    def own_edits(self, others: "tuple[StoredHint, ...]") -> tuple[Edit, ...]:
        """Return the edits that are not those of another hint of the submission, which this one includes."""
        mine = set(self.hint.edits)
        earlier = {edit for other in others if mine > set(other.hint.edits) for edit in other.hint.edits}
        return tuple(edit for edit in self.hint.edits if edit not in earlier)


def hints_to_record(report: Report) -> str:
    """Return the hints of a report as JSON text."""
    main = report.submission.path
    found: list[tuple[list[str], Hint]] = []
    for result in report.results:
        for hint in result.hints:
            names = next((names for names, known in found if known == hint), None)
            if names is None:
                found.append(([result.criterion.id], hint))
            else:
                names.append(result.criterion.id)
    stored = [_stored(names, hint, main) for names, hint in found] + [None] * (INCOMPLETE in report.notes)
    return json.dumps(stored, separators=(",", ":"))


def hints_from_record(text: str) -> tuple[StoredHint, ...]:
    """Return stored hints."""
    return tuple(_read(text))


def with_hints(report: Report, text: str) -> Report:
    """Return a report with its stored hints, up to the level that the rubric allows."""
    level, main = report.rubric.hints, report.submission.path or ""
    if level == "none":
        return report
    hints: dict[str, tuple[Hint, ...]] = {}
    for names, hint in _read(text):
        edits = tuple(_moved(edit, main) for edit in hint.edits) if level == "edit" else ()
        at = replace(hint.at, path=hint.at.path or main)
        hints |= dict.fromkeys(names, (hint._replace(at=at, edits=edits),))
    results = (result._replace(hints=hints.get(result.criterion.id, ())) for result in report.results)
    notes = (*report.notes, INCOMPLETE) if None in json.loads(text) else report.notes
    return replace(report, results=tuple(results), notes=notes)


def _moved(edit: Edit, main: str) -> Edit:
    return edit if edit.path != _MAIN else edit._replace(path=main)


def _stored(names: list[str], hint: Hint, main: str | None) -> object:
    at = _MAIN if hint.at.path == main else hint.at.path
    gains = {name: str(points) for name, points in hint.gains.items()}
    edits = [edit._replace(path=_MAIN) if edit.path == main else edit for edit in hint.edits]
    return names, hint.message, (at, hint.at.line, hint.at.column), gains, edits, hint.action


def _read(text: str) -> Iterator[StoredHint]:
    for names, message, at, gains, edits, action in filter(None, json.loads(text)):
        points = {name: Decimal(value) for name, value in gains.items()}
        hint = Hint(message, Location(*at), points, tuple(Edit(*edit) for edit in edits), action)
        yield StoredHint(tuple(names), hint)
