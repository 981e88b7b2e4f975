"""The check of the xacro that a robot is written in."""

from pathlib import Path
from typing import Any

import pytest

from grader.checks.outcome import Outcome
from grader.checks.xacro_source import xacro_uses
from grader.errors import NotDecided
from tests.checks.outcomes import graded
from tests.checks.package_cases import IN_XACRO
from tests.checks.submissions import REFERENCE, URDF, Submitted
from tests.command_line import run

MAIN, WHEEL = f"{URDF}.xacro", "my_robot/urdf/wheel.xacro"
ROBOT = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">\n<link name="base"/>\n{}\n</robot>\n'


def found(inside: str, files: dict[str, str] | None = None, **arguments: Any) -> Outcome:
    """Return the outcome for xacro with this content, and perhaps other files in its folder."""
    submitted = REFERENCE.without(URDF).with_files({MAIN: ROBOT.format(inside)})
    others = {f"my_robot/urdf/{name}": ROBOT.format(text) for name, text in (files or {}).items()}
    return graded(xacro_uses, submitted.with_files(others), **arguments)


def replaced(old: str, new: str, **arguments: Any) -> Outcome:
    """Return the outcome for the sample with another text in one of its files."""
    path = MAIN if old in str(IN_XACRO.files[MAIN]) else WHEEL
    return graded(xacro_uses, IN_XACRO.replacing(path, old, new), **arguments)


PROPERTY = '<xacro:property name="a" value="1"/>\n'
MACRO = '<xacro:macro name="m" params="{}"><link name="{}"/></xacro:macro>\n'


# --- Properties -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "inside",
    [
        '<link name="l${a}"/>',
        '<link name="${2 * ( a+1 )}"/>',
        "<gazebo><x>${a}</x></gazebo>",
        '<xacro:property name="b" value="${a}"/>',
        '<xacro:if value="${a == 2}"><link name="l"/></xacro:if>',
        MACRO.format("x:=${a}", "${x}"),
        MACRO.format("a:=^", "${a}"),
        MACRO.format("x", "${x}_${a}"),
        MACRO.format("a", "${a}") + '<xacro:m a="${a}"/>',
    ],
)
def test_a_property_is_used_in_any_expression(inside: str) -> None:
    """It counts in attributes, texts, conditions, defaults and bodies of macros, also of macros that are not called."""
    assert found(PROPERTY + inside, properties=["a"]).status == "passed"
    assert found(PROPERTY + inside, properties=1).status == "passed"


@pytest.mark.parametrize(
    "inside",
    [
        '<link name="a"/>',
        '<link name="$${a}"/>',
        "<link name=\"${'a'}\"/>",
        "<!-- ${a} -->",
        MACRO.format("a", "${a}") + '<xacro:m a="5"/>',
        '<xacro:property name="d" value="${dict(a=1)}"/>\n<link name="${d.a}"/>',
        '<xacro:property name="d" value="${dict(ab=1)}"/>',
        '<xacro:property name="a" value="${a}"/>',
    ],
)
def test_what_is_no_use_of_a_property(inside: str) -> None:
    """An escape, a string, a comment, a parameter or a key of the same name is no use, nor is its own definition."""
    outcome = found(PROPERTY + inside, properties=["a"])
    assert (outcome.status, outcome.message) == ("failed", "the property 'a' is defined, but never used")
    assert outcome.location is not None
    assert (outcome.location.path, outcome.location.line) == (MAIN, 3)


def test_blocks_and_namespaces() -> None:
    """A property that holds elements is used where it is inserted, one of an included namespace by its dotted name."""
    block = '<xacro:property name="a"><link name="x"/></xacro:property>\n'
    assert found(f'{block}<xacro:insert_block name="a"/>', properties=["a"]).status == "passed"
    assert found(block, properties=["a"]).status == "failed"
    inside = '<xacro:include filename="o.xacro" ns="o"/><link name="l${o.a}"/><xacro:o.m/>'
    others = {"o.xacro": PROPERTY + MACRO.format("", "n")}
    assert found(inside, others, properties=["a"], macros=["m"]).status == "passed"


# --- Macros and includes ----------------------------------------------------------------------------------------------


def test_macros_are_called() -> None:
    """By their tag or by xacro:call, and in other macros; a definition alone is not enough."""
    macro = MACRO.format("", "x")
    assert found(f"{macro}<xacro:m/>", macros=["m"]).status == "passed"
    assert found(f'{macro}<xacro:call macro="m"/>', macros=1).status == "passed"
    outcome = found(macro, macros=["m"])
    assert (outcome.status, outcome.message) == ("failed", "the macro 'm' is defined, but never called")
    outcome = found(macro, macros=1)
    assert outcome.message == "0 macros defined and used; there should be 1; not used: 'm'"
    assert outcome.location is not None
    assert outcome.location.line == 3
    assert found(f"{macro}<xacro:m/>", macros=["n"]).message == "the macro 'n' is not defined"
    assert graded(xacro_uses, IN_XACRO, macros=["wheels"]).message.endswith("did you mean 'wheel'?")


def test_long_lists_are_cut() -> None:
    """Of names of properties and files five are shown."""
    names = [f"n{number}" for number in range(7)]
    texts = "".join(
        f'<xacro:property name="{name}" value="1"/><xacro:include filename="{name}.xacro"/>' for name in names
    )
    files = {f"{name}.xacro": "" for name in names}
    unused, missing = found(texts, files, properties=7), found(texts, files, includes=[f"x{name}" for name in names])
    for outcome, count in ((unused, 1), (missing, 2), (found(texts, files, includes=7), 1)):
        assert outcome.message.count(" more") == count
    plain = REFERENCE.with_files({f"my_robot/urdf/{name}": ROBOT.format("") for name in files})
    assert graded(xacro_uses, plain, includes=1).message.count(" more") == 1
    both = found(MACRO.format("", "x"), macros=["m"], properties=["a"], includes=["a.xacro"])
    assert both.message.count("; ") == 3
    assert found(PROPERTY, includes=["/wheel.xacro/"]).message.endswith("included: none")


def test_includes() -> None:
    """Files are named by the ends of their paths, or counted once each; those that are not there do not count."""
    for includes in (1, ["wheel.xacro"], ["urdf/wheel.xacro"], ["my_robot/urdf/wheel.xacro"]):
        assert graded(xacro_uses, IN_XACRO, includes=includes).status == "passed"
    for includes, message in (
        (2, "1 file included; there should be 2"),
        (["heel.xacro"], "no file 'heel.xacro' is included; included: wheel.xacro"),
        (["a.xacro", "b.xacro"], "no file 'a.xacro' and no file 'b.xacro' is included; included: wheel.xacro"),
    ):
        outcome = graded(xacro_uses, IN_XACRO, includes=includes)
        assert (outcome.status, outcome.message) == ("failed", message)
    assert replaced("wheel.xacro", "heel.xacro", includes=1).message == "0 files included; there should be 1"
    pattern = found('<xacro:include filename="*.inc"/>', {"a.inc": "", "b.inc": ""}, includes=2)
    assert pattern.status == "pending"


def test_one_file_is_meant() -> None:
    """With `file` only its definitions and includes count, wherever they are used."""
    assert graded(xacro_uses, IN_XACRO, file="wheel.xacro", macros=["wheel"]).status == "passed"
    assert graded(xacro_uses, IN_XACRO, file="wheel.xacro", properties=1).status == "failed"
    assert graded(xacro_uses, IN_XACRO, file="my_robot.urdf.xacro", properties=2, includes=1).status == "passed"
    assert graded(xacro_uses, IN_XACRO, file="my_robot.urdf.xacro", macros=1).status == "failed"
    outcome = graded(xacro_uses, IN_XACRO, file="arm.xacro")
    assert (outcome.status, outcome.message) == ("failed", "the submission has no file 'arm.xacro'")
    beside = IN_XACRO.with_files({URDF: REFERENCE.files[URDF]})  # the robot that xacro makes of it
    assert graded(xacro_uses, beside, file="my_robot.urdf.xacro", properties=["radius"]).status == "passed"


# --- What is no xacro, and what is not known --------------------------------------------------------------------------


def test_a_plain_urdf_fails() -> None:
    """Neither a comment nor a namespace makes a URDF xacro."""
    plain = ROBOT.format("<!-- xacro: ${a} <xacro:macro/> -->")
    for submitted in (
        REFERENCE,
        REFERENCE.with_files({URDF: plain}),
        REFERENCE.without(URDF).with_files({MAIN: plain}),
    ):
        for arguments in ({}, {"properties": 1}):
            outcome = graded(xacro_uses, submitted, **arguments)
            assert outcome.status in ("failed", "pending")
            if submitted.files.get(MAIN) is None:
                message = "the URDF is not written in xacro: it has no expression and no tag of xacro"
                assert (outcome.status, outcome.message) == ("failed", message)
                assert outcome.location is not None


def test_xacro_beside_a_plain_urdf_is_pending() -> None:
    """If the graded URDF is plain, a person decides whether xacro beside it is its source."""
    outcome = graded(
        xacro_uses, REFERENCE.with_files({"my_robot/urdf/other.xacro": ROBOT.format(PROPERTY)}), properties=1
    )
    assert outcome.status == "pending"
    assert "my_robot.urdf, which is no xacro, but there is my_robot/urdf/other.xacro" in outcome.message


def test_without_arguments_xacro_is_expanded() -> None:
    """xacro in a .urdf, which ROS 2 gets as it stands, fails; its content is examined all the same."""
    assert graded(xacro_uses, IN_XACRO).status == "passed"
    raw = Submitted({"robot.urdf": ROBOT.format(PROPERTY + '<link name="l${a}"/>')})
    outcome = graded(xacro_uses, raw)
    assert outcome.status == "failed"
    assert "which ROS 2 does not evaluate in a .urdf" in outcome.message
    assert graded(xacro_uses, raw, properties=["a"]).status == "passed"


@pytest.mark.parametrize(
    ("inside", "status"),
    [
        ('<xacro:include filename="$(find elsewhere)/a.xacro"/>', "pending"),
        ('<xacro:if value="$(env ON)"><xacro:include filename="o.xacro"/></xacro:if>', "pending"),
        ('<xacro:property name="${\'a\'}" value="1"/>', "pending"),
        ('<link name="$(env NAME)"/>', "failed"),
        ('<xacro:include filename="none.xacro"/>', "failed"),
    ],
)
def test_what_cannot_be_determined_is_pending(inside: str, status: str) -> None:
    """A file of another package, or a name that is evaluated, may be what is looked for; other values may not."""
    assert found(inside, properties=["zzz"]).status == status
    assert found(PROPERTY + '<link name="l${a}"/>' + inside, properties=["a"]).status == "passed"


def test_broken_xacro() -> None:
    """What can be read around a broken tag counts; a file in which no link can be read fails with xacro's own message."""
    broken = REFERENCE.without(URDF).with_files({MAIN: ROBOT.format(PROPERTY + "<link name='${a}'>")})
    assert graded(xacro_uses, broken, properties=["a"]).status == "passed"
    assert graded(xacro_uses, broken, properties=2).status == "failed"
    outcome = graded(xacro_uses, REFERENCE.without(URDF).with_files({MAIN: "<robot>${x}<robot"}), properties=1)
    assert outcome.status == "failed"
    assert "xacro needs well-formed XML" in outcome.message


@pytest.mark.parametrize(
    ("files", "status", "message"),
    [
        ({"a/parts.xacro": "<robot/>", "b/parts.xacro": "<robot/>"}, "pending", "several files are called parts.xacro"),
        ({"a/parts.xacro": "<robot>" + " " * 1_100_000}, "pending", "larger than"),
        (
            {"a/parts.xacro": '<robot name="r"><link name="a"/></robot>'},
            "failed",
            "has no expression and no tag of xacro",
        ),
        ({"a/parts.xacro": '<!DOCTYPE r [<!ENTITY e "a">]>\n<robot>${1}</robot>'}, "pending", "entities of a DOCTYPE"),
    ],
    ids=["several", "large", "plain", "entities"],
)
def test_another_file_of_the_submission(files: dict[str, str], status: str, message: str) -> None:
    """A file that the URDF does not include is examined on its own, if it is the only one of its name and can be read."""
    outcome = graded(xacro_uses, REFERENCE.with_files(files), file="parts.xacro", properties=["a"])
    assert (outcome.status, message in outcome.message) == (status, True), outcome.message


def test_a_submission_that_used_up_its_work() -> None:
    """What is too much work to look through needs manual grading."""
    submission = IN_XACRO.with_files({}).submission  # its own: that of the sample is shared
    submission.needed_urdf()
    submission.budget.left = 0
    with pytest.raises(NotDecided, match="more work than one submission may use"):
        xacro_uses(submission, macros=1)


# --- The command line -------------------------------------------------------------------------------------------------

HEIGHT = '<link name="base_link"/><xacro:property name="height" value="1"/><link name="l${height}"/>'
RUBRIC = """\
id = "r"
title = "R"
urdf = "my_robot.urdf.xacro"
[[part]]
id = "a"
title = "A"
[[criterion]]
id = "c"
part = "a"
title = "xacro"
points = 1
check = "xacro_uses"
with = {}
"""


@pytest.mark.parametrize(
    ("arguments", "code"),
    [
        ('{ properties = ["radius"], macros = 1, includes = ["wheel.xacro"] }', 0),
        ('{ file = "other.xacro", properties = ["width"] }', 1),  # the file that uses it is not there
        ('{ file = "other.xacro", properties = ["height"] }', 0),  # a lone file is its own source
        ("{ properties = 4 }", 1),
        ("{ properties = -1 }", 2),
        ("{ macros = [1] }", 2),
    ],
)
def test_a_rubric(tmp_path: Path, arguments: str, code: int) -> None:
    """The arguments are numbers or lists of names; a folder and a lone file are graded."""
    (tmp_path / "rubric.toml").write_text(RUBRIC.format(arguments))
    folder = tmp_path / "lab"
    for path in (MAIN,) if "file" in arguments else (MAIN, WHEEL):
        file = folder / Path(path).name
        file.parent.mkdir(exist_ok=True)
        file.write_text(str(IN_XACRO.files[path]).replace('<link name="base_link"/>', HEIGHT))
    place = folder / "my_robot.urdf.xacro" if "file" in arguments else folder
    done = run(("grade", place, "--rubric", tmp_path / "rubric.toml"))
    assert done.returncode == code, done
    assert (b"needs manual grading" in done.stdout) == ("width" in arguments)
