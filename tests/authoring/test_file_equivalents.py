"""Equivalents of YAML files give every node the parameters that it had, and nothing in the workspace disagrees."""

import pytest

from grader.files.tree import overlaid
from grader.lab.authoring.file_equivalents import file_equivalents
from grader.lab.submission.submission import Submission
from grader.ros.config.yaml_nodes import yaml_value
from grader.workspace.rules.reading import read_agreement
from tests.workspace.carts import cart, cart_files

pytestmark = pytest.mark.slow

DETECTOR = "cart_bringup/config/detector.yaml"


def workspace_with(detector: str) -> Submission:
    """Return the workspace with another parameter file of the detector."""
    return cart({**cart_files(), DETECTOR: detector})


def parameters(submission: Submission) -> dict[str, list[object]]:
    """Return the values that nodes and controllers get, by their names."""
    owners = submission.workspace.parameters.owners
    return {
        name: [{key: it.value for key, it in one.values.items()} for one in given]
        for name, given in owners.items()
    }


def test_nodes_get_the_same_parameters_from_equivalents() -> None:
    """Under /** in place of their name, and in braces; the files of controllers and of bridges stay what they are, too."""
    submission = workspace_with(cart_files()[DETECTOR])
    assert submission.reopen is not None
    found = dict(file_equivalents(submission))
    assert list(found["parameters of /**"]) == [DETECTOR]
    assert {path.rpartition("/")[2] for path in found["flow style of YAML"]} == {
        "bridge.yaml",
        "controllers.yaml",
        "detector.yaml",
        "hall.yaml",
        "navigation.yaml",
    }
    for texts in found.values():
        changed = overlaid(
            submission.whole_tree, {path: text.encode() for path, text in texts.items()}
        )
        same = submission.reopen(changed)
        assert parameters(same) == parameters(submission)
        assert read_agreement(same.workspace).mismatches == ()


@pytest.mark.parametrize(
    ("detector", "rewritings"),
    [
        ("'detector':\n  ros__parameters: {threshold: 0.5, names: ['a, b', c]}\n", {"/**", "flow"}),
        ("/**:\n  ros__parameters:\n    threshold: 0.5\n", {"flow"}),
        ("other:\n  ros__parameters:\n    threshold: 0.5\n", {"flow"}),
        ("{detector: {ros__parameters: {threshold: 0.5}}}\n", {"flow"}),
        (
            "detector:\n  ros__parameters:\n    threshold: 0.5\nalarm:\n  ros__parameters:\n    volume: 3\n",
            {"flow"},
        ),
        (
            "detector:\n  ros__parameters:\n    text: |\n      a\n",
            {"/**"},
        ),  # no block of text is in braces
        ("detector:\n  ros__parameters:\n    text: a, b\n", {"/**"}),
        ("detector:\n  ros__parameters:\n    text: ]\n    other: {\n", set()),
    ],
)
def test_a_file_that_would_mean_something_else_has_no_equivalent(
    detector: str, rewritings: set[str]
) -> None:
    """What an equivalent changes is the text only: the parameters in it are those of the file."""
    found = {
        rewriting: texts[DETECTOR]
        for rewriting, texts in file_equivalents(workspace_with(detector))
        if DETECTOR in texts
    }
    assert {"/**" if "/**" in rewriting else "flow" for rewriting in found} == rewritings
    for text in found.values():
        assert [*yaml_value(text).values()] == [*yaml_value(detector).values()]
