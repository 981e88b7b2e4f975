"""Small URDFs, each at the edge of a rule, with ROS 2's verdict on it."""

from tests.robot.edge_cases import document, joints, links, markup, materials, numbers, references, tree
from tests.robot.edge_cases.case import EdgeCase

__all__ = ["EDGE_CASES", "EdgeCase"]

EDGE_CASES: tuple[EdgeCase, ...] = (
    document.CASES
    + markup.CASES
    + references.CASES
    + numbers.CASES
    + links.CASES
    + materials.CASES
    + joints.CASES
    + tree.CASES
)
