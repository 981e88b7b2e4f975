"""Findings as SARIF 2.1.0, for GitHub's code scanning and other viewers.

https://docs.oasis-open.org/sarif/sarif/v2.1.0/sarif-v2.1.0.html, and what GitHub reads of it:
https://docs.github.com/en/code-security/code-scanning/integrating-with-code-scanning/sarif-support-for-code-scanning
"""

import json
from collections.abc import Sequence
from functools import cache
from typing import Any
from urllib.parse import quote

from grader import __version__
from grader.base.extents import ended
from grader.base.source import Base, SourceOf
from grader.report.findings import (
    DOCUMENTATION,
    Finding,
    fingerprints,
    message_in_repository,
    place_in_repository,
)
from grader.report.json_data import to_json

_Object = dict[str, Any]

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_ROOT = "%SRCROOT%"  # of the repository, as GitHub calls it


def render_sarif(findings: Sequence[Finding], base: Base, source_of: SourceOf) -> str:
    """Return a log of one run, with the rules that have a result: criteria and kinds of problems.

    Several rules may share a code, which is their id: `ruleIndex` says which of them is meant.
    """
    read_once = cache(source_of)
    rules: dict[tuple[str, str], _Object] = {}
    for finding in findings:
        rules.setdefault((finding.rule.id, finding.rule.name), _rule(finding))
    names = sorted(rules)
    results = []
    for finding, fingerprint in zip(findings, fingerprints(findings, base), strict=True):
        index = names.index((finding.rule.id, finding.rule.name))
        result = {
            "ruleId": finding.rule.id,
            "ruleIndex": index,
            "level": finding.severity,
            "message": {"text": message_in_repository(finding, base)},
            "locations": [{"physicalLocation": _physical_location(finding, base, read_once)}],
            "partialFingerprints": {"grader/v1": fingerprint},
        }
        results.append(result)
    driver = {
        "name": "grader",
        "version": __version__,
        "informationUri": DOCUMENTATION,
        "rules": [rules[name] for name in names],
    }
    tool = {"driver": driver}
    run = to_json({"tool": tool, "columnKind": "unicodeCodePoints", "results": results})
    start = f'{{\n "$schema": {json.dumps(_SCHEMA)},\n "version": "2.1.0",\n "runs": ['
    return f"{start}{run.rstrip()}]\n}}\n"


def _rule(finding: Finding) -> _Object:
    """Return the rule of a finding; GitHub requires each of its texts."""
    rule = finding.rule
    data: _Object = {
        "id": rule.id,
        "shortDescription": {"text": rule.title},
        "fullDescription": {"text": rule.explanation},
        "help": {"text": rule.explanation},
        "defaultConfiguration": {"level": finding.severity},
    }
    if rule.name:
        data["name"] = rule.name
    if rule.page:
        data["helpUri"] = rule.page
    return data


def _physical_location(finding: Finding, base: Base, source_of: SourceOf) -> _Object:
    path, where = place_in_repository(finding, base)
    place: _Object = {"artifactLocation": {"uri": quote(path), "uriBaseId": _ROOT}}
    if where:
        end = ended(where, source_of)
        place["region"] = {
            "startLine": where.line,
            "startColumn": where.column,
            "endLine": end.end_line,
            "endColumn": end.end_column,
        }
    return place
