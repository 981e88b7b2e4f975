"""The mesh of a link: the end of its path, where ROS 2 finds it, its scale and its pose."""

from typing import Any

import pytest

from grader.checks.meshes import shows_mesh
from grader.checks.outcome import Outcome, Status
from grader.robot.kinematics import Configuration
from grader.submission.opening import read_submission
from tests.checks.outcomes import Arguments, ask, fails, graded, missing, passes
from tests.checks.robots import Numbers, Scene, box, joint, link, mesh, scene, turned, visual
from tests.checks.submissions import MANIFEST, REFERENCE, SETUP, URDF, Submitted

HULL: Arguments = {"link": "arm", "file": "meshes/hull.stl"}
PATH = "package://my_robot/meshes/hull.stl"
MESH_FILE = "my_robot/meshes/hull.stl"
INSTALLS = "(os.path.join('share', package_name, 'meshes'), glob('meshes/*')),\n"


def arm(filename: str = PATH, *, scale: Numbers = "", xyz: Numbers = "", rpy: Numbers = "") -> Scene:
    """Return a link that shows a mesh."""
    return scene(link("arm", visual(mesh(filename, scale), xyz=xyz, rpy=rpy)))


def package(filename: str = PATH, *, held: str = MESH_FILE, installs: str = INSTALLS) -> Submitted:
    """Return a package with a mesh and the entry of setup.py that installs it, whose URDF names a mesh."""
    files = REFERENCE.with_files({URDF: arm(filename).text, held: b"solid"})
    return files.replacing(SETUP, "    data_files=[\n", "    data_files=[\n        " + installs)


def finding(submitted: Submitted, **arguments: Any) -> tuple[Status, str]:
    """Return the status and the message of the check for a submission."""
    outcome = graded(shows_mesh, submitted, **{**HULL, **arguments})
    return outcome.status, outcome.message


# --- The name of the file ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize("file", ["hull.stl", "meshes/hull.stl", "my_robot/meshes/hull.stl", PATH, "/meshes//hull.stl"])
def test_the_end_of_the_path(file: str) -> None:
    """Whole folders and the name are compared from the end, down to the package."""
    assert passes(shows_mesh, arm(), link="arm", file=file) == f"'arm' shows the mesh '{PATH}'"
    assert passes(shows_mesh, arm("package://my_robot/a/..//meshes/./hull.stl"), link="arm", file=file)


@pytest.mark.parametrize(
    ("file", "more"),
    [(file, "") for file in ("ull.stl", "eshes/hull.stl", "other/meshes/hull.stl", "hull.dae", "meshes", "hull")]
    + [(file, "; upper and lower case differ") for file in ("Hull.stl", "meshes/hull.STL", "Meshes/hull.stl")],
)
def test_another_file_fails(file: str, more: str) -> None:
    """A part of a name is no name, and Linux tells upper from lower case; the message says if only this differs."""
    message = fails(shows_mesh, arm(), at="filename=", link="arm", file=file)
    assert message == f"'arm' shows the mesh '{PATH}'; its path should end in '{file}'{more}"


def test_any_visual_may_be_the_mesh() -> None:
    """A link may show several meshes and other shapes; one in its place is enough."""
    others = (visual(box(1.0, 1.0, 1.0)), visual(mesh("package://a/b.stl")), visual(mesh(PATH), xyz="0 0 9"))
    body = scene(link("arm", *others, visual(mesh(PATH), xyz="0 0 1")))
    assert ask(shows_mesh, body, **HULL, xyz=(0.0, 0.0, 1.0)).status == "passed"
    assert ask(shows_mesh, body, **HULL, xyz=(0.0, 0.0, 2.0)).status == "failed"


def test_no_mesh() -> None:
    """A link that shows something else misses its mesh."""
    other = scene(link("arm", visual(box(1.0, 1.0, 1.0))))
    assert missing(shows_mesh, other, **HULL).kind == "mesh"
    assert fails(shows_mesh, other, at="<box", **HULL) == "'arm' shows a box; it should show a mesh"
    assert missing(shows_mesh, scene(link("arm")), **HULL).kind == "visual"


# --- Paths that ROS 2 does not find -----------------------------------------------------------------------------------


ABSOLUTE = "is at an absolute path, which exists on one machine only; use package://"
FILE = "is at a file:// path, which exists on one machine only; use package://"
STARTS = [
    ("/home/ash/ws/src/my_robot/", ABSOLUTE),
    ("~/ws/", ABSOLUTE),
    ("C:/ws/", ABSOLUTE),
    ("C:\\ws\\", ABSOLUTE),
    ("file:///home/ash/ws/", FILE),
    ("file://my_robot/", FILE),
    ("file:/home/ash/", FILE),
    ("file:///install/my_robot/share/my_robot/", FILE),
    ("package:/my_robot/", "begins with package:; use package://"),
    ("Package://my_robot/", "begins with Package://; use package://"),
    ("package://my_robot\\", "has a \\ in its path; separate folders by /"),
]


@pytest.mark.parametrize(("start", "told"), STARTS)
def test_paths_of_one_machine_fail(start: str, told: str) -> None:
    """Whether or not a package was submitted; the message says what to use."""
    name = f"{start}meshes/hull.stl"
    for of in (arm(name), package(name)):
        outcome = graded(shows_mesh, of, **HULL)
        assert (outcome.status, outcome.mistake) == ("failed", f"the mesh of 'arm' {told}")
        assert outcome.message == f"the mesh of 'arm' {told} (mesh {name!r})"


@pytest.mark.parametrize(
    ("name", "alone", "told"),
    [
        ("meshes/hull.stl", "passed", "RViz finds no relative path; other programs may"),
        ("../meshes/hull.stl", "passed", "RViz finds no relative path; other programs may"),
        ("https://example.org/meshes/hull.stl", "pending", "it is on the web, which the grader does not read"),
        ("model://my_robot/meshes/hull.stl", "pending", "it is at a model:// path, which not every program finds"),
    ],
)
def test_paths_that_only_some_programs_find(name: str, alone: str, told: str) -> None:
    """They need manual grading, and the message says what they are; a relative path passes for a URDF on its own."""
    outcome = graded(shows_mesh, arm(name), **HULL)
    assert (outcome.status, told in outcome.message) == (alone, alone == "pending")
    status, message = finding(package(name))
    assert (status, told in message) == ("pending", True)


# --- The files of a package -------------------------------------------------------------------------------------------


def test_a_mesh_that_is_installed() -> None:
    """The source holds it and a build installs it, from any folder of the source."""
    assert finding(package()) == ("passed", f"'arm' shows the mesh '{PATH}'")
    moved = package(held="my_robot/description/hull.stl", installs=INSTALLS.replace("'meshes/*'", "'description/*'"))
    assert finding(moved)[0] == "passed"


OUTSIDE = [
    (package(installs=""),
     "is not installed: add meshes/hull.stl to data_files in setup.py, for share/my_robot/meshes"),
    (package(installs=INSTALLS.replace(", 'meshes')", ")")),
     "is looked for at share/my_robot/meshes/hull.stl, but a build installs it as share/my_robot/hull.stl"),
    (package(held="my_robot/meshes/Hull.stl"), "is not in the package 'my_robot'; there is 'Hull.stl'"),
    (package(held="my_robot/meshes/hulls.stl"), "is not in the package 'my_robot'; there is 'hulls.stl'"),
    (package(held="meshes/hull.stl"), "is not in the package 'my_robot'"),
    (package("package://my_robt/meshes/hull.stl"), "names the package 'my_robt'; the submission has 'my_robot'"),
    (package("package://something/meshes/hull.stl"), "names the package 'something'; the submission has 'my_robot'"),
    (package("package://arm_description/other/meshes/hull.stl"),
     "names the package 'arm_description', which is not part of the submission"),
    (package("package://my_robot/../meshes/hull.stl"), "is outside of its package"),
    (package().without(SETUP), "is not installed: its package has no setup.py"),
    (package().with_files({SETUP: "from setuptools import setup\nsetup(\n"}),
     "is not installed: Python cannot read setup.py"),
]  # fmt: skip


@pytest.mark.parametrize(("submitted", "told"), OUTSIDE)
def test_a_mesh_that_a_build_does_not_install(submitted: Submitted, told: str) -> None:
    """The message says what is missing, or where the file is."""
    status, message = finding(submitted)
    assert status == "failed"
    assert message.startswith(f"the mesh of 'arm' {told} (mesh 'package://")


@pytest.mark.parametrize(
    ("submitted", "told"),
    [
        (package(installs="*entries(),\n"), "cannot determine statically what setup.py installs"),
        (package().with_files({SETUP: "#" * 200_000}), "setup.py cannot be read ("),
        (
            package("package://elsewhere/meshes/hull.stl").with_files({"all.rar": b"Rar!"}),
            "the package 'elsewhere' may be in an archive that could not be opened",
        ),
        (
            REFERENCE.with_files({URDF: arm().text, "meshes.rar": b"Rar!"}),
            "hull.stl may be in an archive that could not be opened",
        ),
    ],
)
def test_what_cannot_be_determined(submitted: Submitted, told: str) -> None:
    """It needs manual grading, with the reason; but a wrong scale fails."""
    status, message = finding(submitted, file="hull.stl")
    assert status == "pending"
    assert told in message
    assert finding(submitted, file="hull.stl", scale=(2.0, 2.0, 2.0))[0] == "failed"


@pytest.mark.parametrize(
    ("commands", "status"),
    [
        ("install(DIRECTORY urdf meshes DESTINATION share/${PROJECT_NAME})", "passed"),
        ("install(DIRECTORY urdf DESTINATION share/${PROJECT_NAME})", "failed"),
        ("install(DIRECTORY meshes/ DESTINATION share/${PROJECT_NAME})", "failed"),
        ("include(install.cmake)", "pending"),
    ],
)
def test_a_package_of_cmake(commands: str, status: str) -> None:
    """Plain commands of CMake are followed; what others install needs manual grading."""
    cmake = {"my_robot/CMakeLists.txt": f"project(my_robot)\n{commands}\nament_package()\n"}
    submitted = package().without(SETUP).replacing(MANIFEST, "ament_python", "ament_cmake").with_files(cmake)
    assert finding(submitted)[0] == status


def test_without_a_package_nothing_is_looked_for() -> None:
    """A URDF alone, or in a folder without a package, names a package that may exist."""
    assert ask(shows_mesh, arm(), **HULL).status == "passed"
    assert finding(Submitted({"robot.urdf": arm().text}))[0] == "passed"


def test_find_of_xacro_in_a_single_file() -> None:
    """Without a package, `$(find my_robot)` names a package that may exist, as package:// does."""
    text = arm("file://$(find my_robot)/meshes/hull.stl").text
    lone = Submitted({"arm.urdf.xacro": text.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')})
    alone = read_submission(lone.data("arm.urdf.xacro"), identity="ash", path="arm.urdf.xacro")
    for submission in (alone, lone.submission):
        robot = submission.needed_urdf().robot
        assert robot is not None
        assert shows_mesh(Configuration(robot), submission, link="arm", file="meshes/hull.stl").status == "passed"


def expanded(filename: str) -> Outcome:
    """Return the outcome for a package whose xacro names a mesh."""
    text = arm(filename).text.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    submitted = package().without(URDF).with_files({f"{URDF}.xacro": text})
    return graded(shows_mesh, submitted, **HULL)


def test_find_of_xacro() -> None:
    """`file://$(find my_robot)` works on every machine; without file:// RViz finds nothing."""
    for name in ("file://$(find my_robot)/meshes/", "file:///$(find my_robot)/meshes/", "package://my_robot/meshes/",
                 "file://$(find my_robot)/meshes/hulls/../"):  # fmt: skip
        assert expanded(f"{name}hull.stl").status == "passed", name
    bare = expanded("$(find my_robot)/meshes/hull.stl")
    assert (bare.status, bare.mistake) == ("failed", "the mesh of 'arm' needs file:// before $(find ...)")
    absent = expanded("file://$(find my_robot)/mesh/hull.stl")
    message = "'arm' shows the mesh 'file://$(find my_robot)/mesh/hull.stl'; its path should end in 'meshes/hull.stl'"
    assert (absent.status, absent.message) == ("failed", message)
    assert expanded("file://$(find somebody)/meshes/hull.stl").status == "pending"


# --- Scale and pose ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("given", "fine"),
    [
        ("0.001 0.001 0.001", True),
        ("1e-3 1e-3 0.001001", True),
        ("0.001 0.001 0.00101", False),
        ("0.001 0.001 -0.001", False),
        ("0.01 0.01 0.01", False),
        ("", False),
    ],
)
def test_the_scale(given: str, fine: bool) -> None:
    """The tolerance is a share of the scale: 0.001 is not 0.01, although these are less than 0.002 apart."""
    outcome = ask(shows_mesh, arm(scale=given), **HULL, scale=(0.001, 0.001, 0.001))
    assert (outcome.status == "passed") == fine
    if given == "":
        assert outcome.message.startswith("its scale is 1 1 1; it should be 0.001 0.001 0.001")


@pytest.mark.parametrize(("degrees", "status"), [(0.9, "passed"), (-0.9, "passed"), (1.1, "failed"), (180, "failed")])
def test_the_orientation(degrees: float, status: str) -> None:
    """It may be off by 1 degree; numbers of rpy that mean the same orientation are the same."""
    assert ask(shows_mesh, arm(rpy=turned(yaw=degrees)), **HULL, rpy=(0.0, 0.0, 0.0)).status == status
    same = turned(roll=180, pitch=180, yaw=180 + degrees)
    assert ask(shows_mesh, arm(rpy=same), **HULL, rpy=(0.0, 0.0, 0.0)).status == status
    assert ask(shows_mesh, arm(rpy=same), **HULL).status == "passed"


def test_the_frame_of_another_link() -> None:
    """With `relative_to`, it does not matter how joints and visuals share the pose."""
    wanted: Arguments = {**HULL, "relative_to": "base", "xyz": (1.0, 2.0, 0.0), "rpy": (0.0, 0.0, 0.0)}
    for of_joint, of_visual, status in (
        ("1 2 0", "0 0 0", "passed"),
        ("1 0 0", "0 2 0", "passed"),
        ("1 2 0", "0 2 0", "failed"),
    ):
        shown = link("arm", visual(mesh(PATH), xyz=of_visual))
        robot = scene(link("base"), shown, joint("j", "fixed", "base", "arm", xyz=of_joint))
        assert ask(shows_mesh, robot, **wanted).status == status
    assert missing(shows_mesh, robot, **{**wanted, "relative_to": "nowhere"}).name == "nowhere"


def test_everything_that_is_wrong_is_told() -> None:
    """One message lists the path, the scale and the pose."""
    body = arm("/home/ash/meshes/hull.stl", scale="2 2 2", xyz="0 0 1", rpy=turned(yaw=90))
    wanted = {"scale": (1.0, 1.0, 1.0), "xyz": (0.0, 0.0, 0.0), "rpy": (0.0, 0.0, 0.0)}
    assert fails(shows_mesh, body, at="filename=", **HULL, **wanted) == (
        "the mesh of 'arm' is at an absolute path, which exists on one machine only; use package://;"
        " its scale is 2 2 2; it should be 1 1 1;"
        " the mesh of 'arm' is at 0 0 1 m in 'arm'; it should be at 0 0 0 m (z 1000 mm too large);"
        " its orientation is 90 degrees off (mesh '/home/ash/meshes/hull.stl')"
    )
