"""Arguments of checks that a rubric gives, and those for which it is refused."""

from pathlib import Path

import pytest

from tests.checks.cases import CASE, IN_XACRO
from tests.checks.submissions import URDF
from tests.command_line import run

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
title = "C"
points = 1
check = "{}"
with = {{ {} }}
"""
SENSOR = "at = \"gazebo[@reference='@tip']/sensor\", values = "
CONTENT = "must be a table of strings, numbers, booleans or lists of these, not"
CODES = "problems of without_problems must be codes or rules of problems"
HEIGHT = (
    '<link name="base_link"/><xacro:property name="height" value="1"/><link name="l${height}"/>'
)
MAIN = f"{URDF}.xacro"


@pytest.mark.parametrize(
    ("check", "arguments", "code", "message"),
    [
        (
            "entry_is",
            SENSOR + '{ "@type" = "camera", update_rate = 30, "camera/image/width" = [640] }',
            0,
            "",
        ),
        ("entry_is", SENSOR + '{ "@type" = "lidar" }', 1, ""),
        ("entry_is", SENSOR + "{ update_rate = { a = 1 } }", 2, CONTENT),
        ("entry_is", SENSOR + "{ update_rate = [[1]] }", 2, CONTENT),
        ("entry_is", SENSOR + "{ update_rate = [] }", 2, CONTENT),
        ("entry_is", SENSOR + "5", 2, CONTENT),
        ("entry_is", 'at = "gazebo[@reference"', 2, "at of entry_is must be a path such as"),
        ("counts", "links = -1", 2, "links"),
        ("counts", "links = 2.0", 2, "links"),
        ("counts", 'links = "2"', 2, "links"),
        ("without_problems", 'problems = ["URDF074"]', 0, ""),
        ("without_problems", 'problems = ["URDF074", "URDF999"]', 2, CODES),
        ("without_problems", 'problems = ["PKG001"]', 1, ""),
        ("xacro_uses", "properties = -1", 2, "properties"),
        ("xacro_uses", "macros = [1]", 2, "macros"),
    ],
)
def test_a_rubric_is_refused_in_one_line(
    tmp_path: Path, check: str, arguments: str, code: int, message: str
) -> None:
    """Names of links may be selectors; a value of another type or range is a mistake of the rubric."""
    (tmp_path / "rubric.toml").write_text(RUBRIC.format(check, arguments))
    (tmp_path / "robot.urdf").write_text(CASE["entry_is"].passing.text)
    done = run(("grade", tmp_path / "robot.urdf", "--rubric", tmp_path / "rubric.toml"))
    assert (done.returncode, done.stderr.count(b"\n")) == (code, int(code == 2)), done
    assert message.encode() in done.stderr


@pytest.mark.parametrize(("name", "code"), [("width", 1), ("height", 0)])
def test_a_lone_xacro_file_is_its_own_source(tmp_path: Path, name: str, code: int) -> None:
    """What a file that is not there may use needs manual grading."""
    file = tmp_path / "my_robot.urdf.xacro"
    file.write_text(IN_XACRO.data(MAIN).decode().replace('<link name="base_link"/>', HEIGHT))
    (tmp_path / "rubric.toml").write_text(
        RUBRIC.format("xacro_uses", f'file = "other.xacro", properties = ["{name}"]')
    )
    done = run(("grade", file, "--rubric", tmp_path / "rubric.toml"))
    assert (done.returncode, b"needs manual grading" in done.stdout) == (code, name == "width")
