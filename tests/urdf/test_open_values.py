"""What xacro leaves open of a robot cannot be read by accident, and what is known of the same element can."""

import pytest

from grader.base.errors import NotDecided
from grader.base.source import LazyLocation, Source
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint, Link, Material, Robot, UnresolvedPart

pytestmark = pytest.mark.slow

OPEN = UnresolvedPart(
    "the argument is not known", LazyLocation(Source("robot.urdf", "<robot/>"), 0)
)


@pytest.mark.parametrize(
    "field", ["limit", "mimic", "dynamics", "safety_controller", "calibration"]
)
def test_an_open_part_of_a_joint(field: str) -> None:
    """Reading it needs manual grading; the other parts are known."""
    joint = Joint("j", "revolute", "a", "b", unresolved={field: OPEN})
    found = Configuration(
        Robot("r", (Link("a"), Link("b")), (joint,)), is_guarded=True
    ).robot.joints[0]
    assert found.parent == "a"
    with pytest.raises(NotDecided, match="the argument is not known"):
        getattr(found, field)


@pytest.mark.parametrize("field", ["rgba", "texture"])
def test_an_open_material(field: str) -> None:
    """Neither the colour nor the texture of a material can be read if something of it is open."""
    material = Material("green", (0.0, 1.0, 0.0, 1.0), unresolved={"color": OPEN})
    found = Configuration(
        Robot("r", (Link("a"),), (), (material,)), is_guarded=True
    ).robot.materials[0]
    assert found.name == "green"
    with pytest.raises(NotDecided, match="the argument is not known"):
        getattr(found, field)
