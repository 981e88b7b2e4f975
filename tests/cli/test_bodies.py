"""Masses, inertias, collisions and meshes on the command line: a package in xacro, with and without mistakes."""

import json
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import run

RUBRIC = """\
id = "bodies"
title = "Bodies"
package = "my_arm"
urdf = "urdf/my_arm.urdf.xacro"
points = 4

[[part]]
id = "urdf"
title = "The robot"
points = 4

[defaults]
part = "urdf"
points = 1

[[criterion]]
id = "mass"
title = "The upper arm has 2 kg"
check = "mass_is"
with = { link = "@tip", mass = 2, tolerance = 0.001 }

[[criterion]]
id = "inertia"
title = "The upper arm has the inertia of its shape"
check = "inertia_plausible"
with = { link = "@tip", tolerance = 5 }

[[criterion]]
id = "collision"
title = "The upper arm collides where it is shown"
check = "collision_matches_visual"
with = { link = "@tip", tolerance = 0.002 }

[[criterion]]
id = "mesh"
title = "The base shows its mesh"
check = "shows_mesh"
with = { link = "base", file = "meshes/base.stl", scale = [0.001, 0.001, 0.001], xyz = [0, 0, 0.1], relative_to = "base" }
"""
XACRO = """\
<robot name="my_arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="length" value="0.6"/>
  <xacro:macro name="rod" params="mass">
    <origin xyz="0 0 ${length/2}"/>
    <geometry><cylinder radius="0.05" length="${length}"/></geometry>
  </xacro:macro>
  <link name="base">
    <visual>
      <origin xyz="0 0 0.1"/>
      <geometry><mesh filename="file://$(find my_arm)/meshes/base.stl" scale="0.001 0.001 0.001"/></geometry>
    </visual>
  </link>
  <link name="arm">
    <inertial>
      <origin xyz="0 0 ${length/2}"/>
      <mass value="2"/>
      <inertia ixx="${2*(3*0.05**2 + length**2)/12}" ixy="0" ixz="0" iyy="${2*(3*0.05**2 + length**2)/12}" iyz="0" izz="0.0025"/>
    </inertial>
    <visual><xacro:rod mass="2"/></visual>
    <collision><xacro:rod mass="2"/></collision>
  </link>
  <joint name="shoulder" type="continuous"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/></joint>
</robot>
"""
MANIFEST = """\
<package format="3"><name>my_arm</name><version>0.0.0</version><description>An arm.</description>
<maintainer email="ash@example.org">Ash</maintainer><license>MIT</license>
<export><build_type>ament_cmake</build_type></export></package>
"""
CMAKE = """\
cmake_minimum_required(VERSION 3.8)
project(my_arm)
find_package(ament_cmake REQUIRED)
install(DIRECTORY urdf meshes DESTINATION share/${PROJECT_NAME})
ament_package()
"""


def graded(folder: Path, xacro: str = XACRO, cmake: str = CMAKE) -> dict[str, Any]:
    """Grade a package, and return the results by the ids of their criteria."""
    package = folder / "my_arm"
    for path, text in {
        "package.xml": MANIFEST,
        "CMakeLists.txt": cmake,
        "urdf/my_arm.urdf.xacro": xacro,
        "meshes/base.stl": "solid",
    }.items():
        (package / path).parent.mkdir(parents=True, exist_ok=True)
        (package / path).write_text(text, encoding="utf-8")
    (folder / "bodies.toml").write_text(RUBRIC, encoding="utf-8")
    done = run(("grade", package, "--rubric", folder / "bodies.toml", "--format", "json"))
    results = json.loads(done.stdout)["results"]
    assert done.returncode == (0 if all(result["status"] == "passed" for result in results) else 1), done.stderr
    return {result["id"]: result for result in results}


def test_a_correct_package(tmp_path: Path) -> None:
    """All criteria pass; links are named by their place."""
    assert {name: result["status"] for name, result in graded(tmp_path).items()} == dict.fromkeys(
        ("mass", "inertia", "collision", "mesh"), "passed"
    )


@pytest.mark.parametrize(
    ("old", "new", "lost", "told", "line"),
    [
        ('<mass value="2"/>', '<mass value="2000"/>', ("mass", "inertia"), "is it in grams?", 16),
        ('izz="0.0025"', 'izz="0.005"', (), "", 0),  # 0.0025 of the largest moment, 0.06125
        ("/12}", "/3}", ("inertia",), "it would fit if it were about the origin of the link", 17),
        ('<collision><xacro:rod mass="2"/></collision>', "", ("collision",), "has no collision shape with a size", 13),
        ("<collision><xacro:rod", "<collision><origin/><xacro:rod", ("inertia", "collision"), "(300 mm off)", 15),
        ("meshes/base.stl", "meshes/Base.stl", ("mesh",), "upper and lower case differ", 10),
        ("file://$(find my_arm)", "file:///home/ash/my_arm", ("mesh",), "exists on one machine only", 10),
        ("0.001 0.001 0.001", "1 1 1", ("mesh",), "its scale is 1 1 1; it should be 0.001 0.001 0.001", 10),
    ],
)
def test_mistakes(tmp_path: Path, old: str, new: str, lost: tuple[str, ...], told: str, line: int) -> None:
    """A mistake costs its criteria, with what is wrong and where."""
    assert old in XACRO
    results = graded(tmp_path, XACRO.replace(old, new))
    assert tuple(name for name, result in results.items() if result["status"] == "failed") == lost
    for name in lost[:1]:
        assert told in results[name]["message"]
        assert results[name]["location"]["line"] == line


@pytest.mark.parametrize(
    ("old", "new", "status"),
    [
        ('<mass value="2"/>', '<mass value="$(env MASS)"/>', {"mass": "pending", "inertia": "pending"}),
        (
            'name="length" value="0.6"',
            'name="length" value="$(env LENGTH)"',
            {"inertia": "pending", "collision": "pending"},
        ),
        ("$(find my_arm)", "$(env HERE)", {"mesh": "pending"}),
        ("$(find my_arm)", "$(find your_arm)", {"mesh": "pending"}),
        (
            '<collision><xacro:rod mass="2"/></collision>',
            "<xacro:include filename='$(env MORE)'/>",
            {"collision": "pending"},
        ),
    ],
)
def test_what_xacro_leaves_open(tmp_path: Path, old: str, new: str, status: dict[str, str]) -> None:
    """It needs manual grading; the other criteria are decided."""
    results = graded(tmp_path, XACRO.replace(old, new))
    found = {name: result["status"] for name, result in results.items() if result["status"] != "passed"}
    assert status.items() <= found.items()
    assert set(found.values()) == {"pending"}


def test_a_mesh_that_is_not_installed(tmp_path: Path) -> None:
    """The usual omission: the folder of the meshes is missing in CMakeLists.txt."""
    message = graded(tmp_path, cmake=CMAKE.replace(" meshes ", " "))["mesh"]["message"]
    assert "is not installed: add meshes/base.stl to install(DIRECTORY ...) in CMakeLists.txt" in message


# --- Hints ------------------------------------------------------------------------------------------------------------

RIGHT = """\
<robot name="my_arm">
  <link name="arm">
    <inertial>
      <origin xyz="0 0 0.3"/>
      <mass value="2"/>
      <inertia ixx="0.06125" ixy="0" ixz="0" iyy="0.06125" iyz="0" izz="0.0025"/>
    </inertial>
    <visual>
      <origin xyz="0 0 0.3"/>
      <geometry><cylinder radius="0.05" length="0.6"/></geometry>
      <material name="red"><color rgba="1 0 0 1"/></material>
    </visual>
    <collision>
      <origin xyz="0 0 0.3"/>
      <geometry><cylinder radius="0.05" length="0.6"/></geometry>
    </collision>
  </link>
</robot>
"""
INERTIAL = RIGHT[RIGHT.index("    <inertial>") : RIGHT.index("    <visual>")]
COLLISION = RIGHT[RIGHT.index("    <collision>") : RIGHT.index("  </link>")]


@pytest.mark.parametrize(
    ("old", "new", "cause"),
    [
        ('<mass value="2"/>', '<mass value="2000"/>', "the mass of the link 'arm'"),
        ('ixx="0.06125"', 'ixx="0.6125"', "the decimal point of the ixx of the inertial inertia of 'arm'"),
        (
            '<origin xyz="0 0 0.3"/>\n      <mass',
            "<mass",
            "the centre of mass of the link 'arm'",
        ),
        (
            '<origin xyz="0 0 0.3"/>\n      <mass value="2"/>\n      <inertia ixx="0.06125"',
            '<mass value="2"/>\n      <inertia ixx="0.24"',
            "inertia and centre of mass of the link 'arm'",
        ),
        (INERTIAL, "", "the <inertial> of the link 'arm' is missing"),
        (COLLISION, "", "the <collision> of the link 'arm' is missing"),
        (
            COLLISION,
            COLLISION.replace("0 0 0.3", "0 0 0"),
            "the collision origin of the link 'arm'",
        ),
        (
            COLLISION,
            COLLISION.replace("0.05", "0.5"),
            "the collision geometry of the link 'arm'",
        ),
        (
            COLLISION,
            COLLISION.replace("0.05", "0.5").replace("0 0 0.3", "0 0 0"),
            "the collision of the link 'arm'",
        ),
        (
            COLLISION,
            COLLISION + "    <collision><geometry><sphere radius='1'/></geometry></collision>\n",
            "a collision of the link 'arm' that is not shown",
        ),
    ],
)
def test_hints(tmp_path: Path, old: str, new: str, cause: str) -> None:
    """Without a reference, the edit that makes the link right is found and proven; applied, it gives full marks."""
    assert RIGHT.count(old) == 1
    rubric, robot, fixed = tmp_path / "bodies.toml", tmp_path / "my_arm.urdf", tmp_path / "fixed.urdf"
    text = (
        RUBRIC.replace("@tip", "arm")
        .replace("points = 4", "points = 3")
        .replace("[[part]]", 'hints = "edit"\n[[part]]')
    )
    rubric.write_text(text[: text.rindex("[[criterion]]")], encoding="utf-8")
    robot.write_text(RIGHT.replace(old, new), encoding="utf-8")
    options = ("--rubric", rubric, "--hints", "edit", "--format", "json")
    run(("grade", robot, *options, "--fix", fixed))
    assert json.loads(run(("grade", fixed, *options)).stdout)["score"] == 3
    done = run(("grade", robot, "--rubric", rubric, "--hints", "cause", "--format", "json"))
    hints = [hint for result in json.loads(done.stdout)["results"] for hint in result["hints"]]
    assert all(hint["verified"] and hint["message"].endswith(f": {cause}.") for hint in hints)
    assert hints
