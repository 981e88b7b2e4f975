"""The baseline of an inspection: findings that are known, and not shown again.

A finding is known by the fingerprint that SARIF has. `grade` and `batch` never read a baseline.
"""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from grader.base.errors import InputError
from grader.base.problems import Problem
from grader.base.text import printable_path
from grader.files.reading import read_capped
from grader.report.findings import finding_of_problem, fingerprints
from grader.report.inspection import Inspection

_SCHEMA = "grader/baseline/v1"
_MAX_SIZE = 64 * 1024 * 1024  # bytes


def baseline_text(inspection: Inspection) -> str:
    """Return the baseline that has every finding of an inspection, a line for each."""
    rows = []
    for problem, fingerprint in _fingerprinted(inspection):
        row = {
            "fingerprint": fingerprint,
            "path": problem.location.path,
            "code": problem.code,
            "message": problem.message,
        }
        rows.append(f"  {json.dumps(row)}")
    lines = "\n" + ",\n".join(rows) + "\n " if rows else ""
    return f'{{\n "schema": "{_SCHEMA}",\n "findings": [{lines}]\n}}\n'


def read_baseline(path: str) -> frozenset[str]:
    """Return the fingerprints in the file that --baseline names. Raises InputError."""
    shown = printable_path(path)
    data = read_capped(Path(path), _MAX_SIZE, shown=shown, advice="")
    try:
        baseline = json.loads(data)
        known = [str(row["fingerprint"]) for row in baseline["findings"]]
        is_baseline = baseline["schema"] == _SCHEMA
    except (ValueError, KeyError, TypeError, RecursionError):
        is_baseline = False
        known = []
    if not is_baseline:
        raise InputError(f"--baseline: {shown} is no baseline: --write-baseline writes one")
    return frozenset(known)


def without_known(inspection: Inspection, known: frozenset[str]) -> Inspection:
    """Return an inspection without the findings of these fingerprints, which are counted."""
    hidden = set()
    for problem, fingerprint in _fingerprinted(inspection):
        if fingerprint in known:
            hidden.add(problem)
    robots = [replace(robot, hidden=robot.hidden | hidden) for robot in inspection.robots]
    others = [problem for problem in inspection.package_problems if problem not in hidden]
    return replace(
        inspection, robots=tuple(robots), package_problems=tuple(others), known=len(hidden)
    )


def _fingerprinted(inspection: Inspection) -> Iterator[tuple[Problem, str]]:
    """Yield the problems of an inspection with their fingerprints, as SARIF has them."""
    problems = sorted(inspection.problems, key=lambda problem: problem.location[:3])
    findings = [finding_of_problem(problem) for problem in problems]
    yield from zip(problems, fingerprints(findings, inspection.base), strict=True)
