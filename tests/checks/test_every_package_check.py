"""Properties of all checks of a submission: the cases, a grade run, and submissions without a package."""

import sys

import pytest

from grader.checks.check import About, describe
from grader.checks.outcome import Outcome, passed
from grader.errors import InputError
from grader.package.package import Package
from grader.text import was_not_committed
from tests.checks.outcomes import ask, graded, missing
from tests.checks.package_cases import PACKAGE_CASE, PACKAGE_CASES, PackageCase
from tests.checks.submissions import FOLDER, LAUNCH, MANIFEST, REFERENCE, RVIZ, SETUP, URDF, Submitted, png

every_case = pytest.mark.parametrize("case", PACKAGE_CASES, ids=[case.name for case in PACKAGE_CASES])

# Contents that no file of a package should have, and that must not break a check.
ODD = {
    "empty": b"",
    "binary": bytes(range(256)) * 20,
    "nul": b"\0" * 100,
    "utf-16": "import os\n".encode("utf-16"),
    "deep": b"[" * 3000,
    "long line": b"a = " + b"1 + " * 5000 + b"1\n",
    "markup": b"<a><b></a>",
    "exits": b"import sys\nsys.exit()\n",
    "raises": b"raise SystemExit(1)\n",
    "endless": b"while True:\n    pass\n",
}


@every_case
def test_a_grade_run_finds_the_same(case: PackageCase) -> None:
    """A check passes a correct submission and fails an incorrect one, alone and as a criterion of a rubric."""
    for submitted, status in ((case.passing, "passed"), (case.failing, "failed")):
        outcome = ask(case.check, submitted, **case.arguments)
        assert outcome.status == status
        assert graded(case.check, submitted, **case.arguments) == outcome


@every_case
def test_without_a_package_the_same_is_missed(case: PackageCase) -> None:
    """Every check of a package says that there is none, as a criterion and, if possible, alone; a check of xacro needs a URDF."""
    pictures = Submitted({"Task1_Step8.png": png()})
    outcome = graded(case.check, pictures, **case.arguments)
    messages = {
        "package": "the submission has no ROS 2 package: there is no package.xml",
        "URDF": "no URDF was submitted: the only file contains no <robot>",
    }
    assert (outcome.status, outcome.message) == ("failed", messages[case.needs])
    if describe(case.check).subject == "submission":
        error = missing(case.check, pictures, **case.arguments)
        assert (error.kind, error.name) == (case.needs, "")


@every_case
@pytest.mark.parametrize("path", [MANIFEST, SETUP, LAUNCH, RVIZ, URDF])
def test_a_missing_file_breaks_no_check(case: PackageCase, path: str) -> None:
    """Whichever file is missing, a check passes, fails or is pending with its own message."""
    outcome = graded(case.check, REFERENCE.without(path), **case.arguments)
    assert outcome.status in ("passed", "failed", "pending"), outcome


@every_case
@pytest.mark.parametrize("content", ODD.values(), ids=ODD)
def test_odd_files_break_no_check(case: PackageCase, content: bytes) -> None:
    """Whatever the files contain, a check passes, fails or is pending with its own message."""
    for path in (MANIFEST, SETUP, LAUNCH, RVIZ, URDF):
        outcome = graded(case.check, REFERENCE.with_files({path: content}), **case.arguments)
        assert outcome.status in ("passed", "failed", "pending"), (path, outcome)
        if outcome.location is not None:
            assert outcome.location.path in REFERENCE.files


@every_case
def test_the_folder_of_the_package_does_not_matter(case: PackageCase) -> None:
    """A package is graded the same wherever it is in the submission."""
    deeper = f"ws/src/{FOLDER}"
    for submitted in (case.passing, case.failing):
        moved = Submitted(
            {
                deeper + path.removeprefix(FOLDER) if path.startswith(FOLDER + "/") else path: content
                for path, content in submitted.files.items()
            }
        )
        first, second = (ask(case.check, files, **case.arguments) for files in (submitted, moved))
        assert second.status == first.status
        assert second.message == first.message


@every_case
def test_a_check_of_a_package_declares_what_it_looks_at(case: PackageCase) -> None:
    """Hints propose edits of these files, and `rubric test` suggests the check for mutants of them and of its tags."""
    check = describe(case.check)
    files = {name for name in check.about.looks_at if not name.startswith("xacro:")}
    assert check.subject != "package" or files
    assert files <= {"setup.py", "package.xml", "launch", "rviz", "file"}


def test_a_check_of_another_module_may_declare_it(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also one of a plug-in; without a declaration it looks at nothing."""

    def has_driver(package: Package, *, name: str) -> Outcome:
        """The package starts its driver."""
        return passed(f"{package.name} starts {name}")

    assert describe(has_driver).about == About()
    monkeypatch.setattr(sys.modules[__name__], "ABOUT", {"has_driver": About(("launch",))}, raising=False)
    assert describe(has_driver).about.looks_at == ("launch",)
    monkeypatch.setattr(sys.modules[__name__], "ABOUT", {"has_driver": ("launch",)})
    with pytest.raises(InputError, match=r"^ABOUT says of has_driver what is no About\(\.\.\.\)$"):
        describe(has_driver)


_LAUNCHED = "(os.path.join('share', package_name, 'launch'), glob(os.path.join('launch', '*launch.[pxy][yma]*'))),"
_TWICE = _LAUNCHED.replace(", 'launch'), glob(", "), glob(")
_URDF_AT = "os.path.join(share, 'my_robot.urdf')"
_TOPIC = """Description Topic:
        Depth: 5
        Durability Policy: Volatile
        History Policy: Keep Last
        Reliability Policy: Reliable
        Value: /robot_description
"""
_DESCRIPTION = "'robot_description': robot_description"
_PREFIX = f"{_DESCRIPTION}, 'frame_prefix': LaunchConfiguration('prefix')"
_TOO_LARGE = "#" * 600_000
MISTAKES = [  # a check, a text of a file and what is there instead, or the whole file, and what the check says
    ("package_found", SETUP, "['resource/' + package_name]", "['package.xml']",
     "package.xml names the package 'my_robot', but setup.py registers it as 'package.xml'"),
    ("build_installs", SETUP, _LAUNCHED, _LAUNCHED + _TWICE,
     "share/my_robot/launch/my_robot_rviz.launch.py and as share/my_robot/my_robot_rviz.launch.py; ros2 launch needs exactly one"),
    ("launch_starts", LAUNCH, "", _TOO_LARGE, "my_robot_rviz.launch.py is larger than 131072 bytes; needs manual grading"),
    ("launch_finds_files", LAUNCH, "", _TOO_LARGE, "my_robot_rviz.launch.py is larger than 131072 bytes; needs manual grading"),
    ("rviz_fixed_frame", RVIZ, "", _TOO_LARGE, "my_robot.rviz is larger than 524288 bytes; needs manual grading"),
    ("launch_finds_files", LAUNCH, _URDF_AT, "share + 'my_robot.urdf'",
     "the launch file looks for the URDF at share/my_robotmy_robot.urdf: a slash is missing after 'my_robot'"),
    ("launch_finds_files", LAUNCH, _URDF_AT, "share + 'urdf/my_robot.urdf'",
     "the launch file looks for the URDF at share/my_roboturdf/my_robot.urdf: a slash is missing after 'my_robot'"),
    ("launch_finds_files", LAUNCH, _URDF_AT, "share + '/../my_robot2/my_robot.urdf'",
     "the launch file looks in a package 'my_robot2', but the graded package is named 'my_robot'"),
    ("launch_finds_files", LAUNCH, _URDF_AT, "'/my_robot.urdf'",
     "the URDF at /my_robot.urdf: joining a path that begins with / drops the folders before it"),
    ("launch_finds_files", LAUNCH, _URDF_AT, "'/opt/parts.urdf'", "the URDF /opt/parts.urdf is not part of the package; needs manual grading"),
    ("launch_finds_files", LAUNCH, _URDF_AT, "'~/my_robot.urdf'", "~/my_robot.urdf, but nothing replaces ~ by the home folder"),
    ("launch_finds_files", LAUNCH, _URDF_AT, "os.path.join(share, 'robot.urdf')",
     "share/my_robot/robot.urdf, but the package has no file 'robot.urdf'; there is 'my_robot.urdf'"),
    ("launch_finds_files", LAUNCH, _URDF_AT, "os.path.join(share, 'urdf', 'my_robot.urdf')",
     "the URDF at share/my_robot/urdf/my_robot.urdf, but a build installs it as share/my_robot/my_robot.urdf"),
    ("rviz_shows_robot", RVIZ, _TOPIC, "Description Topic: robot_description/\n", "the display 'RobotModel' shows the robot"),
    ("rviz_shows_robot", RVIZ, "Name: RobotModel\n", "Name: ''\n", "the display 'RobotModel' shows the robot"),
    ("rviz_shows_robot", RVIZ, "Name: RobotModel\n", "Name: Base\n", "the display 'Base' shows the robot"),
    ("rviz_shows_robot", RVIZ, _TOPIC, "Alpha: 1\n",
     "the RobotModel display has no Description Topic; it should be '/robot_description'"),
    ("rviz_shows_robot", LAUNCH, _DESCRIPTION, _PREFIX,
     "the frame_prefix of robot_state_publisher is known only at run time; needs manual grading"),
    ("rviz_fixed_frame", LAUNCH, _DESCRIPTION, _PREFIX,
     "the frame_prefix of robot_state_publisher is known only at run time; needs manual grading"),
]  # fmt: skip


@pytest.mark.parametrize(("name", "path", "old", "new", "message"), MISTAKES, ids=[row[4] for row in MISTAKES])
def test_other_mistakes(name: str, path: str, old: str, new: str, message: str) -> None:
    """The message says what is wrong in which file."""
    submitted = REFERENCE.replacing(path, old, new) if old else REFERENCE.with_files({path: new})
    case = PACKAGE_CASE[name]
    arguments = case.arguments if name != "build_installs" else {"kind": "launch", "name": "*.launch.py"}
    assert graded(case.check, submitted, **arguments).message.endswith(message)


@pytest.mark.parametrize(("name", "path"), [("launch_found", LAUNCH), ("rviz_found", RVIZ)])
def test_a_file_that_was_built_is_named(name: str, path: str) -> None:
    """Of a package without the file, and with a build that has it, only the build was submitted."""
    case, file = PACKAGE_CASE[name], path.rpartition("/")[2]
    built = f"install/my_robot/share/my_robot/{file}"
    submitted = REFERENCE.renaming(path, path.replace(file, f"other_{file}")).with_files({built: ""})
    assert graded(case.check, submitted, **case.arguments).message.endswith(was_not_committed(built))
    assert "install" not in graded(case.check, submitted.renaming(built, f"{built}.py"), **case.arguments).message
