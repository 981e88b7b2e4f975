"""Parameters of well-known nodes in plain text: what a node reads, in which releases."""

import json
from collections.abc import Iterator
from typing import Any

from grader.base.errors import InputError
from grader.base.names import did_you_mean
from grader.base.text import counted, enumerated
from grader.ros.known.parameter_rows import COVERED, ParameterRow, node_called, node_rows
from grader.ros.known.releases import Release


def parameter_explanation(name: str) -> str:
    """Return the explanation of a parameter, or what parameters a node has.

    A parameter is named as `ekf_node.frequency`. The result is empty if the name begins with no
    well-known node. Raises InputError for a parameter that the node does not have.
    """
    written, _, parameter = name.partition(".")
    node = node_called(written)
    known = node_rows(node) if node is not None else None
    if not known:
        return ""
    if not parameter:
        lines = [f"{row.name}: {_summary(row)}" for row in known.rows]
        return "\n".join([f"{known.node}: {counted(len(lines), 'parameter')}", "", *lines]) + "\n"
    rows = [row for row in known.rows if row.pattern.fullmatch(parameter)]
    if not rows:
        guess = did_you_mean(parameter, {row.name for row in known.rows})
        raise InputError(f"{known.node} has no parameter {parameter!r}{guess}")
    texts = [f"{rows[0].name}: a parameter of {known.node}"]
    texts += [row_text(row, known.read) for row in rows]
    return "\n\n".join([*texts, f"Source: {known.source}"]) + "\n"


def _summary(row: ParameterRow) -> str:
    """Return the type, the default and the releases of a parameter in one line."""
    parts = [row.type or "any type"]
    if row.default is not None:
        parts.append(f"default {_value(row.default)}")
    if row.is_required:
        parts.append("required")
    if row.releases:
        parts.append(row.releases)
    return ", ".join(parts)


def row_text(row: ParameterRow, read: Release) -> str:
    """Return what is known of a parameter, one fact a line.

    `read` is the last release in which it was read.
    """
    return "\n".join(_row_lines(row, read))


def _row_lines(row: ParameterRow, read: Release) -> Iterator[str]:
    yield f"type: {row.type or 'any'}"
    if row.default is not None:
        yield f"default: {_value(row.default)}"
    if row.is_required:
        yield "required: the node stops without a valid value"
    if row.only_with:
        yield f"only with: {row.only_with}"
    for switch, value in row.unless.items():
        yield f"without effect unless: {switch} is {_value(value)}"
    yield from _accepted_values(row)
    if row.entries:
        yield f"entries: {enumerated(row.entries, len(row.entries))}"
    if row.size is not None:
        yield f"values: {row.size}"
    yield f"releases: {_releases(row, read)}"


def _accepted_values(row: ParameterRow) -> Iterator[str]:
    """Yield the limits of a parameter's value, and the values that it may have."""
    bounds = (
        ("more than", row.above),
        ("less than", row.below),
        ("at least", row.lower),
        ("at most", row.upper),
    )
    limits = [f"{words} {bound:g}" for words, bound in bounds if bound is not None]
    if limits:
        yield f"value: {enumerated(limits)}"
    if row.one_of:
        yield f"value: {enumerated(map(_value, row.one_of), word='or')}"


def _releases(row: ParameterRow, read: Release) -> str:
    if not row.releases:
        return f"{COVERED[0].title()} to {read.title()}"
    if row.until == COVERED[-1]:
        return f"{row.releases} (read up to {read.title()})"
    return row.releases


def _value(value: Any) -> str:
    return json.dumps(value)
