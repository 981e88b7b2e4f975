"""The attributes of a broken tag are read only if every word of it has a place."""

import pytest

from grader.ros.xml.broken_tags import read_attributes

pytestmark = pytest.mark.slow


@pytest.mark.parametrize(
    ("tag", "text", "expected"),
    [
        ("origin", ' xyz="0 0 1 rpy="0 0 0"/', {"xyz": "0 0 1", "rpy": "0 0 0"}),
        ("origin", ' xyz="0 0 1rpy="0 0 0"', {"xyz": "0 0 1", "rpy": "0 0 0"}),
        ("origin", ' xyz="0 ${y} 1 rpy="0 0 0"', {"xyz": "0 ${y} 1", "rpy": "0 0 0"}),
        ("origin", ' xyz="0 0 rpy="0 0 0"', None),
        ("origin", ' xyz="0 0 1 pose="0 0 0"', None),
        ("joint", ' name="a type="fixed"', {"name": "a", "type": "fixed"}),
        ("joint", ' name="a b type="fixed"', None),
        ("xacro:m", ' side="left y="1"', {"side": "left", "y": "1"}),
        ("xacro:m", ' side="lefty="1"', None),
        ("child", ' link=="a"', {"link": "a"}),
        ("child", ' link : "a"', {"link": "a"}),
        ("child", ' link "a"', {"link": "a"}),
        ("child", " link='a\"", {"link": "a"}),
        ("child", " link=“a”", {"link": "a"}),
        ("child", " link=“a", None),
        ("child", ' link="a', None),
        ("child", ' link="a" link="b"', None),
        ("child", ' "a"', None),
        ("child", " link=a", None),
    ],
)
def test_attributes(tag: str, text: str, expected: dict[str, str] | None) -> None:
    """A quote or an equals sign is put where one place only gives the numbers of the attributes."""
    assert read_attributes(tag, text) == expected
