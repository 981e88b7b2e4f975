"""The drawing of a graph: layers from left to right, no boxes upon each other, circles, and trees of transforms."""

from itertools import combinations

from hypothesis import given
from hypothesis import strategies as st

from grader.base.source import Location
from grader.report.drawing.graph_layout import DrawnBox, lay_out
from grader.report.shown_graph import transform_tree
from grader.workspace.api import GraphTransform

_AT = Location("a.py", 1, 1)


def overlap(one: DrawnBox, other: DrawnBox) -> bool:
    """Return whether two boxes lie upon each other."""
    beside = one.x + one.width <= other.x or other.x + other.width <= one.x
    above = one.y + one.height <= other.y or other.y + other.height <= one.y
    return not (beside or above)


def test_arrows_lead_to_the_right() -> None:
    """Of a chain and a shorter way, the longest way counts; long texts end with points."""
    texts = {name: [name * 30] for name in "abcde"} | {"alone": ["x" * 60], "other": ["y" * 60]}
    layout = lay_out(texts, [("a", "b"), ("b", "c"), ("a", "c"), ("d", "c")])
    boxes = layout.boxes
    assert boxes["a"].x < boxes["b"].x < boxes["c"].x
    assert boxes["alone"].lines == (f"{'x' * 41}...",)
    assert boxes["alone"].y > boxes["c"].y
    assert [curve.path[0] for curve in layout.curves] == ["M"] * 4
    assert lay_out({}, []).width == 0


def test_a_circle_has_one_arrow_back() -> None:
    """The first item stays on the left."""
    texts = {name: [name] for name in "abc"}
    boxes = lay_out(texts, [("a", "b"), ("b", "c"), ("c", "a"), ("b", "b")]).boxes
    assert boxes["a"].x < boxes["b"].x < boxes["c"].x


_NAMES = "abcdefghij"
_ARROWS = st.lists(st.tuples(st.sampled_from(_NAMES), st.sampled_from(_NAMES)), max_size=30)


@given(arrows=_ARROWS)
def test_no_two_boxes_lie_upon_each_other(arrows: list[tuple[str, str]]) -> None:
    """Whatever the arrows are; and all are inside of the drawing."""
    texts = {name: [name * (index * 4 + 1), "type"] for index, name in enumerate(_NAMES)}
    layout = lay_out(texts, arrows)
    assert layout == lay_out(texts, arrows)
    for one, other in combinations(layout.boxes.values(), 2):
        assert not overlap(one, other)
    for box in layout.boxes.values():
        assert box.x >= 0
        assert box.y >= -0.1
        assert box.x + box.width <= layout.width + 0.1
        assert box.y + box.height <= layout.height + 0.1


def transform(parent: str, child: str) -> GraphTransform:
    """Return a transform between two frames."""
    return GraphTransform(parent, child, "code", True, "node", _AT)


def test_transforms_are_a_tree() -> None:
    """Each is there once, also in a circle and below two parents."""
    rows = [transform("odom", "base"), transform("map", "odom"), transform("base", "a")]
    assert list(transform_tree(rows)) == [
        (0, "map", ""),
        (1, "odom", "node"),
        (2, "base", "node"),
        (3, "a", "node"),
    ]
    circle = [transform("a", "b"), transform("b", "a")]
    assert [frame for _, frame, _ in transform_tree(circle)] == ["a", "b", "a"]
    assert len([*transform_tree([*rows, transform("other", "base")])]) == 6
