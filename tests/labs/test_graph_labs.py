"""What six labs ask of the graph: correct variants pass whatever their structure, wrong ones lose what they should."""

import tomllib
from functools import cache
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

from grader.base.toml_file import toml_literal
from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import open_submission
from tests.command_line import run
from tests.labs.variants import FOLDER, apply_edit, make_variant, variants_of

pytestmark = pytest.mark.slow

LABS = sorted(path.parent.name for path in FOLDER.glob("*/graph.toml"))
_HEAD = """
id = "lab"
title = "Lab"
without_urdf = "manual"
[[part]]
id = "nodes"
title = "Nodes"
needs = "package"
"""


@cache
def graph_of(lab: str) -> dict[str, Any]:
    """Return what graph.toml of a lab has."""
    return tomllib.loads((FOLDER / lab / "graph.toml").read_text("utf-8"))


def names_of(lab: str) -> list[str]:
    """Return the variants of a lab that are graded here."""
    own_variants = [variant["id"] for variant in graph_of(lab).get("variant", ())]
    if own_variants:
        return ["solution", *own_variants]
    correct = [name for name in variants_of(lab) if name[0] == "r"]
    return ["solution", *correct, *graph_of(lab)["lost"]]


def written(lab: str, name: str, folder: Path) -> Path:
    """Write a variant of a lab, and return its folder."""
    own_variants = {variant["id"]: variant for variant in graph_of(lab).get("variant", ())}
    if not own_variants:
        return make_variant(lab, name, folder)
    workspace = folder / lab
    copytree(FOLDER / lab / "solution", workspace)
    for edit in own_variants[name]["edit"] if name != "solution" else ():
        apply_edit(edit, workspace)
    return workspace


def listed(lab: str, name: str, key: str) -> list[str]:
    """Return the criteria that a variant should lose, or that should need manual grading."""
    for variant in graph_of(lab).get("variant", ()):
        if variant["id"] == name:
            return list(variant.get(key, ()))
    return list(graph_of(lab).get(key, {}).get(name, ()))


def rubric_text(lab: str) -> str:
    """Return a rubric with the criteria of a lab."""
    text = _HEAD
    for name, row in graph_of(lab)["criterion"].items():
        text += f'[[criterion]]\nid = "{name}"\ntitle = "{name}"\npart = "nodes"\npoints = 1\n'
        text += f'check = "{row["check"]}"\nwith = {toml_literal(row["with"])}\n'
    return text


@pytest.mark.parametrize(("lab", "name"), [(lab, name) for lab in LABS for name in names_of(lab)])
def test_a_variant_loses_what_it_should(lab: str, name: str, tmp_path: Path) -> None:
    """Other names, more nodes, other launch files and components lose nothing."""
    (tmp_path / "lab.toml").write_text(rubric_text(lab), "utf-8")
    rubric = load_rubric(str(tmp_path / "lab.toml"))
    results = grade(rubric, open_submission(str(written(lab, name, tmp_path)), rubric.lab)).results
    statuses = {result.criterion.id: result.outcome.status for result in results}
    messages = [result.outcome.message for result in results]
    for key, wanted in (("lost", "failed"), ("pending", "pending")):
        named = [criterion for criterion, status in statuses.items() if status == wanted]
        assert named == listed(lab, name, key), messages
    assert set(statuses.values()) <= {"passed", "failed", "pending"}


@pytest.mark.parametrize("lab", ["hallway", "convoy"])
def test_an_unedited_draft_takes_other_structures(lab: str, tmp_path: Path) -> None:
    """A draft asks for ways and transforms of the solution, not for what publishes these."""
    solution = written(lab, "solution", tmp_path / "reference")
    assert run(["rubric", "new", tmp_path / "lab.toml", "--from", solution]).returncode == 0
    rubric = load_rubric(str(tmp_path / "lab.toml"))
    checks = {criterion.check.name for criterion in rubric.criteria}
    assert {"connects", "publishes_transform"} <= checks
    asking = {"connects", "publishes_transform", "topic_has_type", "reaches"}
    for name in names_of(lab):
        path = written(lab, name, tmp_path / name)
        results = grade(rubric, open_submission(str(path), rubric.lab)).results
        outcomes = {
            result.criterion.id: result.outcome.status
            for result in results
            if result.criterion.check.name in asking
        }
        failing = set(outcomes.values()) - {"passed"}
        is_of_graph = {"connects", "publishes_transform"} & {
            graph_of(lab)["criterion"][each]["check"]
            for each in (*listed(lab, name, "lost"), *listed(lab, name, "pending"))
        }
        assert bool(failing) is bool(is_of_graph), (name, outcomes)
