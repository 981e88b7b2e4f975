"""Hints that write what the student meant: where it is defined, in the student's own words, and nothing besides."""

import re
from itertools import starmap

import pytest

from grader.lab.grading.grade import grade
from grader.lab.hints.hinting import hinted
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from tests.hints.trials import BASES, hints_for
from tests.samples import LAB6

pytestmark = pytest.mark.slow

REFERENCE = BASES["reference"].text
BOX, LIDAR = 'size="0.6 0.4 0.2"', 'xyz="0.15 0 0.225"'
LEFT, RIGHT = 'xyz="-0.15 0.2 0" rpy="-1.57 0 0"', 'xyz="-0.15 -0.2 0" rpy="-1.57 0 0"'
WHITE_CYLINDER = (
    '<cylinder radius="0.1" length="0.05"/>\n      </geometry>\n      <material name="white"/>'
)
OUTWARD = (
    ('xyz="0 0 0.025"', 'xyz="0 0 0"'),
    ('xyz="0 0 -0.025"', 'xyz="0 0 0"'),
)  # the frames are at the centres

Changes = tuple[tuple[str, str], ...]


def robot(*changes: tuple[str, str], defined: str = "") -> Submission:
    """Return the reference with changes, as xacro where something is defined."""
    text = REFERENCE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    if defined:
        head = '<robot name="my_robot">'
        text = text.replace(
            head, f'{head[:-1]} xmlns:xacro="http://www.ros.org/wiki/xacro">{defined}'
        )
    return read_submission(
        text.encode(), identity="robot", path=f"my_robot.urdf{'.xacro' if defined else ''}"
    )


def properties(**values: str) -> str:
    """Return the definitions of properties."""
    return "".join(starmap('<xacro:property name="{}" value="{}"/>'.format, values.items()))


TURNED: Changes = (
    (BOX, 'size="0.4 0.6 0.2"'),
    (LIDAR, 'xyz="0 0.15 0.225"'),
    (LEFT, 'xyz="-0.2 -0.15 0" rpy="0 -1.57 0"'),
    (RIGHT, 'xyz="0.2 -0.15 0" rpy="0 -1.57 0"'),
    ('xyz="0.2 0 -0.05"', 'xyz="0 0.2 -0.05"'),
)


@pytest.mark.parametrize(
    ("defined", "changes", "expected"),
    [
        pytest.param(
            properties(wheel_x="0.15"),
            (
                *OUTWARD,
                (LEFT, LEFT.replace("-0.15 0.2", "${wheel_x} 0.225")),
                (RIGHT, RIGHT.replace("-0.15 -0.2", "${wheel_x} -0.225")),
            ),
            [('value="0.15"', 'value="-0.15"')],
            id="the sign of a coordinate where it is defined",
        ),
        pytest.param(
            properties(length="${60*0.1}"),
            ((BOX, 'size="${length} 0.4 0.2"'), (LIDAR, 'xyz="${length/4} 0 0.225"')),
            [('value="${60*0.1}"', 'value="0.6"')],
            id="a definition that is computed from numbers",
        ),
        pytest.param(
            properties(r="0.1", t="0.05"),
            (
                (WHITE_CYLINDER, WHITE_CYLINDER.replace("0.1", "${t}").replace("0.05", "${r}")),
                ('xyz="0 0 0.1"', 'xyz="0 0 ${r}"'),
            ),
            [('radius="${t}"', 'radius="${r}"'), ('length="${r}"', 'length="${t}"')],
            id="the names of two values that are exchanged",
        ),
        pytest.param(
            properties(base="0.4", track="0.3")
            + '<xacro:macro name="at" params="side"><origin xyz="${-base/2} ${side*track/2} 0" rpy="-1.57 0 0"/></xacro:macro>',
            (
                (f"<origin {LEFT}/>", '<xacro:at side="1"/>'),
                (f"<origin {RIGHT}/>", '<xacro:at side="-1"/>'),
            ),
            [('value="0.4"', 'value="0.3"'), ('value="0.3"', 'value="0.4"')],
            id="two definitions that are exchanged",
        ),
        pytest.param(
            '<xacro:macro name="turn" params="type"><xacro:if value="${type == \'continous\'}"><axis xyz="0 0 1"/></xacro:if></xacro:macro>',
            (('<axis xyz="0 0 1"/>', '<xacro:turn type="continuous"/>'),),
            [("value=\"${type == 'continous'}\"", "value=\"${type == 'continuous'}\"")],
            id="the type of a joint in a condition",
        ),
        pytest.param(
            '<xacro:macro name="paint" params="name:=gray"><material name="${name}"/></xacro:macro>',
            (
                ('<material name="gray"/>', "<xacro:paint/>"),
                ('<material name="white"/>', "<xacro:paint/>"),
            ),
            [("<xacro:paint", '<xacro:paint name="white"')],
            id="a parameter that a call of a macro does not give",
        ),
        pytest.param(
            "",
            (('<material name="gray">', '<material name="Gray">'),),
            [('name="Gray"', 'name="gray"')],
            id="the name of a material where it is defined",
        ),
        pytest.param(
            "",
            (
                (LEFT, LEFT.replace("0.2", "0.25")),
                (RIGHT, RIGHT.replace("-0.2", "-0.25")),
                ('xyz="0 0 -0.025"', 'xyz="0 0 0.025"'),
            ),
            [('xyz="0 0 0.025"', 'xyz="0 0 -0.025"')],
            id="the side that is built unlike the other one, not a turn that drives backward",
        ),
        pytest.param(
            "",
            (('<material name="white"/>', "<material name=‘white’/>"),),
            [("<material name=‘white’/>", '<material name="white"/>')],
            id="single quotes of a word processor",
        ),
        pytest.param(
            "",
            (
                (RIGHT, RIGHT.replace("-1.57", "1.57")),
                ('xyz="0 0 -0.025"', 'xyz="0 0 0.025"'),
                ('xyz="0 0 1"', 'xyz="0 0 0.5"'),
            ),
            [('xyz="0 0 0.025"', 'xyz="0 0 -0.025"'), ('rpy="1.57 0 0"', 'rpy="-1.57 0 0"')],
            id="a mirrored wheel whose axis is of another length",
        ),
    ],
)
def test_what_is_meant_is_written(
    defined: str, changes: Changes, expected: list[tuple[str, str]]
) -> None:
    """One hint corrects everything, and changes no more than the mistake."""
    hints = hints_for(robot(*changes, defined=defined))
    assert hints.is_full
    assert [[(edit.old, edit.new) for edit in found.edits] for found in hints.found] == [expected]
    assert [found.certainty for found in hints.found] == ["preferred"]


def test_an_end_tag_is_replaced_in_its_place() -> None:
    """A wrong end tag becomes the right one, without another line."""
    text = re.sub(r"(<child link=\"lidar\"/>.*?)</joint>", r"\1</link>", REFERENCE, flags=re.DOTALL)
    (found,) = hints_for(
        read_submission(text.encode(), identity="robot", path="my_robot.urdf")
    ).found
    assert [(edit.old, edit.new) for edit in found.edits] == [("</link>", "</joint>")]


def test_one_decision_is_not_corrected_in_part() -> None:
    """Where the frames of the whole robot are turned, the caster alone is not moved."""
    submission = robot(*TURNED)
    report = grade(LAB6, submission)
    assert {"lidar-frame", "caster-placed"} <= report.by_convention
    assert not hinted(report, submission, "edit").edits


@pytest.mark.parametrize("sign", ["1", "-1"])
def test_a_side_is_not_halved(sign: str) -> None:
    """A factor of 1 or -1 says the side: no hint makes it 0.5 or 2."""
    call = f'<xacro:at side="{sign}"/>'
    defined = '<xacro:macro name="at" params="side"><origin xyz="-0.15 ${side*0.4} 0" rpy="-1.57 0 0"/></xacro:macro>'
    hints = hints_for(robot((f"<origin {LEFT if sign == '1' else RIGHT}/>", call), defined=defined))
    assert all("side" not in edit.new for found in hints.found for edit in found.edits)


def test_an_edit_gains_nothing_by_a_word_that_is_undone() -> None:
    """Of two mistakes, one is a word that is read as another one once the other is corrected: each gains its own."""
    left = '<joint name="base_left_wheel_joint" type="continuous">'
    hints = hints_for(
        robot(
            (left, left.replace("continuous", "revolute")),
            ('<link name="right_wheel">', '<link name="rigth_wheel">'),
        )
    )
    gains = {found.edits[0].new: set(found.gains) for found in hints.found}
    assert 'name="right_wheel"' in gains
    assert not any(name.startswith("right") for name in gains['type="continuous"'])


def test_nothing_is_missing_where_xacro_refuses_something() -> None:
    """The joint is written in the macro that is called with an unknown parameter, so no words ask for it."""
    defined = '<xacro:macro name="hold" params="link *at"><joint name="base_${link}_joint" type="fixed"><parent link="base_link"/>'
    defined += '<child link="${link}"/><xacro:insert_block name="at"/></joint></xacro:macro>'
    joint = re.search(r'<joint name="base_lidar_joint".*?</joint>', REFERENCE, re.DOTALL)
    assert joint is not None
    call = '<xacro:hold link="lidar" number="7"><origin xyz="0.15 0 0.225"/></xacro:hold>'
    submission = robot((joint[0], call), defined=defined)
    results = hinted(grade(LAB6, submission), submission, "edit").report.results
    assert any(result.is_lost for result in results)
    assert not [
        result.hint
        for result in results
        if result.hint is not None and result.hint.message.startswith("Add")
    ]
