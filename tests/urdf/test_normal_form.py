"""The normal form of a robot: equal for copies whose names, order, comments and numbers were rewritten, and for no other."""

import re

import pytest

from grader.ros.urdf.normal_form import robot_hash
from grader.ros.urdf.reader import read_urdf
from tests.samples import LAB6, SAMPLES

pytestmark = pytest.mark.slow

REFERENCE = (LAB6.path.parent / LAB6.reference / LAB6.urdf).read_text(encoding="utf-8")


def hash_of(text: str) -> str:
    """Return the hash of the robot in a URDF."""
    return robot_hash(read_urdf(text.encode()))


def reordered(text: str) -> str:
    """Return a URDF with its joints before its links, and its links in the reverse order."""
    joints = re.findall(r"  <joint.*?</joint>\n", text, re.DOTALL)
    links = re.findall(r"  <link [^>]*/>\n|  <link.*?</link>\n", text, re.DOTALL)
    materials = re.findall(r"  <material name=\"\w+\">.*?</material>\n", text, re.DOTALL)
    return f'<robot name="my_robot">{"".join([*materials, *joints, *reversed(links)])}</robot>'


COPIES = {
    "comments": REFERENCE.replace("<link", "<!-- my own idea --><link"),
    "order": reordered(REFERENCE),
    "white space": REFERENCE.replace("\n", "\r\n\n\t"),
    "numbers": REFERENCE.replace("0.6 0.4 0.2", ".60 4e-1 0.20").replace('"0 0 0"', '"-0 0.0 0"'),
    "defaults": REFERENCE.replace(' rpy="0 0 0"', ""),
    "materials": REFERENCE.replace('"green"', '"grass"'),
    "joint names": REFERENCE.replace("base_lidar_joint", "j1").replace(
        "base_left_wheel_joint", "j2"
    ),
    "the length of an axis": REFERENCE.replace('axis xyz="0 0 1"', 'axis xyz="0 0 1.0001"', 1),
    "robot name": REFERENCE.replace('name="my_robot"', 'name="mine"'),
    "unused material": REFERENCE.replace(
        "</robot>", '<material name="x"><color rgba="1 0 0 1"/></material></robot>'
    ),
}


@pytest.mark.parametrize("name", COPIES)
def test_a_rewritten_copy_has_the_same_form(name: str) -> None:
    """What a copy can change without changing the robot does not count."""
    assert COPIES[name] != REFERENCE
    assert hash_of(COPIES[name]) == hash_of(REFERENCE)


OTHERS = {
    "a number": REFERENCE.replace("0.15 0 0.225", "0.15 0 0.2251"),
    "a colour": REFERENCE.replace("0 0.6 0 1", "0 0.61 0 1"),
    "a link's name": REFERENCE.replace('"lidar"', '"laser"'),
    "a joint's type": REFERENCE.replace("continuous", "fixed", 1),
    "a slightly turned axis": REFERENCE.replace('axis xyz="0 0 1"', 'axis xyz="0 0.0008 1"', 1),
    "an axis": REFERENCE.replace('axis xyz="0 0 1"', 'axis xyz="0 0 -1"', 1),
    "a link more": REFERENCE.replace("</robot>", '<link name="x"/></robot>'),
}


@pytest.mark.parametrize("name", OTHERS)
def test_another_robot_has_another_form(name: str) -> None:
    """Every number, type and name that something refers to counts."""
    assert OTHERS[name] != REFERENCE
    assert hash_of(OTHERS[name]) != hash_of(REFERENCE)


MIMIC = '<mimic joint="base_left_wheel_joint"/></joint>'
LEADER = REFERENCE.replace("</joint>", MIMIC, 3).replace(MIMIC, "</joint>", 2)


def test_a_name_that_a_joint_mimics_counts() -> None:
    """A joint that is referred to keeps its name."""
    assert MIMIC in LEADER
    assert hash_of(LEADER) != hash_of(REFERENCE)
    renamed = LEADER.replace('joint name="base_left_wheel_joint"', 'joint name="j2"')
    assert hash_of(renamed) != hash_of(LEADER)


@pytest.mark.parametrize("text", ["", "no xml", "<robot/>", '<robot name="my_robot"></robot>'])
def test_without_links_there_is_no_form(text: str) -> None:
    """Empty robots are not identical work."""
    assert hash_of(text) == ""


def test_the_samples_differ() -> None:
    """Different mistakes make different robots."""
    forms: dict[str, list[str]] = {}
    for name, sample in SAMPLES.items():
        if sample.expected.path.endswith(".urdf") and sample.expected.lost:
            text = (sample.path).read_text(encoding="utf-8", errors="replace")
            forms.setdefault(hash_of(text) or name, []).append(name)
    assert [names for names in forms.values() if len(names) > 1] == []
