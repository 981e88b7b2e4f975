"""The result of testing a rubric as JSON, schema grader/rubric-test/v1."""

from typing import Any

from grader import __version__
from grader.mutation.margins import Margin
from grader.mutation.result import Loss, MutantResults, RubricTest, Survivor
from grader.report.json_data import exact, rounded, to_json


def render_rubric_test_json(test: RubricTest) -> str:
    """Return the result of testing a rubric."""
    report, rubric, samples = test.reference, test.reference.rubric, test.samples
    return to_json(
        {
            "schema": "grader/rubric-test/v1",
            "grader": {"version": __version__},
            "rubric": {"id": rubric.id, "title": rubric.title, "sha256": rubric.sha256},
            "seed": test.seed,
            "score": rounded(float(test.mutants.score)),
            "reference": {
                "score": exact(report.score),
                "max_score": exact(report.max_score),
                "pending": exact(report.pending),
                "lost": list(test.lost),
            },
            "equivalents": {
                "tried": dict(test.equivalents.tried),
                "unused": dict(test.equivalents.unused),
                "lost": list(map(_loss, test.equivalents.losses)),
            },
            "samples": {
                "tried": samples.tried,
                "skipped": samples.skipped,
                "different": list(map(_loss, samples.different)),
            }
            if samples is not None
            else None,
            "mutants": _counts(test.mutants),
            "survivors": list(map(_survivor, test.mutants.survivors)),
            "ignored": list(map(_survivor, test.mutants.ignored)),
            "faults": list(map(_loss, test.mutants.faults)),
            "unused_patterns": list(test.mutants.unused),
            "idle": list(test.mutants.idle),
            "margins": list(map(_margin, test.mutants.margins)),
        }
    )


def _counts(found: MutantResults) -> dict[str, int]:
    """Return how many mutants there are, and what became of those that were graded."""
    return {
        "total": found.total,
        "tried": found.tried,
        "caught": found.caught,
        "same_robot": found.same,
        "ignored": len(found.ignored),
        "survived": len(found.survivors),
    }


def _survivor(survivor: Survivor) -> dict[str, Any]:
    mutant = survivor.mutant
    return {
        "id": mutant.id,
        "family": mutant.family,
        "path": mutant.path,
        "line": mutant.line,
        "diff": survivor.diff,
        "suggestion": survivor.suggestion,
        "reason": survivor.reason or None,
    }


def _loss(loss: Loss) -> dict[str, Any]:
    return {"name": loss.name, "criteria": dict(loss.criteria), "diff": loss.diff}


def _margin(margin: Margin) -> dict[str, Any]:
    return {
        "criterion": margin.criterion,
        "unit": margin.unit or None,
        "tolerance": rounded(margin.tolerance),
        "reference": rounded(margin.reference),
        "is_near": margin.is_near,
    }
