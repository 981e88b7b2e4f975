"""Whole submissions under the rubric of lab 6: lost criteria, skipped criteria and problems for each defect."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from decimal import Decimal

import pytest

from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.report import Report
from grader.grading.rubric import load_rubric
from grader.submission.opening import read_submission
from tests.checks.submissions import (
    ANSWERS,
    FOLDER,
    LAUNCH,
    MANIFEST,
    REFERENCE,
    RVIZ,
    SETUP,
    URDF,
    WEBCAM,
    Submitted,
    png,
)

LAB = load_rubric("lab6")
PENDING = ("evidence-webcam", "answer-floating-link", "answer-launch-nodes")
PICTURES = Submitted({"Task1_Step8.png": png(), WEBCAM: png()})
JOINED = "os.path.join(share, 'my_robot.urdf')"
OF_PACKAGE = " ".join(criterion.id for criterion in LAB.criteria if criterion.part == "task2")
OF_URDF = " ".join(criterion.id for criterion in LAB.criteria if criterion.part == "task1")
RVIZ_ENTRY = "        (os.path.join('share', package_name), glob('rviz/*')),\n"
CMAKE = (
    REFERENCE.replacing(MANIFEST, "ament_python", "ament_cmake")
    .without(SETUP)
    .with_files({"my_robot/CMakeLists.txt": "install(DIRECTORY urdf DESTINATION share/my_robot)\n"})
)


def setup(old: str, new: str) -> Submitted:
    """Return the reference with another text in setup.py."""
    return REFERENCE.replacing(SETUP, old, new)


def launch(old: str, new: str) -> Submitted:
    """Return the reference with another text in its launch file."""
    return REFERENCE.replacing(LAUNCH, old, new)


def manifest(old: str, new: str) -> Submitted:
    """Return the reference with another text in package.xml."""
    return REFERENCE.replacing(MANIFEST, old, new)


NOT_INSTALLED = "setup-installs-urdf setup-installs-launch setup-installs-rviz"
NO_LAUNCH = "launch-found setup-installs-launch launch-nodes launch-finds-files"
NO_RVIZ = "rviz-found setup-installs-rviz launch-finds-files rviz-fixed-frame rviz-shows-robot"
# Changes of the reference: the submission, the lost criteria, with the failed one first and those that are carried in
# parentheses, and the criteria that are pending as well.
DEFECTS: Mapping[str, tuple[Submitted, str, str]] = {
    "nothing": (REFERENCE, "", ""),
    "no answers and no pictures": (REFERENCE.without(ANSWERS, WEBCAM, "Task1_Step8.png"), "", ""),
    "another folder": (REFERENCE.renaming("my_robot", "ws/src/lab6"), "", ""),
    "another RViz file": (
        REFERENCE.renaming(RVIZ, "my_robot/rviz/view.rviz").replacing(LAUNCH, "'my_robot.rviz'", "'view.rviz'"), "", "",
    ),
    "no launch folder": (REFERENCE.without("my_robot/launch"), NO_LAUNCH, ""),
    "launch file misspelt": (REFERENCE.renaming(LAUNCH, "my_robot/launch/my_robot_rvix.launch.py"), "launch-found", ""),
    "import os missing in setup.py": (setup("import os\n", ""), "setup-imports", ""),
    "import missing in the launch file": (launch("from launch_ros.actions import Node\n", ""), "launch-nodes", ""),
    "syntax error in the launch file": (launch("    ])\n", ""), "launch-nodes launch-finds-files", ""),
    "nothing is returned": (launch("    return ", "    "), "launch-nodes launch-finds-files", ""),
    "package.xml named otherwise": (manifest(">my_robot<", ">robot<"), "package-found", ""),
    "package.xml without build type": (manifest("<build_type>ament_python</build_type>", ""), "package-type", ""),
    "package.xml missing": (REFERENCE.without(MANIFEST), "package-found package-type", ""),
    "package.xml broken": (manifest("</name>", "</nam>"), "package-found package-type", ""),
    "setup.py missing": (REFERENCE.without(SETUP), f"{NOT_INSTALLED} setup-imports (launch-finds-files)", ""),
    "syntax error in setup.py": (
        setup("zip_safe=True,", "zip_safe=True"), f"{NOT_INSTALLED} setup-imports (launch-finds-files)", "",
    ),
    "setup() is not called": (REFERENCE.with_files({SETUP: ""}), f"{NOT_INSTALLED} (launch-finds-files)", ""),
    "the marker is missing": (REFERENCE.without("my_robot/resource"), "setup-installs-urdf", ""),
    "no entry for RViz": (setup(RVIZ_ENTRY, ""), "setup-installs-rviz (launch-finds-files)", ""),
    "glob finds a folder": (REFERENCE.with_files({"my_robot/urdf/meshes/a.stl": "solid"}), "setup-installs-urdf", ""),
    "path of one machine": (launch(JOINED, "'/home/me/my_robot.urdf'"), "launch-finds-files", ""),
    "other folder": (launch("share, 'my_robot.u", "share, 'urdf', 'my_robot.u"), "launch-finds-files", ""),
    "no RViz file": (REFERENCE.without(RVIZ), NO_RVIZ, ""),
    "RViz file broken": (REFERENCE.with_files({RVIZ: "a: [b\n"}), "rviz-fixed-frame rviz-shows-robot", ""),
    "another fixed frame": (REFERENCE.replacing(RVIZ, "Frame: base_footprint", "Frame: map"), "rviz-fixed-frame", ""),
    "URDF outside": (REFERENCE.renaming(URDF, "my_robot.urdf"), "setup-installs-urdf launch-finds-files", ""),
    "a package of CMake": (CMAKE, "package-type", f"{NOT_INSTALLED} setup-imports launch-finds-files"),
    "a keyword twice": (
        setup("zip_safe=True,", "zip_safe=True, " * 2), f"{NOT_INSTALLED} setup-imports (launch-finds-files)", "",
    ),
    "a name from another module": (launch("from launch_ros.actions", "from launch.actions"), "launch-nodes", ""),
    "an open file for its text": (launch("file.read()", f"open({JOINED})"), "launch-finds-files", ""),
    "a default that is no text": (launch("default_value='true'", "default_value=True"), "launch-nodes", ""),
    "a default by place": (launch("'gui', default_value='true'", "'gui', 'true'"), "launch-nodes", ""),
    "a condition that is no text": (launch("IfCondition(gui)", "IfCondition(True)"), "launch-nodes", ""),
    "the launch file installed twice": (
        setup(RVIZ_ENTRY, RVIZ_ENTRY + RVIZ_ENTRY.replace("rviz/*", "launch/*.py")), "setup-installs-launch", "",
    ),
    "compiled files in the way": (
        setup("os.path.join('launch', '*launch.[pxy][yma]*')", "'launch/*'").with_files(
            {f"{FOLDER}/launch/__pycache__/a": ""}
        ),
        "setup-installs-launch", "",
    ),
    "a slash that is missing": (launch(JOINED, "share + 'my_robot.urdf'"), "launch-finds-files", ""),
    "a slash that is too many": (launch("share, 'my_robot.urdf'", "share, '/my_robot.urdf'"), "launch-finds-files", ""),
    "a large launch file": (REFERENCE.with_files({LAUNCH: "#" * 200_000}), "", "launch-nodes launch-finds-files"),
    "a large RViz file": (REFERENCE.with_files({RVIZ: "#" * 600_000}), "", "rviz-fixed-frame rviz-shows-robot"),
    "a large setup.py": (
        REFERENCE.with_files({SETUP: "#" * 200_000}), "", f"{NOT_INSTALLED} setup-imports launch-finds-files",
    ),
    "a large URDF": (REFERENCE.with_files({URDF: " " * 1_100_000}), "", OF_URDF),
    "a closed archive": (Submitted({"lab6.rar": b"Rar!", "Task1_Step8.png": png()}), "", f"{OF_URDF} {OF_PACKAGE}"),
    "nothing but pictures": (PICTURES, "", f"urdf-loads package-found {OF_URDF} {OF_PACKAGE}"),
    "nothing but the URDF and pictures": (
        PICTURES.with_files({"my_robot.urdf": REFERENCE.files[URDF]}), "", f"package-found {OF_PACKAGE}",
    ),
}  # fmt: skip

# Defects of setup.py, because of which the files that the launch file names are not where it looks for them.


def graded(submitted: Submitted, parts: Sequence[str] = ()) -> Report:
    """Return the report on a submission."""
    return grade(LAB, submitted.submission, parts)


def with_status(report: Report, *statuses: str) -> set[str]:
    """Return the criteria with one of these statuses."""
    return {result.criterion.id for result in report.results if result.outcome.status in statuses}


def points(*criteria: str) -> Decimal:
    """Return the points of some criteria."""
    return sum((criterion.points for criterion in LAB.criteria if criterion.id in criteria), Decimal(0))


@pytest.mark.parametrize("name", DEFECTS)
def test_a_defect_loses_the_expected_criteria(name: str) -> None:
    """Exactly the criteria about the defect fail, once: consequences are skipped and name the criterion that failed."""
    submitted, words, more = DEFECTS[name]
    lost, pending = re.findall(r"[\w-]+", words), {*PENDING, *more.split()}
    carried = set(re.findall(r"\(([\w-]+)\)", words))
    report = graded(submitted)
    assert with_status(report, "failed", "skipped") == set(lost)
    assert with_status(report, "pending") == pending
    assert with_status(report, "errored") == set()
    assert (report.max_score, report.pending) == (Decimal(100), points(*pending))
    assert {result.criterion.id for result in report.results if result.carried} == carried
    assert report.score == 100 - points(*{*lost} - carried, *PENDING, *more.split())
    most = 2 if {"urdf-loads", "package-found"} <= set(lost) else 1
    failed = with_status(report, "failed") - carried
    assert failed == set(lost[:most])
    for result in report.results:
        if result.outcome.status == "skipped":
            assert result.because in failed
            assert result.outcome.message == f"skipped because {result.because} failed"


def test_two_defects_are_both_reported() -> None:
    """One defect never hides another one."""
    three = (
        setup("import os\n", "")
        .replacing(RVIZ, "Fixed Frame: base_footprint", "Fixed Frame: map")
        .replacing(LAUNCH, JOINED, "'/home/me/my_robot.urdf'")
    )
    assert with_status(graded(three), "failed") == {"setup-imports", "rviz-fixed-frame", "launch-finds-files"}


_COMMA = "Python cannot read setup.py: invalid syntax. Perhaps you forgot a comma?"
_TAG = "package.xml is not readable as XML: Opening and ending tag mismatch: name line 4 and nam"
_PATTERN = "the pattern 'launch/*launch.[pxy][yma]*' in setup.py matches no file, because there is no folder 'launch'"
_ROS_1 = "rviz/RobotModel is a class of ROS 1; in ROS 2 it is rviz_default_plugins/RobotModel"
_MARKER = "data_files lists 'resource/my_robot', but there is no such file"
_RETURN = "generate_launch_description does not return its LaunchDescription"
_MACHINE = "the path /home/me/my_robot.urdf exists on one machine only"
_NO_RVIZ = "there is no 'Visualization Manager': this is not an RViz file"
_NAMES = "package.xml names the package 'robot', setup.py names it 'my_robot'"


@pytest.mark.parametrize(
    ("submitted", "code", "path", "message"),
    [
        (manifest("</name>", "</nam>"), "PKG001", MANIFEST, _TAG),
        (manifest("Apache-2.0", "TODO"), "PKG003", MANIFEST, "<license> of package.xml is still TODO"),
        (manifest(">my_robot<", ">robot<"), "PKG005", SETUP, _NAMES),
        (setup("zip_safe=True,", "zip_safe=True"), "PKG010", SETUP, _COMMA),
        (setup("import os\n", ""), "PKG011", SETUP, "the name 'os' is not defined or imported"),
        (REFERENCE.without("my_robot/resource"), "PKG012", SETUP, _MARKER),
        (REFERENCE.without("my_robot/launch"), "PKG013", SETUP, _PATTERN),
        (launch("    return ", "    "), "LCH002", LAUNCH, _RETURN),
        (launch(JOINED, "'/home/me/my_robot.urdf'"), "LCH003", LAUNCH, _MACHINE),
        (REFERENCE.with_files({RVIZ: "hello\n"}), "RVZ001", RVIZ, _NO_RVIZ),
        (REFERENCE.replacing(RVIZ, "rviz_default_plugins/RobotModel", "rviz/RobotModel"), "RVZ002", RVIZ, _ROS_1),
    ],
    ids=lambda value: value if isinstance(value, str) and value[:3] in ("PKG", "LCH", "RVZ") else "",
)  # fmt: skip
def test_problems_of_the_packages_files_are_listed(submitted: Submitted, code: str, path: str, message: str) -> None:
    """Each problem of a file of the package is listed once, with its code and location."""
    (problem,) = graded(submitted).problems
    assert (problem.code, problem.location.path, problem.message) == (code, path, message)
    assert graded(submitted, ["task1"]).problems == ()


def test_evidence_is_shown_with_its_criterion() -> None:
    """Pictures that the lab asks for are listed with their criterion, others on their own."""
    report = graded(REFERENCE.with_files({"holiday.png": png()}))
    shown = [(found.evidence.id, [file.path for file in found.files]) for found in report.evidence]
    steps = ("Task1_Step8", "Task1_Step18", "Task1_Step36", "Task2_Step6", "Task3_Step3")
    assert sorted(shown) == sorted((step.lower().replace("_", "-"), [f"{step}.png"]) for step in steps)
    assert [file.path for file in report.other_pictures] == ["holiday.png"]


@pytest.mark.parametrize("part", ["task2", "task3", "questions"])
def test_a_single_urdf_has_no_package(part: str) -> None:
    """Selecting a part that needs more than a URDF is wrong usage."""
    single = read_submission(REFERENCE.data(URDF), identity="one", path="my_robot.urdf")
    message = f"{part} needs more than a URDF: give the folder or archive that was submitted"
    with pytest.raises(InputError, match=message):
        grade(LAB, single, [part])
    with pytest.raises(InputError, match=message):
        grade(LAB, single, ["task1", part])


def test_parts_of_a_submission_may_be_chosen() -> None:
    """A submission is graded on the named parts only."""
    report = graded(PICTURES, ["task3"])
    assert (report.parts, report.max_score, report.pending) == (("task3",), Decimal(2), Decimal(2))
    assert (report.problems, report.notes) == ((), ())


def test_notes_and_problems_of_both_are_listed() -> None:
    """Those of the URDF come before those of the package; a URDF beside the package and one that costs much are noted."""
    two = REFERENCE.replacing(URDF, 'xyz="0 0 1"', 'xyz="0 0 2"').replacing(MANIFEST, "Apache-2.0", "TODO")
    assert [problem.code for problem in graded(two).problems] == ["URDF074", "URDF074", "PKG003"]
    large = (
        REFERENCE.data(URDF).decode().replace("0 0.6 0 1", "0 1 0 1").replace("</robot>", " " * 300_000 + "</robot>")
    )
    costly = REFERENCE.without(URDF).with_files({"robot.urdf": large})
    notes = (
        "the graded URDF is outside the graded package",
        "no hints were searched, because reading this robot takes too much work",
    )
    assert graded(costly).notes == notes
    assert grade(replace(LAB, hints="none"), costly.submission).notes == notes[:1]
    top = Submitted({path.removeprefix("my_robot/"): text for path, text in REFERENCE.files.items()})
    assert graded(top).notes == ()
