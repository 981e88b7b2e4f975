"""The thumbnails of the class's page: a robot with what one edit changes, and nothing else that differs."""

from typing import Any

import pytest
from lxml import etree

from grader.report.pages.class_page import thumbnail
from tests.samples import SAMPLES


def drawn(sample: str, *criteria: str) -> tuple[str, list[str]]:
    """Return the title of a sample's thumbnail, and the classes of its signs."""
    root: Any = etree.fromstring(thumbnail(SAMPLES[sample].grade(), criteria))
    signs = {path.get("class") for path in root.iter("{*}path")} - {None, "halo"}
    edges = {sign for sign in signs if sign.startswith(("edge", "hidden"))}
    return root.findtext("{*}title"), sorted(signs - edges)


@pytest.mark.parametrize(
    ("sample", "criteria", "view", "signs"),
    [
        ("lidar-buried", ("lidar-frame", "lidar-on-top"), "side (from -y)", ["ground", "reference"]),
        ("colour-0-255", ("base-green",), "side (from -y)", ["ground", "leader"]),
        ("axis-negated", ("left-wheel-forward",), "top (from +z)", ["arrow"]),
        (
            "lidar-offset-in-visual",
            ("lidar-frame",),
            "side (from -y)",
            ["axis-x", "axis-y", "axis-z", "ground", "reference"],
        ),
    ],
)
def test_a_thumbnail_shows_one_mistake(sample: str, criteria: tuple[str, ...], view: str, signs: list[str]) -> None:
    """Outlines for shapes, frames where no shape differs, arrows for wheels, else a ring; in the view that shows it."""
    title, found = drawn(sample, *criteria)
    assert view in title
    assert found == signs


@pytest.mark.parametrize(
    ("sample", "criterion"), [("pictures-only", "lidar-frame"), ("setup-syntax-error", "setup-installs-urdf")]
)
def test_some_have_none(sample: str, criterion: str) -> None:
    """Without a robot, or if the edit is about the package, there is nothing to see."""
    assert thumbnail(SAMPLES[sample].grade(), (criterion,)) == ""
