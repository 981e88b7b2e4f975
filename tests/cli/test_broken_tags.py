"""A broken tag costs the criteria that need it, and `urdf-loads`: the elements before and after it are graded as they stand."""

import json
import shutil
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from grader.xml.tinyxml2.recovery import Recovery
from tests.command_line import ROOT, run
from tests.examples import examples
from tests.work import limited_work

TEXT = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")
LIDAR = '  <link name="lidar">\n    <visual>\n'
SHAPE = '      <geometry>\n        <cylinder radius="0.1" length="0.05"/>\n      </geometry>\n      <material name="white"/>\n'


def replaced(*pairs: tuple[str, str]) -> str:
    """Return the reference with texts replaced, each of which it has."""
    text = TEXT
    for old, new in pairs:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text


def report(text: str, folder: Path, *more: str) -> dict[str, Any]:
    """Return the JSON report on a URDF, without hints."""
    path = folder / "my_robot.urdf"
    path.write_text(text, encoding="utf-8")
    done = run(("grade", path, "--format", "json", "--hints", "none", *more))
    assert (done.returncode, done.stderr) == (1, b"")
    return dict(json.loads(done.stdout))


def lost(found: dict[str, Any]) -> set[str]:
    """Return the criteria without points."""
    return {row["id"] for row in found["results"] if row["status"] in ("failed", "skipped") and not row["carried"]}


BROKEN = {
    "a visual that is not closed": (LIDAR + SHAPE + "    </visual>\n", LIDAR + SHAPE),
    "a link that is not closed": (SHAPE + "    </visual>\n  </link>\n", SHAPE + "    </visual>\n"),
    "an origin that is not closed": ('<origin xyz="0 0 0.1" rpy="0 0 0"/>', '<origin xyz="0 0 0.1" rpy="0 0 0">'),
    "a parent that is not closed": ('<parent link="base_link"/>\n    <child link="lidar"/>', '<parent link="base_link">\n    <child link="lidar"/>'),
    "an opening tag for a closing one": (SHAPE + "    </visual>\n  </link>", SHAPE + "    </visual>\n  <link>"),
    "a misspelt closing tag": (SHAPE + "    </visual>\n  </link>", SHAPE + "    </visual>\n  </lnk>"),
    "a surplus closing tag": ("  <!-- Wheels", "  </link>\n  <!-- Wheels"),
    "no > at the end of a tag": ('<link name="lidar">', '<link name="lidar"'),
    "a quote that is not closed": ('<link name="lidar">', '<link name="lidar>'),
    "a value without quotes": ('<link name="lidar">', "<link name=lidar>"),
    "a comma between attributes": ('radius="0.1" length="0.05"', 'radius="0.1", length="0.05"'),
    "an attribute twice": ('<link name="lidar">', '<link name="lidar" name="lidar">'),
    "typographic quotes": ('<link name="lidar">', "<link name=\u201clidar\u201d>"),
    "a robot that is not closed": ("</robot>", ""),
    "a < in the text": ("  <!-- Wheels", "  a < 3\n  <!-- Wheels"),
    "text after the robot": ("</robot>", "</robot>\nthe end"),
}  # fmt: skip


@pytest.mark.parametrize("name", BROKEN)
def test_only_the_loading_is_lost(name: str, tmp_path: Path) -> None:
    """If what was meant is evident, all but `urdf-loads` passes, and the report says what was assumed."""
    found = report(replaced(BROKEN[name]), tmp_path)
    assert (found["score"], lost(found)) == (67, {"urdf-loads"})
    codes = {problem["code"] for problem in found["problems"]}
    assert codes - {"URDF001", "URDF002", "URDF006"} == ({"URDF015"} if name != "text after the robot" else set())


@pytest.mark.parametrize("name", BROKEN)
def test_the_second_mistake_is_visible(name: str, tmp_path: Path) -> None:
    """A broken tag does not hide another mistake, wherever it is."""
    text = replaced(BROKEN[name], ('rgba="0 0.6 0 1"', 'rgba="0 1 0 1"'), ("0.2 0 -0.05", "-0.2 0 -0.05"))
    assert lost(report(text, tmp_path)) == {"urdf-loads", "base-green", "caster-placed"}


def test_an_attribute_that_cannot_be_read_is_missing(tmp_path: Path) -> None:
    """What needs the broken value fails; the terminal names the assumption."""
    text = replaced(('<origin xyz="0 0 0.1" rpy="0 0 0"/>', '<origin="0 0 0.1"/>'))
    assert lost(report(text, tmp_path)) == {"urdf-loads", "base-on-ground"}
    shown = " ".join(run(("grade", tmp_path / "my_robot.urdf", "--verbose", "--hints", "none")).stdout.decode().split())
    assert "URDF015 warning line 18: <origin> is read without attributes" in shown
    assert "Not deducted elsewhere" not in shown


def test_a_broken_declaration_ends_at_its_first_bracket(tmp_path: Path) -> None:
    """A declaration without its last ? costs only the loading."""
    found = report(replaced(("?>", ">")), tmp_path)
    assert (found["score"], [problem["code"] for problem in found["problems"]]) == (67, ["URDF004"])


def test_consequences_are_not_reported(tmp_path: Path) -> None:
    """A broken joint leaves its link without one, but two roots are no second problem; `urdf-loads` names the broken tag."""
    text = replaced(
        ('<parent link="base_link"/>\n    <child link="lidar"/>', '<parent="base_link"/>\n    <child link="lidar"/>')
    )
    found = report(text, tmp_path)
    assert [problem["code"] for problem in found["problems"]] == ["URDF001", "URDF015"]
    assert found["results"][0]["message"].startswith("<parent= has no attribute name")
    assert lost(found) == {"urdf-loads", "lidar-fixed", "lidar-frame", "lidar-on-top"}


def test_broken_xacro_is_expanded_around_the_tag(tmp_path: Path) -> None:
    """xacro stops at a broken tag; the rest is expanded and graded."""
    text = replaced(BROKEN["a visual that is not closed"], ('<robot name="my_robot">', '<robot name="my_robot" xmlns:xacro="x">\n<xacro:property name="r" value="0.05"/>'), ('sphere radius="0.05"', 'sphere radius="${r}"'))  # fmt: skip
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(text, encoding="utf-8")
    found = json.loads(run(("grade", path, "--format", "json", "--hints", "none")).stdout)
    assert (found["score"], lost(found)) == (67, {"urdf-loads"})
    assert {problem["code"] for problem in found["problems"]} == {"XACRO001", "URDF015"}


def test_elements_for_simulators_are_graded(tmp_path: Path) -> None:
    """What is written for Gazebo in a file with a broken tag earns its points."""
    sensors = (ROOT / "submissions/sensors/equivalent-plain/sensor_robot/urdf/sensor_robot.urdf.xacro").read_text(
        encoding="utf-8"
    )
    for xacro, plain in (
        ('<xacro:include filename="shapes.xacro"/>', ""),
        ("<xacro:lidar_shape/>", ""),
        ("${length} ${width}", "0.4 0.3"),
    ):
        sensors = sensors.replace(xacro, plain)
    statuses = []
    for text in (sensors, sensors.replace("</visual>", "", 1)):
        path = tmp_path / "sensor_robot.urdf"
        path.write_text(text, encoding="utf-8")
        done = run(("grade", path, "--rubric", "sensors", "--format", "json", "--hints", "none"))
        statuses.append({row["id"]: row["status"] for row in json.loads(done.stdout)["results"]})
    assert {name for name, status in statuses[1].items() if status != statuses[0][name]} == {"urdf-loads"}


@pytest.mark.parametrize("tag", ['property name="r" value="0.05"', 'arg name="r" default="0.05"'])
def test_a_xacro_tag_that_is_not_closed_ends_before_the_next_element(tag: str, tmp_path: Path) -> None:
    """A property or an argument does not swallow the robot after it."""
    value = "${r}" if tag.startswith("property") else "$(arg r)"
    text = replaced(('<robot name="my_robot">', f'<robot name="my_robot" xmlns:xacro="x">\n<xacro:{tag}>'), ('sphere radius="0.05"', f'sphere radius="{value}"'))  # fmt: skip
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(text, encoding="utf-8")
    found = json.loads(run(("grade", path, "--format", "json", "--hints", "none")).stdout)
    assert (found["score"], lost(found)) == (67, {"urdf-loads"})


def test_what_xacro_leaves_open_in_a_broken_file_is_undecided(tmp_path: Path) -> None:
    """A link that the file of another package may define is not missing, also where a tag is broken."""
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(
        '<robot name="r" xmlns:xacro="x"><xacro:include filename="$(find other)/lidar.xacro"/>\n'
        '<link name="base_link"><visual><geometry><box size="0.6 0.4 0.2"/></geometry></link></robot>'
    )
    done = run(("grade", path, "--format", "json", "--hints", "none"))
    status = {row["id"]: row["status"] for row in json.loads(done.stdout)["results"]}
    assert (status["urdf-loads"], status["base-box"], status["lidar-shape"]) == ("failed", "passed", "pending")


_MOST_CALLS = 2_000_000
HOSTILE = {
    "one long name": "<link " + "a" * 1_000_000,
    "many spaces": "<" + " " * 1_000_000,
    "a long value without its last quote": '<link a="' + " " * 1_000_000 + "x",
    "many open tags": "<a>\n<b>\n" * 120_000 + "</robot>",
    "tags in each other": "<a><b>" * 70_000 + "</b></a>" * 70_000 + "<",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_recovery_is_linear_in_the_size_of_the_text(name: str, tmp_path: Path) -> None:
    """A megabyte of one broken tag, or of open ones, does not hang; what stands before it is graded."""
    path = tmp_path / "my_robot.urdf"
    path.write_text(TEXT.replace("</robot>", HOSTILE[name]), encoding="utf-8")
    with limited_work(_MOST_CALLS):
        done = run(("grade", path, "--format", "json"))
    assert (done.returncode, json.loads(done.stdout)["score"]) == (1, 67)


def test_a_path_without_quotes_is_read_whole() -> None:
    """A value without quotes ends at a space or at the end of the tag, not at its first slash."""
    found = Recovery('<robot name="r"><link name="a"/><mesh filename=package://my_robot/caster.stl /></robot>').run()
    assert b'<mesh filename="package://my_robot/caster.stl"/>' in found.recovered


@examples(40)
@given(st.data())
def test_any_damage_is_read_with_its_places(data: st.DataObject) -> None:
    """Whatever is cut out of a URDF or put into it, what is read is XML whose tags are where they are in the text."""
    start = data.draw(st.integers(0, len(TEXT)))
    end = data.draw(st.integers(start, min(len(TEXT), start + 40)))
    inserted = data.draw(
        st.text(alphabet="<>/=\"' abx\n&\u201c", max_size=6)
        | st.sampled_from(("<link>", "</link>", "<!--", "<![CDATA[", "\0"))
    )
    text = TEXT[:start] + inserted + TEXT[end:]
    found = Recovery(text).run()
    if found.recovered:
        elements = list(etree.fromstring(found.recovered).iter(etree.Element))
        assert len(elements) == len(found.offsets)
        assert all(text[offset] == "<" for offset in found.offsets)
        assert found.offsets == sorted(found.offsets)


@pytest.mark.parametrize("name", BROKEN)
def test_a_broken_tag_has_a_proven_hint(name: str, tmp_path: Path) -> None:
    """The edits of the hint, which `--fix` applies, give the points back; another broken tag in the file is found as well."""
    path, fixed = tmp_path / "my_robot.urdf", tmp_path / "fixed.urdf"
    path.write_text(
        replaced(BROKEN[name], ('<child link="left_wheel"/>', '<child link="left_wheel/>')), encoding="utf-8"
    )
    run(("grade", path, "--fix", fixed))
    assert report_of(fixed)["score"] == 70


def test_the_hint_says_the_cause_or_the_edit(tmp_path: Path) -> None:
    """The level `cause` says what is wrong and where, without the edits; all errors of a file are one hint."""
    path = tmp_path / "my_robot.urdf"
    path.write_text(
        replaced(BROKEN["a visual that is not closed"], BROKEN["a quote that is not closed"]), encoding="utf-8"
    )
    cause, edit = (
        " ".join(run(("grade", path, "--hints", level)).stdout.decode().split()) for level in ("cause", "edit")
    )
    assert "Check lines 27 and 32: a quote is missing and a closing tag is missing." in cause
    assert (
        'Change `<link name="lidar>` to `<link name="lidar">` (line 27) and insert `</visual>` (after line 32)' in edit
    )


def test_broken_xacro_has_a_proven_hint(tmp_path: Path) -> None:
    """xacro reads XML strictly: a tag that is not closed, an & and a missing namespace are corrected together."""
    path, fixed = tmp_path / "my_robot.urdf.xacro", tmp_path / "fixed.urdf.xacro"
    text = replaced(
        (
            '<robot name="my_robot">',
            '<robot name="my_robot">\n<xacro:property name="r" value="0.05"/>\n<!-- a -- b -->',
        ),
        ('sphere radius="0.05"', 'sphere radius="${r}"'),
        BROKEN["a visual that is not closed"],
    )
    path.write_text(text, encoding="utf-8")
    run(("grade", path, "--fix", fixed))
    assert report_of(fixed)["score"] == 70


def report_of(path: Path) -> dict[str, Any]:
    """Return the JSON report on a file or folder."""
    return dict(json.loads(run(("grade", path, "--format", "json", "--hints", "none")).stdout))


PACKAGE = {
    "package.xml": [("</license>", "<license>"), ('email="', "email=\u201c"), ("</export>", "")],
    "launch/my_robot_rviz.launch.xml": [("</launch>", ""), ("<node ", "node "), ("</node>", "")],
}


@pytest.mark.parametrize(("path", "change"), [(path, change) for path, those in PACKAGE.items() for change in those])
def test_the_xml_of_a_package_has_a_proven_hint(path: str, change: tuple[str, str], tmp_path: Path) -> None:
    """package.xml and launch files in XML are corrected by the same search, which knows nothing of their format."""
    folder, fixed = tmp_path / "my_robot", tmp_path / "fixed"
    shutil.copytree(ROOT / "submissions/lab6/equivalent-launch-file-in-xml/my_robot", folder)
    text = (folder / path).read_text(encoding="utf-8")
    assert change[0] in text
    (folder / path).write_text(text.replace(*change, 1), encoding="utf-8")
    before = report_of(folder)["score"]
    run(("grade", folder, "--fix", fixed))
    after = (fixed if fixed.is_file() else fixed / path).read_text(encoding="utf-8")
    assert after.split() == text.split()
    (folder / path).write_text(after, encoding="utf-8")
    assert before < report_of(folder)["score"]
