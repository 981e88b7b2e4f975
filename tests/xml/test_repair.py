"""A broken tag costs the criteria that need it, and `urdf-loads`: the elements before and after it are graded as they stand."""

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from grader.base.element_edits import edited
from grader.base.source import Source
from grader.ros.xml.repair import repair
from grader.ros.xml.tinyxml2 import scan
from tests.command_line import ROOT, run
from tests.examples import examples
from tests.work import limited_work

pytestmark = pytest.mark.slow

TEXT = (ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf").read_text(encoding="utf-8")


_MOST_CALLS = 6_000_000
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
    found = repair(
        '<robot name="r"><link name="a"/><mesh filename=package://my_robot/caster.stl /></robot>'
    )
    assert b'<mesh filename="package://my_robot/caster.stl"/>' in found.xml


def test_a_call_of_a_macro_without_elements_is_closed_where_it_begins() -> None:
    """A macro of another file takes no element if another call has none."""
    found = repair(
        '<robot name="r" xmlns:xacro="x"><xacro:arm side="left"/><xacro:arm side="right">'
        '<link name="a"/></robot>'
    )
    assert b'side="right"/><link name="a"/>' in found.xml


@examples(40)
@given(st.data())
def test_any_damage_is_read_with_its_places(data: st.DataObject) -> None:
    """Whatever is cut out of a URDF or put into it, what is read is XML whose tags are where they are in the text.

    It is what is read of the edited text, if the edits repair all of it.
    """
    start = data.draw(st.integers(0, len(TEXT)))
    end = data.draw(st.integers(start, min(len(TEXT), start + 40)))
    inserted = data.draw(
        st.text(alphabet="<>/=\"' abx\n&\u201c", max_size=6)
        | st.sampled_from(("<link>", "</link>", "<!--", "<![CDATA[", "\0"))
    )
    text = TEXT[:start] + inserted + TEXT[end:]
    found = repair(text)
    if found.xml:
        elements = list(etree.fromstring(found.xml).iter(etree.Element))
        assert len(elements) == len(found.offsets)
        assert all(text[offset] == "<" for offset in found.offsets)
        assert found.offsets == sorted(found.offsets)
    source = Source("a.urdf", text)
    after = edited(text, "a.urdf", [source.edit(*change) for change in found.changes])
    assert after is not None
    fixed = scan(after)
    if found.xml and scan(text).is_refused and not fixed.is_refused:
        assert fixed.xml == found.xml
