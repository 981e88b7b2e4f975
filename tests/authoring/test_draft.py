"""`grader rubric new`: what it writes tests all of the reference, and no reference is too large for it.

What it writes, omits and refuses is in `tests/corpus/authoring`.
"""

import json
import re
import shutil
import xml.etree.ElementTree as ET
from decimal import Decimal
from pathlib import Path

import pytest

from grader.files.reading import URDF_LIMIT
from grader.lab.grading.grade import grade
from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.submission.opening import open_submission
from grader.workspace.rules.rule_table import FAMILIES
from tests.command_line import ROOT, Done, run
from tests.workspace.carts import Edit, agreement_of, cart_files, edited
from tests.workspace.test_families import WRONG

ARM = ROOT / "tests/corpus/authoring/arm.urdf"
LAB6 = ROOT / "rubrics/lab6/my_robot"


def new(folder: Path, reference: Path, *options: str) -> Done:
    """Write a rubric into a folder, and return what the command printed."""
    return run(("rubric", "new", folder / "lab.toml", "--from", reference, *options))


# Python modules; entries of the template; folders that ros2 launch searches.
UNTESTED = re.compile(
    r"file (deleted|renamed): (my_robot/__init__.py|setup.cfg)"
    r"|.* setup.py .*(ament_index|package.xml).*|string misspelt: setup.py (share|launch).*"
)


@pytest.mark.exhaustive
@pytest.mark.parametrize("reference", [ARM, LAB6], ids=["robot", "package"])
def test_every_mutant_of_the_reference_loses_something(reference: Path, tmp_path: Path) -> None:
    """But for what no check is about; no criterion is idle, and no equivalent loses points."""
    copied = tmp_path / reference.name
    _ = shutil.copytree(reference, copied) if reference.is_dir() else shutil.copy(reference, copied)
    assert new(tmp_path, copied).returncode == 0
    done = run(("rubric", "test", tmp_path / "lab.toml", "--format", "json"))
    result = json.loads(done.stdout)
    survivors = [row["id"] for row in result["survivors"] if not UNTESTED.fullmatch(row["id"])]
    assert (done.returncode, survivors, result["idle"], result["unused_patterns"]) == (
        0,
        [],
        [],
        [],
    )
    assert result["equivalents"]["lost"] == []


def test_the_order_of_elements_does_not_matter(tmp_path: Path) -> None:
    """A robot that is written from its last element to its first has all points."""
    assert new(tmp_path, ARM).returncode == 0
    robot = ET.fromstring(ARM.read_text())
    for element in (robot, *robot.iter("link")):
        element[:] = reversed(element)
    (tmp_path / "reversed.urdf").write_bytes(ET.tostring(robot))
    assert (
        run(("grade", tmp_path / "reversed.urdf", "--rubric", tmp_path / "lab.toml")).returncode
        == 0
    )


NUMBER = re.compile(r"""(?<=[" ])-?[\d.]+(?=[" ])""")
TAGS = ("origin", "box", "cylinder", "sphere", "color", "axis", "limit", "mass", "inertia", "")


@pytest.mark.parametrize("tag", TAGS)
@pytest.mark.parametrize("source", [ARM, LAB6 / "urdf/my_robot.urdf"], ids=["arm", "wheels"])
def test_huge_numbers_are_no_fault(source: Path, tag: str, tmp_path: Path) -> None:
    """A rubric is written, in which what cannot be measured is omitted."""
    text = "".join(
        NUMBER.sub("1e308", line)
        if f"<{tag or 'robot'}" in line or (not tag and "<?" not in line)
        else line
        for line in source.read_text().splitlines(keepends=True)
    )
    (tmp_path / "r.urdf").write_text(text)
    done = new(tmp_path, tmp_path / "r.urdf")
    assert done.returncode == 0, done.stderr
    assert run(("rubric", "check", tmp_path / "lab.toml")).returncode == 0


def megabyte(item: str, before: str = "", after: str = "") -> str:
    """Return a robot with nearly 1 MiB of elements, each with its number in the place of {}."""
    head, tail = f'<robot name="r"><link name="base"/>{before}', f"{after}</robot>"
    count = (URDF_LIMIT - len(head + tail) - 10) // (len(item) + 8)
    return head + "".join(item.replace("{}", str(number)) for number in range(count)) + tail


@pytest.mark.slow
@pytest.mark.parametrize(
    "item",
    [
        '<link name="l{}"/><joint name="j{}" type="continuous"><parent link="base"/><child link="l{}"/></joint>',
        '<gazebo reference="base"><x{}>1</x{}></gazebo>',
        '<gazebo reference="base"/>',
    ],
)
def test_a_robot_with_too_many_facts_is_refused(item: str, tmp_path: Path) -> None:
    """It is refused before anything is tried on it, and nothing is written."""
    (tmp_path / "r.urdf").write_text(megabyte(item))
    done = new(tmp_path, tmp_path / "r.urdf")
    assert (done.returncode, done.stdout, done.stderr.count(b"\n")) == (2, b"", 1)
    assert b"more than 2000 facts" in done.stderr
    assert not (tmp_path / "lab.toml").exists()


SHAPE = '<{0}><geometry><box size="1 1 {{}}1"/></geometry></{0}>'


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tag", "item", "omitted"),
    [
        ("link", SHAPE.format("visual"), "x visuals: it has more than 50"),
        ("link", SHAPE.format("collision"), "x collisions: it has more than 50"),
        ("gazebo", "<y{}>1</y{}>", "gazebo x: it has more than 500 elements and attributes"),
        ("gazebo", '<y a{}="1"/>', "gazebo x: it has more than 500 elements and attributes"),
    ],
)
def test_an_element_with_too_much_in_it_is_omitted(
    tag: str, item: str, omitted: str, tmp_path: Path
) -> None:
    """What is compared each with each is bounded; the rest of the robot is tested."""
    joint = (
        '<joint name="j" type="fixed"><parent link="base"/><child link="x"/></joint>'
        if tag == "link"
        else ""
    )
    (tmp_path / "r.urdf").write_text(megabyte(item, f'{joint}<{tag} name="x">', f"</{tag}>"))
    done = new(tmp_path, tmp_path / "r.urdf")
    assert (done.returncode, f"omitted: {omitted}" in done.stdout.decode()) == (0, True), (
        done.stdout
    )


def test_a_rubric_that_is_too_large_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The loader reads rubrics up to a size, so no larger one is written."""
    monkeypatch.setattr("grader.app.commands.rubric_making.URDF_LIMIT", 1000)
    done = new(tmp_path, ARM)
    assert (done.returncode, b"too many facts for a rubric" in done.stderr) == (2, True)
    assert not (tmp_path / "lab.toml").exists()


def write_cart(folder: Path, *edits: Edit) -> Path:
    """Write the workspace of the cart with edits, and return its folder."""
    for path, text in edited(*edits).items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        _ = (folder / path).write_text(text)
    return folder


@pytest.fixture(scope="module")
def of_cart(tmp_path_factory: pytest.TempPathFactory) -> Rubric:
    """Return the draft of the workspace of the cart."""
    folder = tmp_path_factory.mktemp("cart")
    assert new(folder, write_cart(folder / "src")).returncode == 0
    return load_rubric(str(folder / "lab.toml"))


# All that is asked of an element is lost without it; an integer is also another distance than that of the wheels.
_OF_TWO = ("has no <ros2_control>", "'wheel_separation' is given an integer")
ONCE = {
    message: edits for _, message, edits in WRONG if not any(part in message for part in _OF_TWO)
}


@pytest.mark.slow
@pytest.mark.parametrize("edits", ONCE.values(), ids=ONCE)
def test_a_mistake_of_names_costs_once(edits: list[Edit], of_cart: Rubric, tmp_path: Path) -> None:
    """What else fails because of it, such as a node that does not start, is carried from it."""
    report = grade(of_cart, open_submission(str(write_cart(tmp_path, *edits)), of_cart.lab))
    assert [it.criterion.check.name for it in report.results if it.is_lost] == ["names_agree"]


def test_values_of_parameters_are_comments_that_may_become_criteria(of_cart: Rubric) -> None:
    """A rubric in which all of them are criteria is right; they have no points yet."""
    text = of_cart.path.read_text()
    before, marked, values = text.partition("# --- Other values")
    line, _, values = values.partition("\n")
    changed = of_cart.path.with_name("values.toml")
    _ = changed.write_text(f"{before}{marked}{line}\n{re.sub('(?m)^# ', '', values)}")
    done = run(("rubric", "check", changed))
    more = values.count("# [[criterion]]")
    # Seven parameters, what a lab of programs leaves free, and a launch file in another one.
    assert more == 14
    assert (
        f"{len(of_cart.criteria) + more} criteria, {of_cart.points} points, no mistakes found"
        in done.stdout.decode()
    ), done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("family", dict.fromkeys(family for family, _, _ in WRONG))
def test_what_is_odd_in_the_names_of_a_reference_is_said_in_one_line(
    family: str, tmp_path: Path
) -> None:
    """Its family is no criterion, and the other families are."""
    edits = next(edits for one, _, edits in WRONG if one == family)
    lines = new(tmp_path, write_cart(tmp_path / "src", *edits)).stdout.decode().splitlines()
    assert (
        len(
            [
                line
                for line in lines
                if re.match(rf"omitted: {family} names_agree: .*1.*: \S+:\d+: ", line)
            ]
        )
        == 1
    )
    rubric = load_rubric(str(tmp_path / "lab.toml"))
    names = [row.arguments["of"] for row in rubric.criteria if row.check.name == "names_agree"]
    asked = [str(name) for name in names]
    assert family not in asked
    assert f'# id = "{family}-names-agree"' in rubric.path.read_text()
    # The numbers of a joint that does not exist are not compared.
    assert {*asked, family, "values"} == agreement_of(cart_files()).families & {*FAMILIES}


DIFFDRIVE = ROOT / "rubrics/diffdrive/diffdrive_robot"
SAMPLES = sorted(path.name for path in (ROOT / "submissions/diffdrive").iterdir() if path.is_dir())
LAUNCH, URDF = "launch/diffdrive.launch.py", "urdf/diffdrive.urdf.xacro"
# A robot with elements that depend on an argument, and which costs nothing where another mistake is.
SIMULATED: list[Edit] = [
    (URDF, '"use_mock_hardware" default="true"', '"use_mock_hardware" default="false"'),
    (
        URDF,
        "</robot>",
        '<xacro:if value="$(arg use_mock_hardware)"><gazebo><static>true</static></gazebo></xacro:if></robot>',
    ),
]
CAUSES = {
    "an argument": ((LAUNCH, '" use_mock_hardware:="', '" mock_hardware:="'), {"names_agree"}),
    "the robot": (
        (URDF, 'radius="${wheel_radius}"', 'radius="0.07"'),
        {"shows_cylinder", "inertia_plausible"},
    ),
}


def write_diffdrive(folder: Path, *edits: Edit) -> Path:
    """Write the differential drive with edits of all places of a text, and return its folder."""
    package = shutil.copytree(DIFFDRIVE, folder / "diffdrive_robot")
    for path, old, new_text in edits:
        text = (package / path).read_text()
        assert old in text
        _ = (package / path).write_text(text.replace(old, new_text))
    return package


@pytest.fixture(scope="module")
def of_diffdrive(tmp_path_factory: pytest.TempPathFactory) -> Rubric:
    """Return the draft of the differential drive, whose elements depend on an argument."""
    folder = tmp_path_factory.mktemp("diffdrive")
    assert new(folder, write_diffdrive(folder, *SIMULATED)).returncode == 0
    return load_rubric(str(folder / "lab.toml"))


@pytest.mark.slow
@pytest.mark.parametrize(("edit", "lost"), CAUSES.values(), ids=CAUSES)
def test_a_mistake_costs_where_it_is(
    edit: Edit, lost: set[str], of_diffdrive: Rubric, tmp_path: Path
) -> None:
    """Elements that an argument of xacro changes cost nothing more, nor what is compared with a wrong robot."""
    package = write_diffdrive(tmp_path, *SIMULATED, edit)
    report = grade(of_diffdrive, open_submission(str(package), of_diffdrive.lab))
    assert {it.criterion.check.name for it in report.results if it.is_lost} == lost


def rename_joints(package: Path) -> None:
    """Give the joints of the wheels other names, wherever they are used."""
    for path in package.rglob("*.*"):
        if "_wheel_joint" in (text := path.read_text()):
            _ = path.write_text(text.replace("_wheel_joint", "_drive"))


@pytest.mark.slow
def test_joints_may_have_other_names_where_all_files_use_them(
    of_diffdrive: Rubric, tmp_path: Path
) -> None:
    """What controllers name is compared with the robot, so a draft asks for no names of joints."""
    package = write_diffdrive(tmp_path, *SIMULATED)
    rename_joints(package)
    report = grade(of_diffdrive, open_submission(str(package), of_diffdrive.lab))
    assert (report.score, [it for it in report.results if it.is_lost]) == (report.max_score, [])


# What is added to the reference, and how it is wrong.
NAMED: dict[str, tuple[str, str, str]] = {
    "a joint without a state": (
        "",
        '<command_interface name="velocity"/>\n        <state_interface name="position"/>\n        <state_interface name="velocity"/>\n      </joint>\n      <joint',
        '<command_interface name="velocity"/>\n        <state_interface name="position"/>\n      </joint>\n      <joint',
    ),
    "which joint is left": (
        "<gazebo><plugin><left_joint>left_wheel_joint</left_joint><right_joint>right_wheel_joint</right_joint></plugin></gazebo>",
        "<left_joint>left_wheel_joint",
        "<left_joint>right_wheel_joint",
    ),
    "a joint of a transmission": (
        '<transmission name="left"><joint name="left_wheel_joint"/></transmission>',
        '<transmission name="left"><joint name="left_wheel_joint"',
        '<transmission name="left"><joint name="port_shaft"',
    ),
}


@pytest.mark.slow
@pytest.mark.parametrize(("added", "old", "wrong"), NAMED.values(), ids=NAMED)
def test_joints_are_asked_for_by_their_links(
    added: str, old: str, wrong: str, tmp_path: Path
) -> None:
    """So each has its interfaces, and is the one that is meant, whatever its name."""
    system = "urdf/diffdrive.ros2_control.xacro"
    edits: list[Edit] = [(URDF, "</robot>", f"{added}</robot>")]
    assert new(tmp_path, write_diffdrive(tmp_path, *edits)).returncode == 0
    rubric = load_rubric(str(tmp_path / "lab.toml"))
    package = write_diffdrive(tmp_path / "wrong", *edits, (URDF if added else system, old, wrong))
    report = grade(rubric, open_submission(str(package), rubric.lab))
    assert [it.criterion.check.name for it in report.results if it.is_lost] == ["entry_is"]
    package = write_diffdrive(tmp_path / "other", *edits)
    rename_joints(package)
    report = grade(rubric, open_submission(str(package), rubric.lab))
    assert [it.outcome.message for it in report.results if it.is_lost] == []


@pytest.mark.slow
def test_plugins_that_are_alike_may_be_in_several_elements(tmp_path: Path) -> None:
    """Gazebo collects them from all <gazebo> elements."""
    plugins = [
        f'<plugin filename="p"><joint_name>{side}_wheel_joint</joint_name></plugin>'
        for side in ("left", "right")
    ]
    one = f"<gazebo>{''.join(plugins)}</gazebo></robot>"
    assert new(tmp_path, write_diffdrive(tmp_path, (URDF, "</robot>", one))).returncode == 0
    rubric = load_rubric(str(tmp_path / "lab.toml"))
    for name, texts, lost in (("several", plugins, 0), ("left only", plugins[:1], 1)):
        apart = "".join(f"<gazebo>{it}</gazebo>" for it in texts)
        package = write_diffdrive(tmp_path / name, (URDF, "</robot>", f"{apart}</robot>"))
        report = grade(rubric, open_submission(str(package), rubric.lab))
        assert [it.criterion.check.name for it in report.results if it.is_lost] == [
            "entry_is"
        ] * lost


@pytest.mark.slow
def test_lists_with_names_of_joints_that_are_compared_are_not_asked_for(tmp_path: Path) -> None:
    """Such as the joints whose positions Gazebo publishes, and the joint that another one follows."""
    publisher = "".join(
        f"<joint_name>{side}_wheel_joint</joint_name>" for side in ("left", "right")
    )
    mimic = '<param name="mimic">left_wheel_joint</param><param name="multiplier">1</param><state_interface'
    edits: list[Edit] = [
        (URDF, "</robot>", f"<gazebo><plugin>{publisher}</plugin></gazebo></robot>"),
        ("urdf/diffdrive.ros2_control.xacro", "<state_interface", mimic),
    ]
    assert new(tmp_path, write_diffdrive(tmp_path, *edits)).returncode == 0
    rubric = load_rubric(str(tmp_path / "lab.toml"))
    package = write_diffdrive(tmp_path / "other", *edits)
    rename_joints(package)
    report = grade(rubric, open_submission(str(package), rubric.lab))
    assert [it.outcome.message for it in report.results if it.is_lost] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in SAMPLES if not name.startswith("equivalent")])
def test_the_mistake_of_a_sample_costs_once(name: str, of_diffdrive: Rubric) -> None:
    """Whatever else of the differential drive fails because of it."""
    report = grade(
        of_diffdrive, open_submission(str(ROOT / "submissions/diffdrive" / name), of_diffdrive.lab)
    )
    lost = [
        it.criterion for it in report.results if it.is_lost and it.criterion.about != "<gazebo>"
    ]
    assert len(lost) == 1, lost


@pytest.mark.slow
def test_more_values_of_a_node_are_counted(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a comment that stays one if all lines become criteria."""
    monkeypatch.setattr("grader.lab.authoring.draft._MAX_VALUES", 1)
    assert new(tmp_path, write_diffdrive(tmp_path)).returncode == 0
    text = (tmp_path / "lab.toml").read_text()
    assert "\n# # 1 more of drive_circle\n" in text
    assert text.count('\n# [[criterion]]\n# id = "drive-circle-') == 1


def points_by_check(rubric: Rubric) -> dict[str, set[int]]:
    """Return the points of the criteria of each check."""
    points: dict[str, set[int]] = {}
    for criterion in rubric.criteria:
        if criterion.check.name != "joint_limits" or "lower" in criterion.arguments:
            points.setdefault(criterion.check.name, set()).add(int(criterion.points))
    return points


def test_one_of_many_costs_something_and_one_of_few_not_too_much(of_cart: Rubric) -> None:
    """A criterion has at least half the mean of points, and at most twice; one of few has more."""
    mean = of_cart.points / len(of_cart.criteria)
    points = [criterion.points for criterion in of_cart.criteria]
    assert min(points) >= mean / 2
    assert max(points) <= 2 * mean + 1
    launches = [each.points for each in of_cart.criteria if each.check.name == "launch_complete"]
    names = [each.points for each in of_cart.criteria if each.check.name == "names_agree"]
    assert len(launches) < len(names)
    assert min(launches) >= min(names)


@pytest.mark.parametrize("total", [100, 10])
def test_a_draft_has_the_points_that_are_asked_for(total: int, tmp_path: Path) -> None:
    """With as many decimals as leave each criterion some."""
    assert new(tmp_path, ARM, "--total", str(total)).returncode == 0
    rubric = load_rubric(str(tmp_path / "lab.toml"))
    assert rubric.points == total
    assert min(row.points for row in rubric.criteria) > 0


def test_criteria_cannot_share_too_few_points(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A hundredth of a point is the least."""
    monkeypatch.setattr("grader.lab.authoring.draft._STEPS", (Decimal(1),))
    done = new(tmp_path, ARM, "--total", "3")
    assert done.returncode == 2
    assert b"criteria cannot share 3 points: give more" in done.stderr


@pytest.mark.slow
def test_frames_axes_and_limits_weigh_more_than_colours_and_masses(tmp_path: Path) -> None:
    """In the draft of a robot, unless all weights are equal."""
    assert new(tmp_path, ARM).returncode == 0
    points = points_by_check(load_rubric(str(tmp_path / "lab.toml")))
    for heavy in ("frame_at", "joint_axis", "joint_limits"):
        for light in ("shows_colour", "mass_is", "inertia_plausible"):
            assert min(points[heavy]) > max(points[light])
    done = run(
        ("rubric", "new", tmp_path / "equal.toml", "--from", ARM, "--weights", "equal"),
    )
    assert done.returncode == 0
    of_equal = points_by_check(load_rubric(str(tmp_path / "equal.toml")))
    assert set().union(*of_equal.values()) == {1}


def test_titles_have_at_most_a_hundred_characters_and_differ(of_cart: Rubric) -> None:
    """So a list of them says which joint is meant."""
    titles = [criterion.title for criterion in of_cart.criteria]
    assert max(map(len, titles)) <= 100
    assert not any("expected values" in title for title in titles)


KINDS = {
    "colours,masses": {"shows_colour", "mass_is"},
    "inertia": {"inertia_plausible"},
    "shapes": {"shows_box", "shows_cylinder", "shows_mesh", "centre_at"},
}


@pytest.mark.slow
@pytest.mark.parametrize(("kinds", "checks"), KINDS.items(), ids=KINDS)
def test_kinds_of_criteria_can_be_omitted(kinds: str, checks: set[str], tmp_path: Path) -> None:
    """The others stay."""
    assert new(tmp_path, ARM).returncode == 0
    before = {it.check.name for it in load_rubric(str(tmp_path / "lab.toml")).criteria}
    file = tmp_path / "fewer.toml"
    assert run(("rubric", "new", file, "--from", ARM, "--without", kinds)).returncode == 0
    after = {it.check.name for it in load_rubric(str(file)).criteria}
    assert (before - after, after - before) == (before & checks, set())
    assert before & checks


@pytest.mark.slow
def test_only_names_may_be_asked_for(tmp_path: Path) -> None:
    """With what they need: packages that build, and a robot that ROS 2 loads."""
    folder = write_cart(tmp_path / "src")
    file = tmp_path / "names.toml"
    assert run(("rubric", "new", file, "--from", folder, "--names-only")).returncode == 0
    checks = {criterion.check.name for criterion in load_rubric(str(file)).criteria}
    assert checks >= {"names_agree", "urdf_loads", "setup_imports"}
    assert not checks & {"shows_box", "frame_at", "entry_is", "parameter_is", "node_runs"}
    assert "parameter_is" not in file.read_text()


def test_a_value_that_a_node_has_anyway_is_asked_for_as_its_default(tmp_path: Path) -> None:
    """A submission that leaves it out passes, and one that leaves out another value does not."""
    shutil.copytree(LAB6, tmp_path / "my_robot")
    launch = tmp_path / "my_robot/launch/my_robot_rviz.launch.py"
    values = "{'publish_frequency': 20.0, 'ignore_timestamp': True}"
    launch.write_text(launch.read_text().replace("parameters=[", f"parameters=[{values}, "))
    assert new(tmp_path, tmp_path / "my_robot").returncode == 0
    text = (tmp_path / "lab.toml").read_text()
    written = re.findall(r"# with = .*(?:publish_frequency|ignore_timestamp).*", text)
    assert ["or_default = true" in line for line in written] == [True, False]


def test_a_free_link_is_named_by_its_place(tmp_path: Path) -> None:
    """A robot in which it has another name keeps all points."""
    file = tmp_path / "lab.toml"
    robot = """<robot name="r"><link name="torso"/><link name="arm"/>
<joint name="j" type="revolute"><parent link="torso"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="1" velocity="1"/></joint></robot>"""
    (tmp_path / "robot.urdf").write_text(robot)
    (tmp_path / "other.urdf").write_text(robot.replace("torso", "base").replace("arm", "boom"))
    done = run(
        (
            "rubric",
            "new",
            file,
            "--from",
            tmp_path / "robot.urdf",
            "--free",
            "torso",
            "--free",
            "arm",
        ),
    )
    assert done.returncode == 0, done.stderr
    assert run(("grade", tmp_path / "other.urdf", "--rubric", file)).returncode == 0
    (tmp_path / "other.urdf").write_text(robot.replace('axis xyz="0 0 1"', 'axis xyz="0 1 0"'))
    assert run(("grade", tmp_path / "other.urdf", "--rubric", file)).returncode == 1


MIMIC = """<robot name="r"><link name="palm"/><link name="left"/><link name="right"/>
<joint name="l" type="prismatic"><parent link="palm"/><child link="left"/><axis xyz="0 1 0"/>
<limit lower="0" upper="0.04" effort="1" velocity="1"/></joint>
<joint name="r" type="prismatic"><parent link="palm"/><child link="right"/><axis xyz="0 1 0"/>
<limit lower="-0.04" upper="0" effort="1" velocity="1"/><mimic joint="l" multiplier="-1"/></joint></robot>"""


def test_a_joint_that_follows_is_measured_by_its_motion(tmp_path: Path) -> None:
    """The opposite axis with the opposite multiplier and limits is equal; one of these alone is not."""
    (tmp_path / "robot.urdf").write_text(MIMIC)
    assert new(tmp_path, tmp_path / "robot.urdf").returncode == 0
    lab, file = tmp_path / "lab.toml", tmp_path / "other.urdf"
    text = lab.read_text()
    assert "2 moving joints: 1 prismatic and 1 prismatic that follows another joint" in text
    start = MIMIC.index('<joint name="r"')
    turned = MIMIC[:start] + MIMIC[start:].replace('"0 1 0"', '"0 -1 0"').replace(
        'multiplier="-1"', 'multiplier="1"'
    )
    file.write_text(turned.replace('lower="-0.04" upper="0"', 'lower="0" upper="0.04"'))
    done = run(("grade", file, "--rubric", lab))
    assert done.returncode == 0, done.stdout
    file.write_text(turned)
    assert run(("grade", file, "--rubric", lab)).returncode == 1
    file.write_text(MIMIC.replace('multiplier="-1"', 'multiplier="1"'))
    assert run(("grade", file, "--rubric", lab)).returncode == 1


def test_names_that_ros_2_does_not_care_about_are_free(
    of_diffdrive: Rubric, tmp_path: Path
) -> None:
    """Those of <ros2_control> and of launch files."""
    system = "urdf/diffdrive.ros2_control.xacro"
    text = (DIFFDRIVE / system).read_text()
    [name] = re.findall('<ros2_control name="([^"]*)"', text)
    edit: Edit = (system, f'<ros2_control name="{name}"', '<ros2_control name="the_wheels"')
    package = write_diffdrive(tmp_path, *SIMULATED, edit)
    (package / LAUNCH).rename(package / LAUNCH.replace("diffdrive", "go"))
    report = grade(of_diffdrive, open_submission(str(package), of_diffdrive.lab))
    assert [it.criterion.id for it in report.results if it.is_lost] == []


def test_a_misspelt_executable_of_a_known_package_is_found(
    of_diffdrive: Rubric, tmp_path: Path
) -> None:
    """Though the solution has no program of its own."""
    edit: Edit = (LAUNCH, 'executable="spawner"', 'executable="spaner"')
    report = grade(
        of_diffdrive,
        open_submission(str(write_diffdrive(tmp_path, *SIMULATED, edit)), of_diffdrive.lab),
    )
    assert "programs-names-agree" in [it.criterion.id for it in report.results if it.is_lost]


def test_a_parameter_that_names_joints_is_a_criterion(of_cart: Rubric) -> None:
    """By the links that they hold, in any order."""
    text = of_cart.path.read_text().partition("# --- Other values")[0]
    assert 'has = ["@joint:' in text


def test_criteria_may_be_deleted(of_cart: Rubric) -> None:
    """What is carried from one that is not there is ignored, and one note says so."""
    blocks = of_cart.path.read_text().split("\n[[criterion]]\n")
    kept = [it for it in blocks if not it.startswith('id = "files-names-agree"')]
    assert len(kept) == len(blocks) - 1
    changed = of_cart.path.with_name("deleted.toml")
    lines = "\n[[criterion]]\n".join(kept).splitlines(keepends=True)
    changed.write_text("".join(it for it in lines if not re.match(r"points = \d\d", it)))
    done = run(("rubric", "check", changed))
    assert done.returncode == 0, done.stderr
    assert done.stderr.decode().count("files-names-agree") == 1


@pytest.mark.slow
def test_all_mistakes_are_reported_at_once(tmp_path: Path) -> None:
    """Those in the file, and what the reference does not pass of the other criteria."""
    assert new(tmp_path, ARM).returncode == 0
    text = (tmp_path / "lab.toml").read_text()
    wrong = re.sub(r"mass = [\d.]+", "mass = 77.0", text, count=1).replace(
        'check = "frame_at"', 'check = "frame_att"'
    )
    (tmp_path / "lab.toml").write_text(re.sub(r"(?m)^points = \d\d+$", "points = 1", wrong))
    done = run(("rubric", "check", tmp_path / "lab.toml"))
    lines = done.stderr.decode()
    assert done.returncode == 2
    assert "there is no check 'frame_att'" in lines
    assert "it should be 77 kg" in lines
