"""The RViz file: which one is graded, its fixed frame, and whether it shows the robot."""

import pytest

from grader.checks.rviz import rviz_display_on, rviz_fixed_frame, rviz_found, rviz_shows_robot
from grader.source import Location
from tests.checks.outcomes import Finding, finds, lacks
from tests.checks.submissions import LAUNCH, REFERENCE, RVIZ, SETUP, URDF, Submitted, png, start_of

NAME = "my_robot.rviz"
BY_LAUNCH = "my_robot_rviz.launch.py"
FRAME = "base_footprint"
TEXT = str(REFERENCE.files[RVIZ])
MODEL = TEXT[TEXT.index("    - Alpha: 1\n") : TEXT.index("    - Class: rviz_default_plugins/TF")]
TF = TEXT[TEXT.index("    - Class: rviz_default_plugins/TF") : TEXT.index("  Enabled: true\n  Global")]
SHOWN = "the display 'RobotModel' shows the robot"


def rviz(old: str, new: str, of: Submitted = REFERENCE) -> Submitted:
    """Return a submission with another text in its RViz file."""
    return of.replacing(RVIZ, old, new)


def frame_of(submitted: Submitted) -> Finding:
    """Return the outcome for the fixed frame."""
    return finds(rviz_fixed_frame, submitted, name=NAME, frame=FRAME, launch=BY_LAUNCH)


def robot_in(submitted: Submitted) -> Finding:
    """Return the outcome for the display of the robot."""
    return finds(rviz_shows_robot, submitted, name=NAME, launch=BY_LAUNCH)


def grouped(model: str = MODEL, enabled: str = "true") -> Submitted:
    """Return the reference with its RobotModel in a group."""
    inner = "".join(f"    {line}\n" for line in model.splitlines())
    group = f"    - Class: rviz_common/Group\n      Displays:\n{inner}      Enabled: {enabled}\n      Name: Mine\n"
    return rviz(MODEL, group)


# --- Which file is meant ----------------------------------------------------------------------------------------------


def test_a_file_of_the_expected_name_is_found() -> None:
    """The RViz file with the lab's name passes, wherever it is in the package."""
    assert finds(rviz_found, REFERENCE, name=NAME) == ("passed", "the RViz file is rviz/my_robot.rviz", None)
    beside = REFERENCE.renaming(RVIZ, "my_robot/urdf/my_robot.rviz")
    expected = ("passed", "the RViz file is urdf/my_robot.rviz", None)
    assert finds(rviz_found, beside, name=NAME, launch=BY_LAUNCH) == expected


OTHER = REFERENCE.renaming(RVIZ, "my_robot/rviz/view.rviz")
OPENED = OTHER.replacing(LAUNCH, "'my_robot.rviz'", "'view.rviz'")


@pytest.mark.parametrize(
    "submitted",
    [
        OPENED,
        OPENED.replacing(LAUNCH, "os.path.join(share, 'view.rviz')", "'/home/me/ws/src/my_robot/rviz/view.rviz'"),
        OPENED.replacing(LAUNCH, "os.path.join(share, 'view.rviz')", "os.path.join(share, 'rviz', 'view.rviz')"),
        OPENED.replacing(SETUP, "        (os.path.join('share', package_name), glob('rviz/*')),\n", ""),
    ],
    ids=["installed", "home", "nested", "not-installed"],
)
def test_the_file_that_the_launch_file_opens_is_found(submitted: Submitted) -> None:
    """A file of another name is graded if the launch file opens it; a wrong folder is a fault of the launch file."""
    expected = ("passed", "the RViz file is rviz/view.rviz", None)
    assert finds(rviz_found, submitted, name=NAME, launch=BY_LAUNCH) == expected
    assert frame_of(submitted)[0] == "passed"


@pytest.mark.parametrize(
    "submitted", [OTHER, OTHER.replacing(LAUNCH, "'-d', os.path.join(share, 'my_robot.rviz')", "")]
)
def test_a_file_that_nothing_opens_fails(submitted: Submitted) -> None:
    """A file of another name that the launch file does not open fails but is examined."""
    message = "there is no RViz file 'my_robot.rviz'; the package has rviz/view.rviz"
    assert finds(rviz_found, submitted, name=NAME, launch=BY_LAUNCH) == ("failed", message, None)
    assert finds(rviz_found, submitted, name=NAME) == ("failed", message, None)
    assert frame_of(submitted)[0] == robot_in(submitted)[0] == "passed"


@pytest.mark.parametrize(
    "submitted",
    [
        OPENED.replacing(LAUNCH, "    ])\n", ""),
        OPENED.replacing(LAUNCH, "os.path.join(share, 'view.rviz')", "os.environ['VIEW']"),
    ],
    ids=["syntax", "environment"],
)
def test_an_unknown_launch_file_does_not_fail_the_name(submitted: Submitted) -> None:
    """A launch file that cannot be evaluated does not fail the name of the RViz file."""
    message = "cannot determine statically whether the launch file opens rviz/view.rviz; needs manual grading"
    assert finds(rviz_found, submitted, name=NAME, launch=BY_LAUNCH) == ("pending", message, None)


def test_the_opened_file_is_graded() -> None:
    """The file that the launch file opens is graded, else the one with the lab's name."""
    map_ = TEXT.replace("base_footprint", "map")
    two = REFERENCE.with_files({"my_robot/rviz/a.rviz": map_})
    assert frame_of(two)[0] == "passed"
    opened = two.replacing(LAUNCH, "'my_robot.rviz'", "'a.rviz'")
    assert finds(rviz_found, opened, name=NAME, launch=BY_LAUNCH)[1] == "the RViz file is rviz/a.rviz"
    location = opened.location_of("my_robot/rviz/a.rviz", "map\n    Frame Rate")
    assert frame_of(opened)[0::2] == ("failed", location)


def test_a_missing_rviz_file_is_one_fault() -> None:
    """Without an RViz file all checks miss the same thing."""
    expected = ("RViz file in the package", "", "the package has no RViz file: no file ends in .rviz", None)
    for submitted in (REFERENCE.without(RVIZ), REFERENCE.renaming(RVIZ, NAME)):
        assert lacks(rviz_found, submitted, name=NAME, launch=BY_LAUNCH) == expected
        assert lacks(rviz_fixed_frame, submitted, name=NAME, frame=FRAME) == expected
        assert lacks(rviz_shows_robot, submitted, name=NAME) == expected
        assert lacks(rviz_display_on, submitted, name=NAME, kind="TF") == expected


def test_a_missing_package_is_reported() -> None:
    """The check of the fixed frame examines the submission, and misses the package as others do."""
    expected = ("package", "", "the submission has no ROS 2 package: there is no package.xml", None)
    assert lacks(rviz_fixed_frame, Submitted({"x.png": png()}), name=NAME, frame=FRAME) == expected


NO_MANAGER = "there is no 'Visualization Manager': this is not an RViz file"
TAB = TEXT.replace("    - Alpha: 0.5", "\t- Alpha: 0.5")


@pytest.mark.parametrize(
    ("text", "message", "line"),
    [
        (TAB, "not readable as YAML: while scanning for the next token", 9),
        ("hello: [world\n", "not readable as YAML: while parsing a flow sequence", 2),
        ("hello\n", NO_MANAGER, 1),
        ("", NO_MANAGER, 1),
        (str(REFERENCE.files[LAUNCH]), NO_MANAGER, 1),
    ],
    ids=["tab", "bracket", "text", "empty", "python"],
)
def test_an_unreadable_file_is_missed(text: str, message: str, line: int) -> None:
    """A file that RViz cannot read is missed once, with its location; the check of its existence passes."""
    submitted = REFERENCE.with_files({RVIZ: text})
    kind, name, words, location = lacks(rviz_fixed_frame, submitted, name=NAME, frame=FRAME)
    assert (kind, name) == ("RViz file", "rviz/my_robot.rviz")
    assert words.startswith(message)
    assert location is not None
    assert (location.path, location.line) == (RVIZ, line)
    assert lacks(rviz_shows_robot, submitted, name=NAME) == (kind, name, words, location)
    assert lacks(rviz_display_on, submitted, name=NAME, kind="TF") == (kind, name, words, location)
    assert finds(rviz_found, submitted, name=NAME)[0] == "passed"


# --- The fixed frame --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "spelling", ["base_footprint", '"base_footprint"', "'base_footprint'", "  base_footprint   # ground"]
)
def test_the_fixed_frame_passes(spelling: str) -> None:
    """Every YAML spelling of the frame passes."""
    submitted = rviz("Fixed Frame: base_footprint", f"Fixed Frame: {spelling}")
    assert frame_of(submitted) == ("passed", "the Fixed Frame is 'base_footprint'", None)


@pytest.mark.parametrize(
    ("frame", "hint"),
    [
        ("base_link", ""),
        ("map", "; the robot has no link 'map'"),
        ("base_fotprint", "; the robot has no link 'base_fotprint'; did you mean 'base_footprint'?"),
        ("/base_footprint", "; the robot has no link '/base_footprint'; did you mean 'base_footprint'?"),
    ],
)
def test_another_fixed_frame_fails(frame: str, hint: str) -> None:
    """Another frame fails at its value; the message says if the robot does not have that frame."""
    submitted = rviz("Fixed Frame: base_footprint", f"Fixed Frame: {frame}")
    message = f"the Fixed Frame is {frame!r}; it should be 'base_footprint'{hint}"
    assert frame_of(submitted) == ("failed", message, submitted.location_of(RVIZ, f"{frame}\n    Frame Rate"))


@pytest.mark.parametrize("line", ["", "    Fixed Frame:\n", '    Fixed Frame: ""\n'], ids=["none", "nothing", "empty"])
def test_no_fixed_frame_fails(line: str) -> None:
    """A frame that is absent or empty is not set."""
    status, message, location = frame_of(rviz("    Fixed Frame: base_footprint\n", line))
    assert (status, message) == ("failed", "the RViz file sets no Fixed Frame; it should be 'base_footprint'")
    assert location is not None
    assert (location.path, location.line) == (RVIZ, 40 if line else 7)


def test_a_frame_missing_in_the_urdf_passes() -> None:
    """The correct frame passes even if the URDF lacks it, which is mentioned and graded elsewhere."""
    submitted = REFERENCE.replacing(URDF, "base_footprint", "base_ground")
    message = "the Fixed Frame is 'base_footprint', which the robot does not have"
    assert frame_of(submitted) == ("passed", message, None)


@pytest.mark.parametrize("submitted", [REFERENCE.without(URDF), REFERENCE.replacing(URDF, "<robot", "<rob")])
def test_the_frame_needs_no_urdf(submitted: Submitted) -> None:
    """Without a robot the frame is compared by its name."""
    assert frame_of(submitted) == ("passed", "the Fixed Frame is 'base_footprint'", None)
    other = rviz("Fixed Frame: base_footprint", "Fixed Frame: map", submitted)
    assert frame_of(other)[:2] == ("failed", "the Fixed Frame is 'map'; it should be 'base_footprint'")


# --- The robot --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "submitted",
    [
        REFERENCE,
        rviz("Value: /robot_description", "Value: robot_description"),
        rviz("Value: /robot_description", 'Value: "/robot_description"'),
        rviz("Durability Policy: Volatile", "Durability Policy: Transient Local"),
        rviz("Enabled: true\n      Name: RobotModel", "Enabled: True\n      Name: RobotModel"),
        rviz("      Enabled: true\n      Name: RobotModel\n", "      Name: RobotModel\n"),
        rviz("      Description Source: Topic\n", ""),
        rviz("      Visual Enabled: true\n", ""),
        grouped(),
        rviz(MODEL, MODEL.replace("Enabled: true\n      Name", "Enabled: false\n      Name") + MODEL),
        rviz(MODEL, MODEL.replace("rviz_default_plugins/", "rviz/") + MODEL),
    ],
    ids=[
        "reference", "no-slash", "quoted", "transient", "capital", "value-only", "no-source", "no-visual", "group",
        "one-of-two", "ros1-beside",
    ],
)  # fmt: skip
def test_an_enabled_robot_model_passes(submitted: Submitted) -> None:
    """One display that shows the robot is enough, whatever its group and its topic's quality of service."""
    assert robot_in(submitted) == ("passed", SHOWN, None)


ON, NAMED = "Enabled: true\n      Name: RobotModel", "Enabled: false\n      Name: RobotModel"
OFF, BARE = (
    "the RobotModel display is off",
    "the class 'RobotModel' names no package; in ROS 2 it is rviz_default_plugins/RobotModel",
)
ROS_1 = "rviz/RobotModel is a class of ROS 1; in ROS 2 it is rviz_default_plugins/RobotModel"
TOPIC = "the RobotModel display reads the topic '/robot'; it should read '/robot_description'"
NO_TOPIC = "the RobotModel display has no Description Topic; it should be '/robot_description'"
INVISIBLE = "the RobotModel display is on, but its Visual Enabled is off, so RViz draws nothing"


@pytest.mark.parametrize(
    ("submitted", "message"),
    [
        (rviz(ON, NAMED), OFF),
        (rviz("      Enabled: true\n      Name: RobotModel\n      Value: true\n", "      Name: RobotModel\n"), OFF),
        (grouped(enabled="false"), f"{OFF}: its group is off"),
        (rviz("rviz_default_plugins/RobotModel", "rviz/RobotModel"), ROS_1),
        (rviz("rviz_default_plugins/RobotModel", "RobotModel"), BARE),
        (rviz("Value: /robot_description", "Value: /robot"), TOPIC),
        (rviz("Value: /robot_description", 'Value: ""'), NO_TOPIC),
        (rviz("        Value: /robot_description\n", ""), NO_TOPIC),
        (rviz("Visual Enabled: true", "Visual Enabled: false"), INVISIBLE),
    ],
    ids=["off", "not-on", "group", "ros1", "bare", "topic", "empty", "no-topic", "visual"],
)
def test_a_robot_model_that_shows_nothing_fails(submitted: Submitted, message: str) -> None:
    """The message says why the robot is not shown, at the class of the display."""
    lines = enumerate(str(submitted.files[RVIZ]).splitlines(), start=1)
    number, line = next((number, line) for number, line in lines if "RobotModel" in line)
    location = Location(RVIZ, number, line.index("Class: ") + len("Class: ") + 1)
    assert robot_in(submitted) == ("failed", message, location)


def test_no_robot_model_fails() -> None:
    """The existing displays are listed, each once."""
    message = "there is no RobotModel display; the displays are: "
    assert robot_in(rviz(MODEL, TF)) == ("failed", f"{message}Grid and TF", None)
    none = rviz(TEXT[TEXT.index("    - Alpha: 0.5") : TEXT.index("  Enabled: true\n  Global")], "    []\n")
    assert robot_in(none) == ("failed", f"{message}none", None)


@pytest.mark.parametrize(
    ("submitted", "message"),
    [
        (
            rviz("Description Source: Topic", "Description Source: File"),
            "the RobotModel display reads a local file instead of a topic; needs manual grading",
        ),
        (
            rviz("rviz_default_plugins/RobotModel", "my_plugins/RobotModel"),
            "my_plugins/RobotModel is not a class of RViz itself; needs manual grading",
        ),
    ],
    ids=["file", "plugin"],
)
def test_a_robot_model_that_may_show_something_needs_manual_grading(submitted: Submitted, message: str) -> None:
    """A display that depends on a file or plug-in of another machine is pending, whether another display is off or not."""
    location = submitted.location_of(RVIZ, str(submitted.files[RVIZ]).splitlines()[16].strip().removeprefix("Class: "))
    assert robot_in(submitted) == ("pending", message, location)
    off = MODEL.replace("Enabled: true\n      Name", "Enabled: false\n      Name")
    assert robot_in(rviz("    - Alpha: 1\n", off + "    - Alpha: 1\n", submitted))[:2] == ("pending", message)


# --- Other displays ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", ["TF", "rviz_default_plugins/TF", "Grid"])
def test_an_enabled_display_passes(kind: str) -> None:
    """A display is found by its class, with or without its package."""
    assert finds(rviz_display_on, REFERENCE, name=NAME, kind=kind) == ("passed", f"a {kind} display is on", None)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "rviz_default_plugins/TF\n      Enabled: true",
            "rviz_default_plugins/TF\n      Enabled: false",
            "the TF display is off",
        ),
        (
            "rviz_default_plugins/TF",
            "rviz/TF",
            "rviz/TF is a class of ROS 1; in ROS 2 it is rviz_default_plugins/TF",
        ),
    ],
    ids=["off", "ros1"],
)
def test_a_disabled_display_fails(old: str, new: str, message: str) -> None:
    """A display that is disabled, or of ROS 1, fails at its class."""
    submitted = rviz(old, new)
    location = submitted.location_of(RVIZ, new.split("\n", maxsplit=1)[0] + "\n")
    assert finds(rviz_display_on, submitted, name=NAME, kind="TF") == ("failed", message, location)


def test_a_missing_display_fails() -> None:
    """The existing displays are listed."""
    message = "there is no LaserScan display; the displays are: Grid, RobotModel and TF"
    assert finds(rviz_display_on, REFERENCE, name=NAME, kind="LaserScan") == ("failed", message, None)


def test_the_topic_is_an_argument() -> None:
    """A rubric may ask for another topic of the robot."""
    other = rviz("Value: /robot_description", "Value: /other/robot_description")
    assert finds(rviz_shows_robot, other, name=NAME, topic="other/robot_description")[0] == "passed"
    assert finds(rviz_shows_robot, REFERENCE, name=NAME, topic="other/robot_description")[0] == "failed"


def test_an_unreadable_file_has_its_start_as_location() -> None:
    """The failure for a file that is no RViz file points to its first character."""
    submitted = REFERENCE.with_files({RVIZ: "Panels: []\n"})
    assert lacks(rviz_shows_robot, submitted, name=NAME)[3] == start_of(RVIZ)


def test_a_display_of_another_package_is_another_class() -> None:
    """With a package in its name, the class must be of that package; without one, it may be of any."""
    submitted = rviz("rviz_default_plugins/TF", "my_plugins/TF")
    message = "the class of the TF display is my_plugins/TF; it should be rviz_default_plugins/TF"
    place = submitted.location_of(RVIZ, "my_plugins/TF")
    kind = "rviz_default_plugins/TF"
    assert finds(rviz_display_on, submitted, name=NAME, kind=kind) == ("failed", message, place)
    assert finds(rviz_display_on, submitted, name=NAME, kind="TF") == ("passed", "a TF display is on", None)
