"""Whole submissions under the rubric of lab 6: lost criteria, skipped criteria and problems for each defect."""

from collections.abc import Mapping, Sequence
from decimal import Decimal

import pytest

from grader.errors import InputError
from grader.grading.grade import grade
from grader.grading.report import Report
from grader.grading.rubric import load_rubric
from grader.submission.opening import read_submission
from tests.checks.submissions import ANSWERS, LAUNCH, MANIFEST, REFERENCE, RVIZ, SETUP, URDF, WEBCAM, Submitted, png

LAB = load_rubric("lab6")
PENDING = ("evidence-webcam", "answer-floating-link", "answer-launch-nodes")
PICTURES = Submitted({"Task1_Step8.png": png(), WEBCAM: png()})
INSTALLS = ("setup-installs-urdf", "setup-installs-launch", "setup-installs-rviz")
OF_PACKAGE = tuple(criterion.id for criterion in LAB.criteria if criterion.part == "task2")
OF_URDF = tuple(criterion.id for criterion in LAB.criteria if criterion.part == "task1")
RVIZ_ENTRY = "        (os.path.join('share', package_name), glob('rviz/*')),\n"
CMAKE = (
    REFERENCE.replacing(MANIFEST, "ament_python", "ament_cmake")
    .without(SETUP)
    .with_files({"my_robot/CMakeLists.txt": "install(DIRECTORY urdf DESTINATION share/my_robot)\n"})
)

# Changes of the reference: the submission, the lost criteria with the failed one first, and additional pending criteria.
DEFECTS: Mapping[str, tuple[Submitted, Sequence[str], Sequence[str]]] = {
    "nothing": (REFERENCE, (), ()),
    "no answers and no pictures": (REFERENCE.without(ANSWERS, WEBCAM, "Task1_Step8.png"), (), ()),
    "another folder": (REFERENCE.renaming("my_robot", "ws/src/lab6"), (), ()),
    "another RViz file that is opened": (
        REFERENCE.renaming(RVIZ, "my_robot/rviz/view.rviz").replacing(LAUNCH, "'my_robot.rviz'", "'view.rviz'"),
        (),
        (),
    ),
    "no launch folder": (
        REFERENCE.without("my_robot/launch"),
        ("launch-found", "setup-installs-launch", "launch-nodes", "launch-finds-files"),
        (),
    ),
    "launch file misspelt": (
        REFERENCE.renaming(LAUNCH, "my_robot/launch/my_robot_rvix.launch.py"),
        ("launch-found",),
        (),
    ),
    "import os missing in setup.py": (REFERENCE.replacing(SETUP, "import os\n", ""), ("setup-imports",), ()),
    "import glob missing in setup.py": (
        REFERENCE.replacing(SETUP, "from glob import glob\n", ""),
        ("setup-imports",),
        (),
    ),
    "import missing in the launch file": (
        REFERENCE.replacing(LAUNCH, "from launch_ros.actions import Node\n", ""),
        ("launch-nodes",),
        (),
    ),
    "syntax error in the launch file": (
        REFERENCE.replacing(LAUNCH, "    ])\n", ""),
        ("launch-nodes", "launch-finds-files"),
        (),
    ),
    "nothing is returned": (
        REFERENCE.replacing(LAUNCH, "    return ", "    "),
        ("launch-nodes", "launch-finds-files"),
        (),
    ),
    "package.xml named otherwise": (REFERENCE.replacing(MANIFEST, ">my_robot<", ">robot<"), ("package-found",), ()),
    "package.xml without build type": (
        REFERENCE.replacing(MANIFEST, "<build_type>ament_python</build_type>", ""),
        ("package-type",),
        (),
    ),
    "package.xml missing": (REFERENCE.without(MANIFEST), ("package-found", "package-type"), ()),
    "package.xml broken": (
        REFERENCE.replacing(MANIFEST, "</name>", "</nam>"),
        ("package-found", "package-type"),
        (),
    ),
    "setup.py missing": (REFERENCE.without(SETUP), (*INSTALLS, "setup-imports", "launch-finds-files"), ()),
    "syntax error in setup.py": (
        REFERENCE.replacing(SETUP, "zip_safe=True,", "zip_safe=True"),
        (*INSTALLS, "setup-imports", "launch-finds-files"),
        (),
    ),
    "setup() is not called": (REFERENCE.with_files({SETUP: ""}), (*INSTALLS, "launch-finds-files"), ()),
    "the marker is missing": (REFERENCE.without("my_robot/resource"), ("setup-installs-urdf",), ()),
    "no entry for RViz": (
        REFERENCE.replacing(SETUP, RVIZ_ENTRY, ""),
        ("setup-installs-rviz", "launch-finds-files"),
        (),
    ),
    "glob finds a folder": (
        REFERENCE.with_files({"my_robot/urdf/meshes/wheel.stl": "solid"}),
        ("setup-installs-urdf",),
        (),
    ),
    "path of one machine": (
        REFERENCE.replacing(LAUNCH, "os.path.join(share, 'my_robot.urdf')", "'/home/me/my_robot.urdf'"),
        ("launch-finds-files",),
        (),
    ),
    "other folder in the launch file": (
        REFERENCE.replacing(LAUNCH, "share, 'my_robot.urdf'", "share, 'urdf', 'my_robot.urdf'"),
        ("launch-finds-files",),
        (),
    ),
    "no RViz file": (
        REFERENCE.without(RVIZ),
        ("rviz-found", "setup-installs-rviz", "launch-finds-files", "rviz-fixed-frame", "rviz-shows-robot"),
        (),
    ),
    "RViz file broken": (REFERENCE.with_files({RVIZ: "a: [b\n"}), ("rviz-fixed-frame", "rviz-shows-robot"), ()),
    "another fixed frame": (
        REFERENCE.replacing(RVIZ, "Fixed Frame: base_footprint", "Fixed Frame: map"),
        ("rviz-fixed-frame",),
        (),
    ),
    "URDF outside of the package": (
        REFERENCE.renaming(URDF, "my_robot.urdf"),
        ("setup-installs-urdf", "launch-finds-files"),
        (),
    ),
    "a package of CMake": (CMAKE, ("package-type",), (*INSTALLS, "setup-imports", "launch-finds-files")),
    "a keyword twice": (
        REFERENCE.replacing(SETUP, "zip_safe=True,", "zip_safe=True, zip_safe=True,"),
        (*INSTALLS, "setup-imports", "launch-finds-files"),
        (),
    ),
    "a name of launch's from another module": (
        REFERENCE.replacing(LAUNCH, "from launch_ros.actions import Node", "from launch.actions import Node"),
        ("launch-nodes",),
        (),
    ),
    "an open file for its text": (
        REFERENCE.replacing(LAUNCH, "file.read()", "open(os.path.join(share, 'my_robot.urdf'))"),
        ("launch-finds-files",),
        (),
    ),
    "a default that is no text": (
        REFERENCE.replacing(LAUNCH, "default_value='true'", "default_value=True"),
        ("launch-nodes",),
        (),
    ),
    "a default by place": (
        REFERENCE.replacing(LAUNCH, "'gui', default_value='true'", "'gui', 'true'"),
        ("launch-nodes",),
        (),
    ),
    "a condition that is no text": (
        REFERENCE.replacing(LAUNCH, "IfCondition(gui)", "IfCondition(True)"),
        ("launch-nodes",),
        (),
    ),
    "the launch file installed twice": (
        REFERENCE.replacing(SETUP, RVIZ_ENTRY, RVIZ_ENTRY + RVIZ_ENTRY.replace("rviz/*", "launch/*.py")),
        ("setup-installs-launch",),
        (),
    ),
    "compiled files in the way": (
        REFERENCE.replacing(SETUP, "os.path.join('launch', '*launch.[pxy][yma]*')", "'launch/*'").with_files(
            {"my_robot/launch/__pycache__/a.pyc": b""}
        ),
        ("setup-installs-launch",),
        (),
    ),
    "a slash that is missing": (
        REFERENCE.replacing(LAUNCH, "os.path.join(share, 'my_robot.urdf')", "share + 'my_robot.urdf'"),
        ("launch-finds-files",),
        (),
    ),
    "a slash that is too many": (
        REFERENCE.replacing(LAUNCH, "share, 'my_robot.urdf'", "share, '/my_robot.urdf'"),
        ("launch-finds-files",),
        (),
    ),
    "a launch file that is too large": (
        REFERENCE.with_files({LAUNCH: "#" * 200_000}),
        (),
        ("launch-nodes", "launch-finds-files"),
    ),
    "an RViz file that is too large": (
        REFERENCE.with_files({RVIZ: "#" * 600_000}),
        (),
        ("rviz-fixed-frame", "rviz-shows-robot"),
    ),
    "a setup.py that is too large": (
        REFERENCE.with_files({SETUP: "#" * 200_000}),
        (),
        (*INSTALLS, "setup-imports", "launch-finds-files"),
    ),
    "a URDF that is too large": (REFERENCE.with_files({URDF: " " * 1_100_000}), (), OF_URDF),
    "an archive that cannot be opened": (
        Submitted({"lab6.rar": b"Rar!", "Task1_Step8.png": png()}),
        (),
        (*OF_URDF, *OF_PACKAGE),
    ),
    "nothing but pictures": (PICTURES, ("urdf-loads", "package-found", *OF_URDF, *OF_PACKAGE), ()),
    "nothing but the URDF and pictures": (
        PICTURES.with_files({"my_robot.urdf": REFERENCE.files[URDF]}),
        ("package-found", *OF_PACKAGE),
        (),
    ),
}

# Defects of setup.py, because of which the files that the launch file names are not where it looks for them.
CARRIED = (
    "setup.py missing", "syntax error in setup.py", "setup() is not called", "no entry for RViz", "a keyword twice",
)  # fmt: skip

every_defect = pytest.mark.parametrize(("submitted", "lost", "pending"), DEFECTS.values(), ids=DEFECTS)


def graded(submitted: Submitted, parts: Sequence[str] = ()) -> Report:
    """Return the report on a submission."""
    return grade(LAB, submitted.submission, parts)


def with_status(report: Report, *statuses: str) -> set[str]:
    """Return the criteria with one of these statuses."""
    return {result.criterion.id for result in report.results if result.outcome.status in statuses}


def points(*criteria: str) -> Decimal:
    """Return the points of some criteria."""
    return sum((criterion.points for criterion in LAB.criteria if criterion.id in criteria), Decimal(0))


@every_defect
def test_a_defect_loses_the_expected_criteria(
    submitted: Submitted, lost: Sequence[str], pending: Sequence[str], request: pytest.FixtureRequest
) -> None:
    """Exactly the criteria about the defect fail, and exactly those that need manual grading are pending."""
    report = graded(submitted)
    assert with_status(report, "failed", "skipped") == set(lost)
    assert with_status(report, "pending") == {*PENDING, *pending}
    assert with_status(report, "errored") == set()
    assert (report.max_score, report.pending) == (Decimal(100), points(*PENDING, *pending))
    carried = {"launch-finds-files"} if request.node.callspec.id in CARRIED else set()
    assert {result.criterion.id for result in report.results if result.carried} == carried
    assert report.score == 100 - points(*{*lost} - carried, *PENDING, *pending)


@every_defect
def test_a_defect_is_reported_once(submitted: Submitted, lost: Sequence[str], pending: Sequence[str]) -> None:
    """Consequences are skipped, and name the criterion that failed."""
    report = graded(submitted)
    failed = {
        result.criterion.id for result in report.results if result.outcome.status == "failed" and not result.carried
    }
    most = 2 if {"urdf-loads", "package-found"} <= set(lost) else 1
    assert len(failed) == min(most, len(set(lost)))
    assert failed <= set(lost[:most])
    for result in report.results:
        if result.outcome.status == "skipped":
            assert result.because in failed
            assert result.outcome.message == f"skipped because {result.because} failed"


def test_two_defects_are_both_reported() -> None:
    """One defect never hides another one."""
    two = REFERENCE.replacing(SETUP, "import os\n", "").replacing(
        RVIZ, "Fixed Frame: base_footprint", "Fixed Frame: map"
    )
    three = two.replacing(LAUNCH, "os.path.join(share, 'my_robot.urdf')", "'/home/me/my_robot.urdf'")
    assert with_status(graded(three), "failed") == {"setup-imports", "rviz-fixed-frame", "launch-finds-files"}


@pytest.mark.parametrize(
    ("submitted", "code", "path", "message"),
    [
        (
            REFERENCE.replacing(MANIFEST, "</name>", "</nam>"),
            "PKG001",
            MANIFEST,
            "package.xml is not readable as XML: Opening and ending tag mismatch: name line 4 and nam",
        ),
        (
            REFERENCE.replacing(MANIFEST, "Apache-2.0", "TODO"),
            "PKG003",
            MANIFEST,
            "<license> of package.xml is still TODO",
        ),
        (
            REFERENCE.replacing(MANIFEST, ">my_robot<", ">robot<"),
            "PKG005",
            SETUP,
            "package.xml names the package 'robot', setup.py names it 'my_robot'",
        ),
        (
            REFERENCE.replacing(SETUP, "zip_safe=True,", "zip_safe=True"),
            "PKG010",
            SETUP,
            "Python cannot read setup.py: invalid syntax. Perhaps you forgot a comma?",
        ),
        (
            REFERENCE.replacing(SETUP, "import os\n", ""),
            "PKG011",
            SETUP,
            "the name 'os' is not defined or imported",
        ),
        (
            REFERENCE.without("my_robot/resource"),
            "PKG012",
            SETUP,
            "data_files lists 'resource/my_robot', but there is no such file",
        ),
        (
            REFERENCE.without("my_robot/launch"),
            "PKG013",
            SETUP,
            "the pattern 'launch/*launch.[pxy][yma]*' in setup.py matches no file, because there is no folder 'launch'",
        ),
        (
            REFERENCE.replacing(LAUNCH, "    return ", "    "),
            "LCH002",
            LAUNCH,
            "generate_launch_description does not return its LaunchDescription",
        ),
        (
            REFERENCE.replacing(LAUNCH, "os.path.join(share, 'my_robot.urdf')", "'/home/me/my_robot.urdf'"),
            "LCH003",
            LAUNCH,
            "the path /home/me/my_robot.urdf exists on one machine only",
        ),
        (
            REFERENCE.with_files({RVIZ: "hello\n"}),
            "RVZ001",
            RVIZ,
            "there is no 'Visualization Manager': this is not an RViz file",
        ),
        (
            REFERENCE.replacing(RVIZ, "rviz_default_plugins/RobotModel", "rviz/RobotModel"),
            "RVZ002",
            RVIZ,
            "rviz/RobotModel is a class of ROS 1; in ROS 2 it is rviz_default_plugins/RobotModel",
        ),
    ],
    ids=lambda value: value if isinstance(value, str) and value[:3] in ("PKG", "LCH", "RVZ") else "",
)
def test_problems_of_the_packages_files_are_listed(submitted: Submitted, code: str, path: str, message: str) -> None:
    """Each problem of a file of the package is listed once, with its code and location."""
    (problem,) = graded(submitted).problems
    assert (problem.code, problem.location.path, problem.message) == (code, path, message)
    assert graded(submitted, ["task1"]).problems == ()


def test_evidence_is_shown_with_its_criterion() -> None:
    """Pictures that the lab asks for are listed with their criterion, others on their own."""
    report = graded(REFERENCE.with_files({"holiday.png": png()}))
    found = {found_files.evidence.id: [file.path for file in found_files.files] for found_files in report.evidence}
    assert found == {
        "task1-step8": ["Task1_Step8.png"],
        "task1-step18": ["Task1_Step18.png"],
        "task1-step36": ["Task1_Step36.png"],
        "task2-step6": ["Task2_Step6.png"],
        "task3-step3": ["Task3_Step3.png"],
    }
    assert [file.path for file in report.others] == ["holiday.png"]


def test_a_single_urdf_is_graded_on_its_own_part() -> None:
    """A single URDF is graded on the parts that need nothing else; the report names the other parts."""
    single = read_submission(REFERENCE.data(URDF), identity="one", path="my_robot.urdf")
    report = grade(LAB, single)
    assert report.parts == ("task1",)
    assert (report.score, report.max_score, report.pending) == (Decimal(70), Decimal(70), Decimal(0))
    assert report.notes == ("only task1 is graded: task2, task3 and questions need the whole folder",)
    assert grade(LAB, single, ["task1"]).notes == ()


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
