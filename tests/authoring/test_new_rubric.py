"""`grader rubric new`: the facts that it finds on a reference, what it omits, what it calls odd, and what it refuses."""

import json
import re
import shutil
import tomllib
import xml.etree.ElementTree as ET
from pathlib import Path
from typing import Any

import pytest
from jsonschema import validate

from grader.files.reading import URDF_LIMIT
from tests.command_line import ROOT, Done, run

ARM = Path(__file__).parent / "arm.urdf"
LAB6 = ROOT / "rubrics" / "lab6" / "my_robot"


def new(file: Path, reference: Path, *options: str) -> str:
    """Write a rubric and return what the command prints."""
    done = run(("rubric", "new", file, "--from", reference, *options))
    assert (done.returncode, done.stderr) == (0, b""), done.stderr
    return done.stdout.decode()


def rubric_of(urdf: str, folder: Path) -> tuple[dict[str, Any], str]:
    """Return the new rubric of a URDF, and what the command prints."""
    (folder / "robot.urdf").write_text(urdf)
    printed = new(folder / "lab.toml", folder / "robot.urdf")
    return tomllib.loads((folder / "lab.toml").read_text()), printed


def robot(*parts: str) -> str:
    """Return a URDF with a base that is a box, and other parts."""
    base = '<visual><geometry><box size="1 1 1"/></geometry><material name="red"><color rgba="1 0 0 1"/></material></visual>'
    return f'<robot name="birch"><link name="base">{base}</link>{"".join(parts)}</robot>'


def joint(kind: str, child: str = "tool", inside: str = "") -> str:
    """Return a link below the base and its joint."""
    ends = f'<parent link="base"/><child link="{child}"/>'
    return f'<link name="{child}"/><joint name="{child}_joint" type="{kind}">{ends}{inside}</joint>'


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """Return the new rubric of the arm, and what the command printed."""
    folder = tmp_path_factory.mktemp("arm")
    reference = Path(shutil.copy(ARM, folder))
    return folder / "cedar_arm.toml", new(folder / "cedar_arm.toml", reference)


@pytest.fixture(scope="module")
def criteria(written: tuple[Path, str]) -> dict[str, dict[str, Any]]:
    """Return the criteria of the arm's rubric by their ids."""
    return {row["id"]: row for row in tomllib.loads(written[0].read_text())["criterion"]}


FACTS = {
    "urdf-loads": ("urdf_loads", {}),
    "base-link-box": ("shows_box", {"link": "base_link", "size": [0.3, 0.2, 0.1]}),
    "base-link-place": ("centre_at", {"link": "base_link", "relative_to": "base_link", "xyz": [0, 0, 0.05]}),
    "base-link-colour": ("shows_colour", {"link": "base_link", "colour": [0.6, 0.6, 0.65, 1]}),
    "base-link-mass": ("mass_is", {"link": "base_link", "mass": 6}),
    "base-link-inertia": ("inertia_plausible", {"link": "base_link"}),
    "turret-joint": ("held_by", {"link": "turret", "parent": "base_link", "joint_type": "continuous"}),
    "turret-frame": ("frame_at", {"link": "turret", "relative_to": "base_link", "xyz": [0, 0, 0.1]}),
    "turret-axis": ("joint_axis", {"link": "turret", "relative_to": "base_link", "direction": [0, 0, 1]}),
    "turret-dynamics": ("joint_dynamics", {"link": "turret", "friction": 0.05, "damping": 0.2}),
    "turret-cylinder": ("shows_cylinder", {"link": "turret", "radius": 0.06, "length": 0.1}),
    "upper-arm-frame": (
        "frame_at",
        {"link": "upper_arm", "relative_to": "turret", "xyz": [0, 0, 0.13], "rpy": [0, -0.7854, 0]},
    ),
    "upper-arm-limits": (
        "joint_limits",
        {"link": "upper_arm", "lower": -45, "upper": 90, "effort": 30, "velocity": 1.5},
    ),
    "upper-arm-place": (
        "centre_at",
        {"link": "upper_arm", "relative_to": "upper_arm", "xyz": [0.15, 0, 0], "axis": [1, 0, 0], "angle": 1},
    ),
    "slider-limits": (
        "joint_limits",
        {"link": "slider", "lower": 0, "upper": 0.12, "effort": 50, "velocity": 0.2, "tolerance": 0.002},
    ),
    "right-finger-mimic": (
        "mimics",
        {"link": "right_finger", "leader": "left_finger", "multiplier": 1, "offset": 0},
    ),
    "camera-link-joint": ("held_by", {"link": "camera_link", "parent": "upper_arm", "joint_type": "fixed"}),
    "base-link-collision": ("collision_matches_visual", {"link": "base_link"}),
    "left-finger-mesh": (
        "shows_mesh",
        {
            "link": "left_finger",
            "file": "cedar_arm/meshes/finger.stl",
            "scale": [0.001, 0.001, 0.001],
            "xyz": [0, 0, 0],
            "rpy": [0, 0, 0],
        },
    ),
    "motion": (
        "kinematics_match_reference",
        {"links": ["left_finger", "right_finger", "camera_link"], "match": "order"},
    ),
    "gazebo-base-link": (
        "element_present",
        {
            "tag": "gazebo",
            "attributes": {"reference": "base_link"},
            "values": {"mu1": 0.9, "mu2": 0.9, "material": "Gazebo/Grey"},
        },
    ),
    "ros2-control-arm-system-joint-joint-2": (
        "element_present",
        {
            "tag": "ros2_control",
            "attributes": {"name": "arm_system", "type": "system"},
            "path": "joint",
            "values": {
                "@name": "joint_2",
                "command_interface/@name": "position",
                "command_interface/param": [-0.7854, 1.5708],
                "command_interface/param/@name": ["min", "max"],
                "state_interface/@name": "position",
            },
        },
    ),
    "transmission-joint-1-transmission-actuator-joint-1-motor": (
        "element_present",
        {
            "tag": "transmission",
            "attributes": {"name": "joint_1_transmission"},
            "path": "actuator",
            "values": {"@name": "joint_1_motor", "mechanicalReduction": 50},
        },
    ),
    "root": ("root_of_tree", {"link": "base_link", "holds": "base_link"}),
    "joint-counts": ("counts", {"moving": 4, "revolute": 1, "continuous": 1, "prismatic": 3}),
    "joint-names": (
        "joints_named",
        {"parent": "base_link", "joints": {"joint_1": "turret", "joint_2": "upper_arm"}},
    ),
}


@pytest.mark.parametrize("name", FACTS)
def test_each_fact_of_the_reference_is_a_criterion(name: str, criteria: dict[str, dict[str, Any]]) -> None:
    """A fact has a stable id, the check that tells it, and its numbers."""
    row = criteria[name]
    assert (row["check"], row.get("with", {})) == FACTS[name]


def test_titles_say_the_expected_fact(criteria: dict[str, dict[str, Any]]) -> None:
    """A title has the names, the numbers and their units."""
    titles = {name: row["title"] for name, row in criteria.items()}
    assert titles["base-link-box"] == "base_link shows a box 0.3 x 0.2 x 0.1 m"
    assert titles["upper-arm-frame"] == "The frame upper_arm is at 0 0 0.13 m in turret, turned by rpy 0 -45 0 degrees"
    limits = "The joint of upper_arm turns from -45 to 90 degrees, effort 30 N m, velocity 1.5 rad/s"
    assert titles["upper-arm-limits"] == limits
    camera = (
        "<gazebo> of camera_link has <sensor> with name camera, type camera, update_rate 30, always_on true and 6 more"
    )
    assert titles["gazebo-camera-link-sensor-camera"] == camera
    assert titles["turret-mass"] == "The mass of turret is 1.2 kg"


def test_the_rubric_is_complete(written: tuple[Path, str]) -> None:
    """It names the reference, has the totals of its points, one point for each criterion, and the tolerances once."""
    rubric = tomllib.loads(written[0].read_text())
    count = len(rubric["criterion"])
    assert (rubric["id"], rubric["title"]) == ("cedar-arm", "Cedar arm")
    assert (rubric["reference"], rubric["urdf"]) == ("arm.urdf", "arm.urdf")
    assert (rubric["points"], rubric["part"][0]["points"]) == (count, count)
    assert rubric["defaults"]["points"] == 1
    assert rubric["defaults"]["with"]["frame_at"] == {"tolerance": 0.002, "angle": 1.0}
    assert rubric["defaults"]["with"]["shows_colour"] == {"tolerance": 0.01}
    assert [row["about"] for row in rubric["criterion"]][:2] == ["The file", "base_link"]
    done = run(("rubric", "check", written[0]))
    assert done.stdout.decode().endswith("its reference gets full marks\n")


def test_the_text_is_laid_out_for_people(written: tuple[Path, str]) -> None:
    """Headings, short numbers, comments in one column, only titles longer than 120 columns."""
    text = written[0].read_text()
    assert "# --- upper_arm ---" in text
    assert not re.search(r"\d{8}", text)
    head = text.splitlines()[2:4]
    assert len({line.index("  # ") for line in head}) == 1
    assert all(len(line) <= 120 for line in text.splitlines() if not line.startswith("title"))


def test_it_says_what_it_wrote_and_what_to_do_next(written: tuple[Path, str]) -> None:
    """The first line counts criteria, the last is the command that tests the rubric."""
    file, printed = written
    first, *_, last = printed.splitlines()
    assert re.fullmatch(
        r"wrote .*cedar_arm.toml: Cedar arm \(\d+ criteria, \d+ points\); its reference gets full marks", first
    )
    assert last == f"next: grader rubric test {file}"


def test_the_same_reference_gives_the_same_bytes(written: tuple[Path, str], tmp_path: Path) -> None:
    """Nothing depends on the moment or the place."""
    shutil.copy(ARM, tmp_path)
    new(tmp_path / "cedar_arm.toml", tmp_path / "arm.urdf")
    assert (tmp_path / "cedar_arm.toml").read_bytes() == written[0].read_bytes()


@pytest.mark.exhaustive
def test_every_mutant_of_the_reference_loses_something(written: tuple[Path, str]) -> None:
    """`grader rubric test` finds no survivor, no idle criterion, and no equivalent that loses points."""
    done = run(("rubric", "test", written[0], "--fail-under", "100%", "--format", "json"))
    result = json.loads(done.stdout)
    assert (done.returncode, result["survivors"], result["idle"], result["equivalents"]["lost"]) == (0, [], [], [])


def test_a_schema_beside_the_rubric_is_named(tmp_path: Path) -> None:
    """An editor then completes and validates the new rubric at once."""
    schema = run(("schema", "rubric")).stdout
    (tmp_path / "rubric.schema.json").write_bytes(schema)
    rubric, _ = rubric_of(ARM.read_text(), tmp_path)
    assert (tmp_path / "lab.toml").read_text().startswith("#:schema ./rubric.schema.json\nid = ")
    validate(rubric, json.loads(schema))


def test_the_order_of_elements_does_not_matter(written: tuple[Path, str], tmp_path: Path) -> None:
    """A robot that is written from its last element to its first has all points."""
    robot = ET.fromstring(ARM.read_text())
    for element in (robot, *robot.iter("link")):
        element[:] = reversed(element)
    (tmp_path / "reversed.urdf").write_bytes(ET.tostring(robot))
    assert run(("grade", tmp_path / "reversed.urdf", "--rubric", written[0])).returncode == 0


# --- Where the rubric and its reference are ---------------------------------------------------------------------------


def test_an_existing_file_is_not_overwritten(tmp_path: Path) -> None:
    """Only --force replaces a rubric that may have been edited."""
    file = tmp_path / "lab.toml"
    file.write_text("mine")
    done = run(("rubric", "new", file, "--from", ARM))
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr.decode().count("\n") == 1
    assert "exists already" in done.stderr.decode()
    assert file.read_text() == "mine"
    new(file, ARM, "--force")
    assert "[[criterion]]" in file.read_text()


def test_a_reference_elsewhere_is_named_by_a_relative_path(tmp_path: Path) -> None:
    """The rubric is usable at once, and the output says that both must be moved together."""
    (tmp_path / "rubrics").mkdir()
    shutil.copy(ARM, tmp_path)
    printed = new(tmp_path / "rubrics" / "lab.toml", tmp_path / "arm.urdf")
    assert 'reference = "../arm.urdf"' in (tmp_path / "rubrics" / "lab.toml").read_text()
    assert "note: the reference is ../arm.urdf, outside the rubric's folder: move both together" in printed


def test_a_package_is_graded_as_a_part(tmp_path: Path) -> None:
    """Of a package, its name, its launch and RViz files and what a build installs are criteria of a part of its own."""
    shutil.copytree(LAB6, tmp_path / "my_robot")
    new(tmp_path / "lab.toml", tmp_path / "my_robot")
    rubric = tomllib.loads((tmp_path / "lab.toml").read_text())
    assert (rubric["reference"], rubric["package"], rubric["urdf"]) == ("my_robot", "my_robot", "urdf/my_robot.urdf")
    assert [(part["id"], part["needs"]) for part in rubric["part"]] == [("robot", "urdf"), ("package", "package")]
    of_package = {row["check"]: row.get("with", {}) for row in rubric["criterion"] if row.get("part") == "package"}
    launch = "my_robot_rviz.launch.py"
    assert of_package["package_found"] == {"name": "my_robot"}
    assert of_package["package_type"] == {"build_type": "ament_python"}
    assert of_package["launch_found"] == {"name": launch}
    assert of_package["rviz_fixed_frame"] == {"name": "my_robot.rviz", "launch": launch, "frame": "base_footprint"}
    publisher = "joint_state_publisher_gui or joint_state_publisher"
    assert of_package["launch_starts"]["nodes"] == [publisher, "robot_state_publisher", "rviz2"]
    assert {"setup_imports", "build_installs", "launch_finds_files", "rviz_found", "rviz_shows_robot"} <= set(
        of_package
    )


@pytest.mark.parametrize("kind", ["workspace", "zip", "xacro"])
def test_a_reference_is_whatever_can_be_graded(kind: str, tmp_path: Path) -> None:
    """A workspace, an archive and a xacro file are references, too."""
    if kind == "xacro":
        reference = tmp_path / "arm.urdf.xacro"
        text = ARM.read_text().replace(
            'name="cedar_arm">', 'name="cedar_arm" xmlns:xacro="http://www.ros.org/wiki/xacro">'
        )
        reference.write_text(text.replace('size="0.3 ', 'size="${3 / 10} '))
    else:
        shutil.copytree(LAB6, tmp_path / "ws" / "src" / "my_robot")
        reference = tmp_path / "ws"
        if kind == "zip":
            reference = Path(shutil.make_archive(str(tmp_path / "work"), "zip", tmp_path / "ws"))
    new(tmp_path / "lab.toml", reference)
    rubric = tomllib.loads((tmp_path / "lab.toml").read_text())
    assert rubric["reference"] == reference.name
    assert rubric["urdf"] == ("arm.urdf.xacro" if kind == "xacro" else "urdf/my_robot.urdf")
    assert run(("grade", reference, "--rubric", tmp_path / "lab.toml")).returncode == 0


@pytest.mark.exhaustive
def test_mutants_of_a_package_lose_something_or_are_declared(tmp_path: Path) -> None:
    """What no check can test is declared in the rubric, with a reason and with patterns that match."""
    shutil.copytree(LAB6, tmp_path / "my_robot")
    new(tmp_path / "lab.toml", tmp_path / "my_robot")
    done = run(("rubric", "test", tmp_path / "lab.toml", "--fail-under", "100%", "--format", "json"))
    result = json.loads(done.stdout)
    assert (done.returncode, result["survivors"], result["unused_patterns"]) == (0, [], [])


def test_the_package_with_the_urdf_is_graded(tmp_path: Path) -> None:
    """Of several packages the one that holds the URDF is the rubric's; the others are said to be omitted."""
    for name in ("ash_bringup", "ash_description"):
        shutil.copytree(LAB6, tmp_path / "ws" / name)
        manifest = tmp_path / "ws" / name / "package.xml"
        manifest.write_text(manifest.read_text().replace("<name>my_robot", f"<name>{name}"))
    shutil.rmtree(tmp_path / "ws" / "ash_bringup" / "urdf")
    printed = new(tmp_path / "lab.toml", tmp_path / "ws")
    rubric = tomllib.loads((tmp_path / "lab.toml").read_text())
    assert (rubric["package"], rubric["urdf"]) == ("ash_description", "urdf/my_robot.urdf")
    assert "omitted: the package ash_bringup: a rubric is about one package" in printed


# --- References that are refused --------------------------------------------------------------------------------------

REFUSED = {
    "broken": ("<robot name='r'><link name='a'>", "is no reference solution"),
    "two roots": ("<robot name='r'><link name='a'/><link name='b'/></robot>", "is no reference solution"),
    "no link": ("<robot name='r'/>", "is no reference solution"),
    "empty": ("", "is no reference solution"),
    "xacro that depends on the machine": (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="$(env NAME)"/></robot>',
        "the environment variable NAME is known only at run time (see",
    ),
    "no robot": ("<sdf/>", "is no reference solution"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_a_reference_that_ros_rejects_is_refused(name: str, tmp_path: Path) -> None:
    """One line says why, nothing is written, and the exit code is 2."""
    text, reason = REFUSED[name]
    file = tmp_path / ("robot.xacro" if "xacro" in name else "robot.urdf")
    file.write_text(text)
    assert_refused(run(("rubric", "new", tmp_path / "lab.toml", "--from", file)), reason)
    assert not (tmp_path / "lab.toml").exists()


NUMBER = re.compile(r"""(?<=[" ])-?[\d.]+(?=[" ])""")
WHEELS = ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf"


@pytest.mark.parametrize(
    "tag", ["origin", "box", "cylinder", "sphere", "color", "axis", "limit", "mass", "inertia", ""]
)
@pytest.mark.parametrize("source", [ARM, WHEELS])
def test_huge_numbers_are_no_fault(source: Path, tag: str, tmp_path: Path) -> None:
    """A rubric is written, in which what cannot be measured is omitted, or one line says why not."""
    text = "".join(
        NUMBER.sub("1e308", line) if f"<{tag or 'robot'}" in line or (not tag and "<?" not in line) else line
        for line in source.read_text().splitlines(keepends=True)
    )
    (tmp_path / "r.urdf").write_text(text)
    done = run(("rubric", "new", tmp_path / "lab.toml", "--from", tmp_path / "r.urdf"))
    assert done.returncode == 0, done.stderr
    assert run(("rubric", "check", tmp_path / "lab.toml")).returncode == 0


def megabyte(item: str, before: str = "", after: str = "") -> str:
    """Return a robot with nearly 1 MiB of elements, each with its number in the place of {}."""
    head, tail = f'<robot name="r"><link name="base"/>{before}', f"{after}</robot>"
    count = (URDF_LIMIT - len(head + tail) - 10) // (len(item) + 8)
    return head + "".join(item.replace("{}", str(number)) for number in range(count)) + tail


LARGE = {
    "links": (
        '<link name="l{}"/><joint name="j{}" type="continuous"><parent link="base"/><child link="l{}"/></joint>',
        "more than 2000 facts",
    ),
    "elements for simulators": ('<gazebo reference="base"><x{}>1</x{}></gazebo>', "more than 2000 facts"),
    "equal elements for simulators": ('<gazebo reference="base"/>', "more than 2000 facts"),
}


@pytest.mark.parametrize("what", LARGE)
def test_a_robot_with_too_many_facts_is_refused(what: str, tmp_path: Path) -> None:
    """It is refused before anything is tried on it, and nothing is written."""
    item, reason = LARGE[what]
    (tmp_path / "r.urdf").write_text(megabyte(item))
    assert_refused(run(("rubric", "new", tmp_path / "lab.toml", "--from", tmp_path / "r.urdf")), reason)
    assert not (tmp_path / "lab.toml").exists()


@pytest.mark.parametrize(
    ("tag", "item", "omitted"),
    [
        (
            "link",
            '<visual><geometry><box size="1 1 {}1"/></geometry></visual>',
            "what x shows: it has more than 50 visuals",
        ),
        (
            "link",
            '<collision><geometry><box size="1 1 {}1"/></geometry></collision>',
            "how x collides: it has more than 50 collisions",
        ),
        ("gazebo", "<y{}>1</y{}>", "There is a <gazebo> of x: it has more than 500 elements and attributes"),
        ("gazebo", '<y a{}="1"/>', "There is a <gazebo> of x: it has more than 500 elements and attributes"),
    ],
)
def test_an_element_with_too_much_in_it_is_omitted(tag: str, item: str, omitted: str, tmp_path: Path) -> None:
    """What is compared each with each is bounded; the rest of the robot is tested."""
    joint = '<joint name="j" type="fixed"><parent link="base"/><child link="x"/></joint>' if tag == "link" else ""
    (tmp_path / "r.urdf").write_text(megabyte(item, f'{joint}<{tag} name="x">', f"</{tag}>"))
    done = run(("rubric", "new", tmp_path / "lab.toml", "--from", tmp_path / "r.urdf"))
    assert (done.returncode, f"omitted: {omitted}" in done.stdout.decode()) == (0, True), done.stdout


def test_a_rubric_that_is_too_large_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The loader reads rubrics up to a size, so no larger one is written."""
    monkeypatch.setattr("grader.usecases.rubric_making.URDF_LIMIT", 1000)
    assert_refused(run(("rubric", "new", tmp_path / "lab.toml", "--from", ARM)), "too many facts for a rubric")
    assert not (tmp_path / "lab.toml").exists()


def test_other_wrong_usage_is_refused(tmp_path: Path) -> None:
    """A missing reference, standard input, a folder without a URDF, another ending, a missing folder."""
    file = tmp_path / "lab.toml"
    assert_refused(run(("rubric", "new", file, "--from", tmp_path / "none.urdf")), "none.urdf")
    assert_refused(run(("rubric", "new", file, "--from", "-")), "--from takes a file or folder")
    (tmp_path / "notes").mkdir()
    (tmp_path / "notes" / "a.txt").write_text("no robot")
    assert_refused(run(("rubric", "new", file, "--from", tmp_path / "notes")), "has no URDF")
    assert_refused(run(("rubric", "new", tmp_path / "lab.txt", "--from", ARM)), "ends in .toml")
    assert_refused(run(("rubric", "new", tmp_path / "none" / "lab.toml", "--from", ARM)), "there is no folder ")


def assert_refused(done: Done, reason: str) -> None:
    """Assert that a command wrote one line to standard error, and exited with 2."""
    assert (done.returncode, done.stdout) == (2, b"")
    lines = done.stderr.decode().splitlines()
    assert len(lines) == 1
    assert reason in lines[0]


# --- What is omitted, and what is odd ---------------------------------------------------------------------------------


def body(name: str, inertia: float = 0.0107, mass: float = 1) -> str:
    """Return a link below the base with a box, an inertia and no colour."""
    shape = '<geometry><box size="0.2 0.3 0.2"/></geometry>'
    tensor = f'<inertia ixx="{inertia}" ixy="0" ixz="0" iyy="0.00667" iyz="0" izz="0.0108"/>'
    inside = f'<visual>{shape}</visual><inertial><mass value="{mass}"/>{tensor}</inertial>'
    return joint("fixed", name).replace(f'<link name="{name}"/>', f'<link name="{name}">{inside}</link>')


ODD = {
    "inertia": (robot(body("hand", 0.0135)), r"odd: .*inertia of 'hand' .*: is the solution right\?"),
    "no colour": (robot(body("hand")), "odd: hand: no colour, or one that is not defined, so RViz shows red"),
    "limits": (
        robot(joint("revolute", inside='<axis xyz="0 0 1"/><limit lower="1" upper="-1" effort="1" velocity="1"/>')),
        r"odd: URDF\d+: lower 1 is not below upper -1: the joint cannot move \(line 1\)",
    ),
    "effort": (
        robot(joint("prismatic", inside='<axis xyz="0 0 1"/><limit lower="0" upper="1" effort="0" velocity="1"/>')),
        "odd: tool_joint: the effort is 0, so no controller can move the joint",
    ),
    "mass": (robot(body("hand", mass=0)), "odd: hand: the mass is 0 kg"),
    "collision": (
        robot().replace("</link>", '<collision><geometry><sphere radius="0.5"/></geometry></collision></link>'),
        r"odd: .*collision shape of 'base' .*: is the solution right\?",
    ),
    "no inertia": (
        robot('<gazebo reference="base"><mu1>0.5</mu1></gazebo>'),
        "odd: base: no <inertial>, though the link has shapes",
    ),
    "problem": (robot(joint("fixed", inside='<limt lower="1"/>')), r"odd: URDF\d+: .* \(line 1\)"),
}


@pytest.mark.parametrize("name", ODD)
def test_what_looks_odd_is_said(name: str, tmp_path: Path) -> None:
    """The author of the solution is asked about it, in one line."""
    urdf, pattern = ODD[name]
    _, printed = rubric_of(urdf, tmp_path)
    assert re.search(f"^{pattern}", printed, re.MULTILINE), printed


def test_a_plausible_robot_is_not_odd(tmp_path: Path) -> None:
    """A wheel on each side with axes in the same direction, limits in order, colours: nothing is said."""
    _, printed = rubric_of(robot(*wheels(1)), tmp_path)
    assert "odd:" not in printed


def test_mirrored_wheels_are_odd(tmp_path: Path) -> None:
    """Two equal wheels with opposite axes do not drive forward together."""
    _, printed = rubric_of(robot(*wheels(-1)), tmp_path)
    assert "odd: left and right are equal wheels with opposite axes" in printed


def wheels(sign: int) -> list[str]:
    """Return two wheels; `sign` is the direction of the second one's axis."""
    shape = '<geometry><cylinder radius="0.1" length="0.05"/></geometry><material name="red"/>'
    turns = {"left": 1, "right": sign}
    made = [
        joint("continuous", name, f'<origin xyz="0 {y} 0" rpy="1.5708 0 0"/><axis xyz="0 0 {y}"/>')
        for name, y in turns.items()
    ]
    return [it.replace("/><joint", f"><visual>{shape}</visual></link><joint") for it in made]


def test_a_shape_that_no_check_can_place_is_omitted(tmp_path: Path) -> None:
    """The size of each of several boxes is a criterion, the place that of the largest; the output says so."""
    second = '<visual><origin xyz="0 0 1"/><geometry><box size="0.1 0.1 0.1"/></geometry></visual></link>'
    rubric, printed = rubric_of(robot().replace("</link>", second, 1), tmp_path)
    boxes = [row["with"]["size"] for row in rubric["criterion"] if row["check"] == "shows_box"]
    assert boxes == [[1, 1, 1], [0.1, 0.1, 0.1]]
    assert "omitted: base: place and colour of all its boxes but the largest" in printed


def test_the_place_of_equal_shapes_is_omitted(tmp_path: Path) -> None:
    """Which of two equal boxes comes first in the file must not matter."""
    second = '<visual><origin xyz="0 0 3"/><geometry><box size="1 1 1"/></geometry></visual></link>'
    rubric, printed = rubric_of(robot().replace("</link>", second, 1), tmp_path)
    assert [row["check"] for row in rubric["criterion"]] == ["urdf_loads", "shows_box"]
    assert "omitted: base: place and colour of its boxes: they are equally large" in printed


def test_an_inertia_that_is_not_its_shape_is_omitted(tmp_path: Path) -> None:
    """The criterion is not written, because the reference would lose it; a rounded one gets a larger tolerance."""
    rubric, printed = rubric_of(robot(body("hand", 0.0135), body("foot", 0.0111)), tmp_path)
    found = {row["with"]["link"]: row["with"] for row in rubric["criterion"] if row["check"] == "inertia_plausible"}
    assert found == {"foot": {"link": "foot", "tolerance": 5.0}}
    assert "omitted: hand-inertia: " in printed


def test_what_only_the_name_of_a_joint_finds_is_a_criterion_if_the_name_is_used(tmp_path: Path) -> None:
    """The effort of a continuous joint and safety controllers are omitted, unless a controller uses the joint's name."""
    inside = '<limit effort="7" velocity="3"/><safety_controller k_velocity="10"/>'
    base = robot(joint("continuous", inside=inside))
    rubric, printed = rubric_of(base, tmp_path)
    assert (
        "omitted: <limit> of tool_joint and <safety_controller> of tool_joint: a check finds it by the name" in printed
    )
    assert "element_present" not in [row["check"] for row in rubric["criterion"]]
    (tmp_path / "lab.toml").unlink()
    control = '<ros2_control name="c" type="system"><joint name="tool_joint"/></ros2_control></robot>'
    rubric, printed = rubric_of(base.replace("</robot>", control), tmp_path)
    values = {row["id"]: row["with"]["values"] for row in rubric["criterion"] if row["check"] == "element_present"}
    assert values["joint-tool-joint-limit"] == {"@effort": 7, "@velocity": 3}
    assert values["joint-tool-joint-safety-controller"] == {"@k_velocity": 10}
    assert "omitted" not in printed


def test_what_a_mesh_leaves_open_is_demanded_by_numbers(tmp_path: Path) -> None:
    """The inertia of a link with a mesh, its mass centre, and a collision shape that is no visual have the reference's numbers."""
    mesh = '<visual><geometry><mesh filename="package://ash/hand.stl"/></geometry></visual>'
    collision = '<collision><origin xyz="0 0 0.1"/><geometry><sphere radius="0.05"/></geometry></collision>'
    hand = body("hand").replace("<inertial>", '<inertial><origin xyz="0 0 0.02"/>')
    cylinder = hand[hand.index("<visual>") : hand.index("<inertial>")]
    rubric, _ = rubric_of(robot(hand.replace(cylinder, mesh)), tmp_path)
    found = {row["id"]: row["with"] for row in rubric["criterion"] if row["check"] == "element_present"}
    assert found["hand-inertia"]["values"]["@ixx"] == 0.0107
    assert found["hand-mass-centre"]["values"] == {"@xyz": "0 0 0.02"}
    (tmp_path / "lab.toml").unlink()
    rubric, _ = rubric_of(robot(hand.replace(cylinder, mesh + collision)), tmp_path)
    found = {row["id"]: row["with"] for row in rubric["criterion"] if row["check"] == "collides_as"}
    assert found == {
        "hand-collision": {"link": "hand", "sphere": 0.05, "xyz": [0, 0, 0.1], "rpy": [0, 0, 0], "only": True}
    }


def test_a_collision_that_is_no_visual_must_be_turned_as_in_the_reference(tmp_path: Path) -> None:
    """The generated criterion passes for a cylinder that is turned the other way round, and fails for one that is not turned."""
    turned = '<collision><origin xyz="0 0 0.1" rpy="0 1.5708 0"/><geometry><cylinder radius="0.02" length="0.3"/></geometry></collision>'
    text = robot().replace("</link>", f"{turned}</link>", 1)
    rubric, _ = rubric_of(text, tmp_path)
    found = next(row for row in rubric["criterion"] if row["check"] == "collides_as")
    assert found["with"]["rpy"] == [0, 1.5708, 0]
    lost = {}
    for name, rpy in (("opposite", 'rpy="0 -1.5708 0"'), ("upright", "")):
        (tmp_path / f"{name}.urdf").write_text(text.replace('rpy="0 1.5708 0"', rpy), "utf-8")
        done = run(("grade", tmp_path / f"{name}.urdf", "--rubric", tmp_path / "lab.toml", "--format", "json"))
        lost[name] = [row["id"] for row in json.loads(done.stdout)["results"] if row["points"] == 0]
    assert lost == {"opposite": [], "upright": [found["id"]]}
    more = text.replace("</link>", '<collision><geometry><sphere radius="9"/></geometry></collision></link>', 1)
    (tmp_path / "more.urdf").write_text(more, "utf-8")
    done = run(("grade", tmp_path / "more.urdf", "--rubric", tmp_path / "lab.toml"))
    assert b"has another collision shape, a sphere of radius 9 m" in b" ".join(done.stdout.split())


def test_a_path_of_one_machine_is_odd_and_not_demanded(tmp_path: Path) -> None:
    """Students cannot have the instructor's home folder; a file of a package is demanded as xacro finds it."""
    values = "<parameters>$(find ash)/config/a.yaml</parameters><log>/home/cedar/a.log</log>"
    gazebo = f'<gazebo><plugin name="control">{values}</plugin></gazebo>'
    text = robot(gazebo).replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    (tmp_path / "robot.xacro").write_text(text)
    printed = new(tmp_path / "lab.toml", tmp_path / "robot.xacro")
    rows = tomllib.loads((tmp_path / "lab.toml").read_text())["criterion"]
    found = [row["with"]["values"] for row in rows if row["check"] == "element_present"]
    assert found == [{"@name": "control", "parameters": "$(find ash)/config/a.yaml"}]
    assert "odd: the path /home/cedar/a.log exists on one machine only" in printed


def test_one_link_is_a_robot(tmp_path: Path) -> None:
    """A link alone has criteria for what it shows, and none for joints."""
    rubric, _ = rubric_of(robot(), tmp_path)
    checks = [row["check"] for row in rubric["criterion"]]
    assert checks == ["urdf_loads", "shows_box", "shows_colour", "centre_at"]


def test_names_are_escaped_and_ids_unique(tmp_path: Path) -> None:
    """Names with quotes, spaces or other letters give a rubric that loads, with different ids."""
    names = ("a b", "a-b", "a_b", "größe", "&quot;x&quot;", "\\n", "車")
    rubric, _ = rubric_of(robot(*(joint("fixed", name) for name in names)), tmp_path)
    ids = [row["id"] for row in rubric["criterion"]]
    assert {"a-b-frame", "a-b-frame-2", "a-b-frame-3", "größe-frame", "車-frame"} <= set(ids)
    assert len(set(ids)) == len(ids)
