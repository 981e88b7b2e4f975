"""No check can change what the next one gets."""

from collections.abc import Iterator, Mapping
from typing import Any

import pytest

from grader.lab.grading.grade import grade
from grader.lab.grading.subjects import Subjects
from grader.ros.urdf.reader import read_urdf
from tests.samples import LAB6, opened

pytestmark = pytest.mark.slow

NAMED = """
    Submission Tree File Package Read Reading Problem Kind Location LazyLocation Configuration Robot Link Joint Limit Mimic Dynamics
    SafetyController Calibration Visual Collision Inertial Box Cylinder Sphere Mesh Origin Material Transform Outcome
    Launch StartedNode NamedFile RvizFile YamlNode
"""
WITH_ALL = """<robot name="a"><link name="l"/><link name="m"><inertial><mass value="1"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
<visual><geometry><mesh filename="package://a/b.stl"/></geometry></visual>
<collision><geometry><sphere radius="1"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="l"/><child link="m"/><limit lower="0" upper="1" effort="1" velocity="1"/><mimic joint="j"/>
<dynamics damping="1"/><safety_controller k_velocity="1"/><calibration rising="1"/></joint></robot>"""


def names_of(value: object) -> tuple[str, ...]:
    """Return the names of the fields of a record, dataclass or named tuple."""
    names: tuple[str, ...] = getattr(value, "_fields", ())
    return (*getattr(value, "__dataclass_fields__", ()), *names)


def inside(value: object, found: dict[int, object]) -> Iterator[object]:
    """Yield each object with fields that a value is or contains, once; `found` keeps them."""
    if id(value) in found:
        return
    found[id(value)] = value
    names = names_of(value)
    if names:
        yield value
    parts: Any = [getattr(value, name) for name in names]
    if not names and isinstance(value, Mapping):
        parts = value.values()
    elif not names and isinstance(value, tuple | list):
        parts = value
    for part in parts:
        yield from inside(part, found)


def test_what_a_check_gets_is_frozen() -> None:
    """Assigning a field of a submission, of anything in it, of a pose or of an outcome raises AttributeError."""
    submission = opened("submissions/lab6/reference")
    subjects, results = Subjects(LAB6, submission), grade(LAB6, submission).results
    assert subjects.robot is not None
    examined = (
        submission,
        subjects.robot,
        subjects.robot.pose("lidar"),
        read_urdf(WITH_ALL.encode(), "a.urdf"),
        results,
    )
    kinds = set()
    for value in inside(examined, {}):
        kinds.add(type(value).__name__)
        for name in names_of(value):
            with pytest.raises(AttributeError):
                setattr(value, name, getattr(value, name))
    assert kinds >= set(NAMED.split())
