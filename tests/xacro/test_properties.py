"""Plain xacro is expanded as xacro itself does; anything more needs manual grading."""

import re
import xml.dom.minidom
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from grader.submission.submission import Submission, read_submission
from grader.submission.urdf import NeedsExpansion, Read
from grader.xacro.properties import expand
from tests.processor_time import processor_time
from tests.samples import LAB6, opened

START = '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">\n'
NAMES = ("a", "b", "width", "wheel_radius")


def robot(*lines: str) -> str:
    """Return a robot in xacro."""
    return START + "\n".join(lines) + "\n</robot>\n"


def xacros_own(text: str) -> xml.dom.minidom.Document:
    """Return xacro's own expansion of a text, only ever one of these tests."""
    xacro: Any = pytest.importorskip("xacro")
    document = xacro.parse(text)
    xacro.process_doc(document)
    return document  # type: ignore[no-any-return]


def attributes(document: xml.dom.minidom.Document) -> list[tuple[str, list[tuple[str, str]]]]:
    """Return every element with its attributes, in order."""
    elements = document.getElementsByTagName("*")
    return [
        (element.tagName, sorted((n, v) for n, v in element.attributes.items() if not n.startswith("xmlns")))
        for element in elements
    ]


def compare(text: str) -> None:
    """Assert that the expanded text equals xacro's own, number for number."""
    mine = expand(text)
    assert mine is not None
    for (tag, own), (other_tag, theirs) in zip(
        attributes(xml.dom.minidom.parseString(mine)), attributes(xacros_own(text)), strict=True
    ):
        assert tag == other_tag
        for (name, value), (other_name, expected) in zip(own, theirs, strict=True):
            assert name == other_name
            numbers, required = value.split(), expected.split()
            assert len(numbers) == len(required)
            for one, other in zip(numbers, required, strict=True):
                assert one == other or float(one) == pytest.approx(float(other), rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(
    "text",
    [
        robot('<link name="a"/>'),
        robot('<origin xyz="0 ${1/2} -${0.25}" rpy="${-pi/2} 0 0"/>'),
        robot('<xacro:property name="r" value="0.1"/>', '<cylinder radius="${r}" length="${r / 2}"/>'),
        robot(
            '<cylinder radius="${r}"/>',
            '<xacro:property name="r" value="${2 * s}"/>',
            '<xacro:property name="s" value=".1"/>',
        )
        .replace('<cylinder radius="${r}"/>\n', "")
        .replace("</robot>", '<cylinder radius="${r}"/></robot>'),
        robot("<xacro:property name='n' value='left'></xacro:property>", '<link name="${n}_wheel"/>'),
        robot('<box size="${0.6} ${2*0.2} ${sqrt(0.04)}"/>', '<origin rpy="${radians(90)} ${max(1, 2)}"/>'),
        robot('<xacro:property value="1" name="a"/><a x="${a}"/>', '<xacro:property name="a" value="2"/><a x="${a}"/>'),
        robot(
            '<xacro:property name="h" value="0.2"/>',
            '<xacro:property name="pos" value="0.15 0 ${h}"/>',
            '<a xyz="${pos}"/>',
        ),
        robot('<xacro:arg name="unused" default="1"/>', '<a x="${1}"/>'),
        robot("<!-- ${ not this } <xacro:include/> -->", '<origin xyz="${1} 0 0"/>'),
    ],
)
def test_expansion_equals_xacros(text: str) -> None:
    """Properties, numbers and pi give the same."""
    compare(text)


numbers = (
    st.integers(0, 20).map(str) | st.floats(0.01, 9).map(lambda value: f"{value:.3f}") | st.sampled_from(["pi", *NAMES])
)
expressions = st.recursive(
    numbers,
    lambda inner: (
        st.tuples(inner, st.sampled_from(["+", "-", "*"]), inner).map(lambda t: f"({t[0]} {t[1]} {t[2]})")
        | inner.map(lambda text: f"-{text}")
        | inner.map(lambda text: f"cos({text})")
    ),
    max_leaves=6,
)


@settings(max_examples=150, deadline=None)
@given(st.lists(expressions, min_size=1, max_size=4))
def test_any_numbers(values: list[str]) -> None:
    """A number that is evaluated here is the same in xacro."""
    properties = [f'<xacro:property name="{name}" value="{index + 1}.5"/>' for index, name in enumerate(NAMES)]
    compare(robot(*properties, *(f'<origin xyz="${{{value}}} 0 0"/>' for value in values)))


@pytest.mark.parametrize(
    "line",
    [
        '<xacro:macro name="w" params="p"/>',
        '<xacro:include filename="/etc/passwd"/>',
        '<xacro:if value="true"><link name="a"/></xacro:if>',
        '<origin xyz="$(arg a) 0 0"/>',
        '<origin xyz="${unknown} 0 0"/>',
        "<origin xyz=\"${__import__('os').system('true')} 0 0\"/>",
        '<origin xyz="${(lambda: 1)()} 0 0"/>',
        '<origin xyz="${9**9**9} 0 0"/>',
        '<origin xyz="${1/0} 0 0"/>',
        '<origin xyz="$${1} 0 0"/>',
        '<xacro:property name="n" value="' + "9" * 190 + '"/><origin xyz="${' + "*".join("n" * 60) + '} 0 0"/>',
        '<origin xyz="${late} 0 0"/><xacro:property name="late" value="1"/>',
        '<xacro:property name="if" value="1"/>',
        '<xacro:property name="a" value="true"/><origin xyz="${a} 0 0"/>',
        '<xacro:property name="a" value="0.1_0"/><origin xyz="${a * 2} 0 0"/>',
        "<xacro:property name='a\" value='1'/>",
        '<origin xyz="${[1][0]} 0 0"/>',
        "<origin xyz=\"${'a' * 3} 0 0\"/>",
        '<origin xyz="${' + "-" * 5000 + '1} 0 0"/>',
        '<xacro:property name="x" value="${x}"/><origin xyz="${x} 0 0"/>',
        '<xacro:property name="block"><origin xyz="1 0 0"/></xacro:property>',
    ],
)
def test_other_features_are_not_evaluated(line: str) -> None:
    """Text that runs code, includes files or needs more than numbers is not evaluated."""
    assert expand(robot(line)) is None


def test_a_chain_of_properties_takes_no_time() -> None:
    """Each property is evaluated once, however often it is used."""
    lines = [f'<xacro:property name="p{i}" value="${{{"+".join([f"p{i - 1}"] * 9)}}}"/>' for i in range(10, 0, -1)]
    text = robot('<xacro:property name="p0" value="1"/>', *lines, '<a x="${p10}"/>')
    with processor_time(0.2):
        expand(text)
    compare(text)


def test_an_undeclared_prefix_is_an_error() -> None:
    """xacro refuses a prefix that is not declared."""
    assert expand('<robot name="r">\n<xacro:property name="a" value="1"/></robot>') is None


@given(st.text(alphabet="$ {}()<>xacro:propety/=\"'.+-*01\n", max_size=200))
def test_any_text(text: str) -> None:
    """Any text is accepted, and every line keeps its number."""
    expanded = expand(text)
    assert expanded is None or expanded.count("\n") == text.count("\n")


REFERENCE = (LAB6.path.parent / LAB6.reference / LAB6.urdf).read_text(encoding="utf-8")
PLAIN = REFERENCE.replace('rpy="-1.57 0 0"', 'rpy="${-pi/2} 0 0"')
MACRO = REFERENCE.replace("</robot>", '<xacro:macro name="m" params="p"/>\n</robot>')


def package_with(folder: Path, text: str, *, name: str = "my_robot.urdf", command: bool = True) -> Submission:
    """Return the reference package with another URDF, whose launch file runs xacro on it, or not."""
    import shutil

    shutil.copytree(LAB6.path.parent / LAB6.reference, folder / "my_robot")
    (folder / "my_robot" / LAB6.urdf).unlink()
    (folder / "my_robot" / "urdf" / name).write_text(text)
    launch = folder / "my_robot" / "launch" / "my_robot_rviz.launch.py"
    if command:
        changed = re.sub(
            r"    with open.*?read\(\)\n",
            "    from launch.substitutions import Command\n    robot_description = Command(['xacro ', share + '/my_robot.urdf'])\n",
            launch.read_text(),
            flags=re.DOTALL,
        )
        assert "Command" in changed
        launch.write_text(changed)
    return opened(folder)


def state(submission: Submission) -> str:
    """Return the state of a submission's URDF as text."""
    match submission.urdf:
        case Read(is_expanded=is_expanded):
            return "expanded" if is_expanded else "read"
        case NeedsExpansion():
            return "needs expansion"
    return "absent or unreadable"


def test_xacro_that_the_launch_file_expands(tmp_path: Path) -> None:
    """Numbers are evaluated if the launch file runs xacro; macros need manual grading; else ROS 2 gets the file as it is."""
    plain = package_with(tmp_path / "plain", PLAIN)
    assert (state(plain), plain.verdict) == ("expanded", "clean")
    assert state(package_with(tmp_path / "macro", MACRO)) == "needs expansion"
    as_it_is = package_with(tmp_path / "as-it-is", PLAIN, command=False)
    assert (state(as_it_is), as_it_is.verdict) == ("read", "rejected")


def test_xacro_by_its_name() -> None:
    """A file named .xacro is meant to be expanded; one named .urdf is not, unless a launch file says so."""
    assert state(read_submission(PLAIN.encode(), identity="a", path="a.urdf.xacro")) == "expanded"
    assert state(read_submission(MACRO.encode(), identity="a", path="a.xacro")) == "needs expansion"
    assert state(read_submission(PLAIN.encode(), identity="a", path="a.urdf")) == "read"
    assert state(read_submission(REFERENCE.encode(), identity="a", path="a.xacro")) == "read"
