"""Edits of packages: for each mistake that students make, one of the first is the correction; none is made for hostile files."""

from itertools import product

import pytest

from grader.lab.grading.grade import grade
from grader.lab.hints.edits import Proposal
from grader.lab.hints.package_edits import package_proposals
from grader.lab.submission.edited import content, edited_files, with_files
from grader.lab.submission.submission import Submission
from tests.examples import spread
from tests.samples import LAB6, SAMPLES, reference

pytestmark = pytest.mark.slow

_REFERENCE = reference()
SETUP, LAUNCH, RVIZ, MANIFEST = (
    "setup.py",
    "launch/my_robot_rviz.launch.py",
    "rviz/my_robot.rviz",
    "package.xml",
)
ENTRY = "        (os.path.join('share', package_name), glob('rviz/*')),\n"
URDF_PATH, RVIZ_PATH = (
    "os.path.join(share, 'my_robot.urdf')",
    "os.path.join(share, 'my_robot.rviz')",
)
RVIZ_ARGUMENTS = f"            arguments=['-d', {RVIZ_PATH}],\n"
RVIZ_NODE = f"        Node(\n            package='rviz2',\n            executable='rviz2',\n{RVIZ_ARGUMENTS}        ),\n"

# A part of a file of the reference, and what a student writes instead. With the correction, the file is as before.
UNDONE = {
    "folder misspelt in a pattern": (SETUP, "rviz/*", "ruviz/*"),
    "ending misspelt in a pattern": (SETUP, "*launch.[pxy][yma]*", "*lauch.[pxy][yma]*"),
    "folder capitalised in a pattern": (SETUP, "urdf/*", "URDF/*"),
    "backslash in a pattern": (SETUP, "'urdf/*'", r"'urdf\\*'"),
    "entry missing": (SETUP, ENTRY, ""),
    "comma missing in an entry": (
        SETUP,
        "package_name), glob('urdf/*')",
        "package_name) glob('urdf/*')",
    ),
    "comma missing between entries": (SETUP, "['package.xml']),", "['package.xml'])"),
    "other folder than share": (
        SETUP,
        "('share', package_name), glob('rviz",
        "('lib', package_name), glob('rviz",
    ),
    "name of the package misspelt": (
        SETUP,
        "package_name = 'my_robot'",
        "package_name = 'my_robto'",
    ),
    "list missing around the file of an entry": (SETUP, "['package.xml']", "'package.xml'"),
    "at in place of @": (MANIFEST, "course@example.org", "course at example.org"),
    "import os missing": (SETUP, "import os\n", ""),
    "import misspelt": (SETUP, "import os\n", "import oss\n"),
    "variable misspelt": (SETUP, "package_name = ", "package_nane = "),
    "function misspelt": (SETUP, "glob(os.path.join(", "glob(os.path.jion("),
    "function of a module missing": (SETUP, "import find_packages, setup", "import setup"),
    "typographic quotes": (SETUP, "glob('rviz/*')", "glob(‘rviz/*’)"),
    "quote missing": (SETUP, "glob('rviz/*')", "glob('rviz/*)"),
    "bracket not closed": (SETUP, "glob('rviz/*')),", "glob('rviz/*'),"),
    "bracket too many": (SETUP, "glob('rviz/*')),", "glob('rviz/*'))),"),
    "bracket not opened": (
        SETUP,
        "os.path.join('share', package_name)",
        "os.path.join'share', package_name)",
    ),
    "keyword misspelt": (SETUP, "from glob import", "form glob import"),
    "indented": (SETUP, "package_name = ", " package_name = "),
    "name in quotes": (
        SETUP,
        "('share', package_name), glob('urdf/*')",
        "('share', 'package_name'), glob('urdf/*')",
    ),
    "program of another name": (LAUNCH, "executable='rviz2'", "executable='rviz'"),
    "method not called": (LAUNCH, "file.read()", "file.read"),
    "block not indented": (
        LAUNCH,
        "        robot_description = file",
        "    robot_description = file",
    ),
    "line after a tab": (LAUNCH, "    share = get", "\tshare = get"),
    "URDF misspelt": (LAUNCH, "'my_robot.urdf'", "'my_robott.urdf'"),
    "URDF in a folder": (LAUNCH, "'my_robot.urdf'", "'urdf/my_robot.urdf'"),
    "folder as an argument": (LAUNCH, "share, 'my_robot.rviz'", "share, 'rviz', 'my_robot.rviz'"),
    "slash before the path": (LAUNCH, "share, 'my_robot.urdf'", "share, '/my_robot.urdf'"),
    "package misspelt": (LAUNCH, "directory('my_robot')", "directory('my_robo')"),
    "node without arguments": (LAUNCH, RVIZ_ARGUMENTS, ""),
    "node missing": (LAUNCH, RVIZ_NODE, ""),
    "executable misspelt": (
        LAUNCH,
        "executable='robot_state_publisher'",
        "executable='robot_state_publsher'",
    ),
    "argument misspelt": (LAUNCH, "executable='rviz2'", "excutable='rviz2'"),
    "import of an action missing": (LAUNCH, "from launch_ros.actions import Node\n", ""),
    "entry function misspelt": (
        LAUNCH,
        "def generate_launch_description",
        "def generate_launch_descripton",
    ),
    "nothing returned": (LAUNCH, "    return LaunchDescription", "    LaunchDescription"),
    "comma missing in a node": (LAUNCH, "package='rviz2',\n", "package='rviz2'\n"),
    "colon missing": (LAUNCH, "description():", "description()"),
    "frame": (RVIZ, "Fixed Frame: base_footprint", "Fixed Frame: map"),
    "no frame": (RVIZ, "    Fixed Frame: base_footprint\n", ""),
    "frame after a tab": (RVIZ, "    Fixed Frame:", "\tFixed Frame:"),
    "topic": (RVIZ, "/robot_description", "/robot_descripton"),
    "visuals off": (RVIZ, "Visual Enabled: true", "Visual Enabled: false"),
    "class of ROS 1": (RVIZ, "rviz_default_plugins/RobotModel", "rviz/RobotModel"),
    "name in package.xml": (MANIFEST, "<name>my_robot<", "<name>My_Robot<"),
    "build type": (MANIFEST, "ament_python", "ament_cmake"),
    "build type missing": (MANIFEST, "    <build_type>ament_python</build_type>\n", ""),
    "tag not closed": (MANIFEST, "</name>", "<name>"),
    "element not closed": (MANIFEST, "  </export>\n", ""),
}
# The same, where another correction is as good.
CORRECTED = {
    "slash missing before a folder": (
        SETUP,
        "os.path.join('share', package_name, 'launch')",
        "'share/' + package_name + 'launch'",
    ),
    "no imports": (SETUP, "import os\nfrom glob import glob\n", ""),
    "share folder of another package": (
        SETUP,
        "('share', package_name), glob('urdf",
        "('share', 'myrobot'), glob('urdf",
    ),
    "slash missing": (LAUNCH, URDF_PATH, "share + 'my_robot.urdf'"),
    "path in the home folder": (
        LAUNCH,
        URDF_PATH,
        "'/home/ash/ws/src/my_robot/urdf/my_robot.urdf'",
    ),
    "path with a tilde": (
        LAUNCH,
        RVIZ_PATH,
        "os.path.expanduser('~/ws/my_robot/rviz/my_robot.rviz')",
    ),
    "folder of one machine": (
        LAUNCH,
        "get_package_share_directory('my_robot')",
        "'/home/ash/ws/install/my_robot/share/my_robot'",
    ),
    "path relative to the terminal": (LAUNCH, URDF_PATH, "'src/my_robot/urdf/my_robot.urdf'"),
    "condition that prevents a node": (
        LAUNCH,
        RVIZ_ARGUMENTS,
        RVIZ_ARGUMENTS + "            condition=UnlessCondition(gui),\n",
    ),
    "path instead of contents": (
        LAUNCH,
        "[{'robot_description': robot_description}]",
        f"[{{'robot_description': {URDF_PATH}}}]",
    ),
}
MOVED = {
    "launch file misspelt": (LAUNCH, "launch/my_robot_rvix.launch.py"),
    "launch file without extension": (LAUNCH, "launch/my_robot_rviz"),
    "RViz file misspelt": (RVIZ, "rviz/myrobot.rviz"),
    "URDF misnamed": ("urdf/my_robot.urdf", "urdf/robot.urdf"),
}
HOSTILE = {
    "brackets": b"(" * 6000,
    "quotes": b"'" * 5000,
    "calls": b"from glob import glob\n" + b"glob('a')\n" * 3000,
    "no text": b"\xff\xfe\x00",
    "byte-order mark": b"\xef\xbb\xbfimport os\r\n",
    "tags": b"<a>" * 5000,
    "displays": b"- Class: rviz/x\n" * 3000,
    "blank lines": b"\n" * 30_000,
}


def _passed(submission: Submission) -> frozenset[str]:
    results = grade(LAB6, submission).results
    return frozenset(result.criterion.id for result in results if result.outcome.status == "passed")


_ALL = _passed(_REFERENCE)


def _proposals(submission: Submission) -> list[Proposal]:
    """Return the edits for the criteria of the package that failed or are skipped."""
    passed = _passed(submission)
    lost = [
        criterion
        for criterion in LAB6.criteria
        if criterion.part == "task2" and criterion.id not in passed
    ]
    wanted = [(criterion.check.about.looks_at, criterion.arguments) for criterion in lost]
    if submission.package is None:
        return []
    return [
        it
        for made in package_proposals(submission.package, _REFERENCE.package, wanted)
        for it in made
    ]


def _corrected(broken: Submission) -> Submission | None:
    """Return the submission after the first edit with which all of its criteria pass that pass for the reference."""
    for proposal in _proposals(broken):
        files = edited_files(broken, proposal.edits)
        after = with_files(broken, files) if files is not None else None
        if after is not None and _passed(after) >= _ALL:
            return after
    return None


def _with_mistake(path: str, old: str, new: str) -> Submission:
    text = (content(_REFERENCE, path) or b"").decode()
    assert old in text
    return with_files(_REFERENCE, {path: text.replace(old, new, 1).encode()})


@pytest.mark.parametrize("mistake", UNDONE)
def test_a_mistake_is_undone(mistake: str) -> None:
    """The first edit with which everything passes gives the file back as it was."""
    path, old, new = UNDONE[mistake]
    broken = _with_mistake(path, old, new)
    assert _passed(broken) < _ALL
    after = _corrected(broken)
    assert after is not None
    assert content(after, path) == content(_REFERENCE, path)


@pytest.mark.parametrize("mistake", spread(CORRECTED, 3))
def test_a_mistake_is_corrected(mistake: str) -> None:
    """There is an edit with which everything passes that passes for the reference."""
    broken = _with_mistake(*CORRECTED[mistake])
    assert _passed(broken) < _ALL
    assert _corrected(broken) is not None


def test_actions_without_brackets_get_them() -> None:
    """Each action is then an argument of its own, of which a description takes one."""
    data = content(_REFERENCE, LAUNCH) or b""
    text = (
        data.decode()
        .replace("LaunchDescription([", "LaunchDescription(")
        .replace("    ])", "    )")
    )
    broken = with_files(_REFERENCE, {LAUNCH: text.encode()})
    assert _passed(broken) < _passed(_REFERENCE)
    found = [it for it in _proposals(broken) if "brackets" in it.cause]
    corrected = [with_files(broken, edited_files(broken, it.edits) or {}) for it in found]
    assert _passed(_REFERENCE) in map(_passed, corrected)


@pytest.mark.parametrize("mistake", MOVED)
def test_a_file_is_renamed(mistake: str) -> None:
    """A file that is misnamed is renamed."""
    path, other = MOVED[mistake]
    data = content(_REFERENCE, path)
    broken = with_files(_REFERENCE, {path: None, other: data})
    assert _passed(broken) < _ALL
    after = _corrected(broken)
    assert after is not None
    assert content(after, path) == data


_CORRECTED_SAMPLES = (
    "folder-misspelt-in-setup",
    "glob-finds-a-folder",
    "glob-module-called",
    "launch-file-misspelt",
    "launch-home-path",
    "launch-looks-in-other-folder",
    "launch-syntax-error",
    "launch-without-rviz",
    "missing-import-glob",
    "package-misnamed",
    "rviz-fixed-frame-map",
    "rviz-not-installed",
    "rviz-robot-off",
    "setup-as-created",
    "setup-syntax-error",
)


@pytest.mark.parametrize("name", spread(_CORRECTED_SAMPLES, 5))
def test_a_sample_is_corrected(name: str) -> None:
    """One edit corrects each sample with a mistake in its package."""
    assert _corrected(SAMPLES[name].open()) is not None


@pytest.mark.parametrize("path", [SETUP, LAUNCH, RVIZ, MANIFEST, "resource/my_robot"])
def test_a_missing_file_is_not_written(path: str) -> None:
    """Every edit is one of a file that exists."""
    broken = with_files(_REFERENCE, {path: None})
    paths = {edit.path for proposal in _proposals(broken) for edit in proposal.edits}
    assert all(content(broken, own) is not None for own in paths)


def test_the_name_of_a_package_gets_no_slash() -> None:
    """A path without a slash is never corrected in the name of the package, which ROS 2 would not find then."""
    broken = _with_mistake(LAUNCH, URDF_PATH, "share + 'my_robot.urdf'")
    assert not any(
        "my_robot/" in edit.new
        for proposal in _proposals(broken)
        for edit in proposal.edits
        if edit.old == "my_robot"
    )


def test_a_node_that_is_wanted_is_not_taken_for_another_one() -> None:
    """robot_state_publisher is never renamed to joint_state_publisher, although the names are alike."""
    other = "equivalent-launch-file-in-xml"
    submission = SAMPLES[other].open()
    path = "my_robot/launch/my_robot_rviz.launch.xml"
    text = (content(submission, path) or b"").decode().replace("my_robot.urdf')", "my_robot.urdf)")
    broken = with_files(submission, {path: text.encode()})
    assert not any(
        edit.old == "robot_state_publisher"
        for proposal in _proposals(broken)
        for edit in proposal.edits
    )


@pytest.mark.parametrize(
    ("path", "name"), spread(product((SETUP, LAUNCH, RVIZ, MANIFEST), HOSTILE), 4)
)
def test_hostile_files_get_few_edits(path: str, name: str) -> None:
    """No file makes the search for edits fail, or find many."""
    broken = with_files(_REFERENCE, {path: HOSTILE[name]})
    found = _proposals(broken)
    assert len(found) <= 14 * 12
    for proposal in found:
        assert edited_files(broken, proposal.edits) is not None
