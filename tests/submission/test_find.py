"""Selecting the URDF and the package of a submission that are graded, and the reasons against the others."""

from functools import partial
from pathlib import Path
from shutil import copytree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError
from grader.files.tree import File, Tree, make_tree
from grader.lab.grading.grade import grade
from grader.lab.submission.labs import LabFolders
from grader.lab.submission.opening import make_submission, open_submission
from grader.lab.submission.selection import UrdfChoice, UrdfSearch
from grader.lab.submission.submission import DEFAULTS, Lab
from grader.ros.package.finding import find_packages, read_packages
from grader.ros.package.package import Package
from grader.ros.package.robot_file import OtherCandidate
from grader.ros.package.robots import find_robots
from tests.samples import LAB6, ROOT
from tests.work import limited_work

EXPECTED = "urdf/my_robot.urdf"
ROBOT = b'<?xml version="1.0"?>\n<robot name="my_robot"/>\n'
OUTSIDE = "it is outside the package that is graded"
DEEPER = "it matches equally well, but is deeper in the folders"
LATER = "it matches equally well, but comes later in alphabetical order"
LESS_LIKE = "its path is less like urdf/my_robot.urdf"
BACKUP = "it is named like a backup"
ANOTHER = "it has fewer than half of the links that the rubric names"
BOX = b"<robot name='box'><link name='box'/></robot>"


def tree_of(*paths: str, **contents: bytes) -> Tree:
    """Return a file tree of robots; `contents` gives the content of files by a prefix of their names."""
    files = [
        _file(
            path,
            next(
                (data for name, data in contents.items() if path.split("/")[-1].startswith(name)),
                ROBOT,
            ),
        )
        for path in paths
    ]
    return make_tree("lab6", files, ())


def _file(path: str, data: bytes) -> File:
    return File(path, len(data), partial(_read, data))


def _read(data: bytes, limit: int, *, first: bool = False) -> bytes:
    if len(data) > limit and not first:
        raise InputError("it is too large")
    return data[:limit]


def manifest(name: str) -> bytes:
    """Return a package.xml with this name."""
    return f'<package format="3"><name>{name}</name></package>'.encode()


def find_urdf(tree: Tree, urdf: str) -> UrdfChoice:
    """Return which robot of a tree is graded."""
    robots = find_robots(tree, urdf.rpartition("/")[2])
    lab = Lab(urdf, "my_robot", links=frozenset({"base_link"}))
    found = UrdfSearch(
        tree,
        lab,
        LabFolders([]),
        DEFAULTS,
        read_packages(tree, lab.urdf, lab.package, lab.packages),
    ).choose(robots)
    return found._replace(reading=None)


def rejected(found: UrdfChoice) -> dict[str, str]:
    """Return the other candidates, and why they are not graded."""
    return {other.path: other.reason for other in found.others}


def test_every_tier() -> None:
    """The rubric's path takes precedence, then its name, a similar name, another .urdf, the content, and an empty file."""
    paths = [
        "a/my_robot.urdf",
        "urdf/my_robot.urdf",
        "my_robot.urdf.xacro.txt",
        "robot.urdf",
        "lab6.xml",
        "e/empty.urdf",
    ]
    found = find_urdf(tree_of(*paths, empty=b""), EXPECTED)
    assert found.path == "urdf/my_robot.urdf"
    assert rejected(found) == {
        "a/my_robot.urdf": LESS_LIKE,
        "my_robot.urdf.xacro.txt": LESS_LIKE,
        "robot.urdf": LESS_LIKE,
        "lab6.xml": LESS_LIKE,
        "e/empty.urdf": "its <robot> has no name or no links",
    }
    ranked = [
        "urdf/my_robot.urdf",
        "a/my_robot.urdf",
        "my_robot.urdf.xacro.txt",
        "robot.urdf",
        "lab6.xml",
        "e/empty.urdf",
    ]
    for index, best in enumerate(ranked):
        assert find_urdf(tree_of(*ranked[index:], empty=b""), EXPECTED).path == best


@pytest.mark.parametrize(
    ("better", "worse", "reason"),
    [
        ("x/y/urdf/my_robot.urdf", "my_robot.urdf", LESS_LIKE),
        ("urdf/my_robot.urdf", "x/urdf/my_robot.urdf", DEEPER),
        ("a/urdf/my_robot.urdf", "b/urdf/my_robot.urdf", LATER),
        ("urdf/my_robot.urdf", "urdf/My_Robot.urdf", LESS_LIKE),
        ("x/y/my_robot_v2.urdf", "my_robotOld.urdf", BACKUP),
        ("deep/down/my_robot.urdf", "my_robot.urdf.txt", LESS_LIKE),
        ("x/my_robot.urdf.xacro", "robot.urdf", LESS_LIKE),
        ("MY_ROBOT_final(2).urdf", "robot.urdf", LESS_LIKE),
        ("x/robot.urdf", "robot.xml", LESS_LIKE),
        ("robot", "x/robot.xacro", DEEPER),
    ],
)
def test_pairs(better: str, worse: str, reason: str) -> None:
    """Of two files the better one is graded, whatever their order, and the other is listed with the reason."""
    for paths in ((better, worse), (worse, better)):
        found = find_urdf(tree_of(*paths), EXPECTED)
        assert found == UrdfChoice(better, (OtherCandidate(worse, reason),))


def test_files_that_are_no_robot() -> None:
    """A file whose first element is not <robot>, or that is no text, is no robot, whatever it is called."""
    tree = tree_of(
        "package.xml",
        "notes.md",
        "my_robot.launch.py",
        "robot.png",
        "late.xml",
        "other.xml",
        "empty.xml",
        "macros.txt",
        package=manifest("x"),
        notes=b"# My robot\n" + ROBOT,
        my_robot=b"TEXT = '''" + ROBOT,
        late=b"text" + ROBOT,
        other=b"<robots/>",
        empty=b"",
        macros=b"<?xml?><!-- <robot> --><launch><robot/></launch>",
    )
    assert find_urdf(tree, EXPECTED) == UrdfChoice(None, ())


@pytest.mark.parametrize(
    "text",
    [
        b"<robot name='a'/>",
        b"< robot>",
        b"\xef\xbb\xbf \r\n<?xml version = 1.0>\n<robot>",
        b"<?xml version='1.0'?><!-- <launch> -- > --><!DOCTYPE robot [<!ENTITY a 'b'>]>\n<!-- -->\t<robot/>",
        b"<!--" + b"-" * 50_000 + b"-->" + ROBOT,
        b" " * 5000 + ROBOT,
        b"<robot name='a'><parent='b'/></robot> text",
    ],
)
@pytest.mark.parametrize(
    "name",
    [
        "urdf.xacro file",
        "urdf.xacro file.py",
        "urdf.Xacro file.txt",
        "my_robot",
        "CMakeLists.txt",
        "a.md",
    ],
)
def test_a_robot_is_recognised_by_its_first_element(name: str, text: bytes) -> None:
    """Whatever the file is called, after a declaration, comments, a byte-order mark, a DOCTYPE and white space, however broken."""
    assert find_urdf(make_tree("", [_file(f"a/{name}", text)], ()), EXPECTED).path == f"a/{name}"


def test_a_hostile_beginning_is_read_in_linear_time() -> None:
    """Thousands of comments, declarations and brackets without an end take no time."""
    open_brackets = [b"<!DOCTYPE a [" * 5000, b"<!DOCTYPE a [" + b"]" * 60_000]
    starts = [b"<!--a-->" * 8000, b"<!--" * 16_000, b"<?a>" * 16_000, *open_brackets]
    with limited_work(4_000):
        for start in starts:
            assert find_urdf(make_tree("", [_file("a.xml", start)], ()), EXPECTED).path is None


def test_the_size_limit() -> None:
    """Only files that may be read as a URDF are searched for a robot; one with the ending is named all the same."""
    large = ROBOT + b" " * 5000
    tree = make_tree("", [_file("a.txt", large), _file("b.urdf", large)], ())
    assert [robot.path for robot in find_robots(tree, max_size=5000)] == ["b.urdf"]
    assert [robot.path for robot in find_robots(tree)] == ["a.txt", "b.urdf"]


def test_the_name_of_the_robot_counts() -> None:
    """A file with an odd name that holds the wanted robot is better than a .urdf with another one, such as the box of a prelab."""
    box = b"<robot name='box'/>"
    odd = b"<robot xmlns:xacro='http://www.ros.org/wiki/xacro' name = 'my_robot'>"
    for name in ("a/urdf.xacro file", "z"):
        found = find_urdf(tree_of(name, "box.urdf", box=box, urdf=odd, z=odd), EXPECTED)
        assert found == UrdfChoice(name, (OtherCandidate("box.urdf", LESS_LIKE),))


def test_a_file_that_another_one_includes_is_a_part() -> None:
    """The file that includes others is graded, not the macros and materials that it includes."""
    includes = ("$(find my_robot)/urdf/materials.xacro", "a.xacro")
    main = XACRO + b"".join(b"<xacro:include filename='%s'/>" % name.encode() for name in includes)
    tree = tree_of(
        "a.xacro",
        "materials.xacro",
        "z/robot.xacro",
        a=b"<robot/>",
        materials=b"<robot/>",
        robot=main,
    )
    fragment = "its <robot> has no name or no links"
    others = (
        OtherCandidate("a.xacro", fragment, is_part=True),
        OtherCandidate("materials.xacro", fragment, is_part=True),
    )
    assert find_urdf(tree, EXPECTED) == UrdfChoice("z/robot.xacro", others)


XACRO = b"<robot name='my_robot' xmlns:xacro='http://www.ros.org/wiki/xacro'>"
MACROS = XACRO + b"<xacro:macro name='a'><link name='base_link'/></xacro:macro></robot>"
LINKS = b"<robot name='r'><link name='base_link'/></robot>"


@pytest.mark.parametrize("main", ["robot.urdf.xacro", "z/a.xacro"])
def test_the_name_of_a_part_does_not_matter(main: str) -> None:
    """A file that includes one named like the robot is graded, unless that is named exactly so, with any ending."""
    name = main.rpartition("/")[2].partition(".")[0]
    up = b"../" if "/" in main else b""
    includes = (
        XACRO.replace(b"my_robot", b"r") + b"<xacro:include filename='" + up + b"%s'/></robot>"
    )
    tree = tree_of(
        main,
        "box.urdf",
        "my_robot_core.xacro",
        **{name: includes % b"my_robot_core.xacro"},
        my_robot=LINKS,
        box=BOX,
    )
    assert find_urdf(tree, EXPECTED) == UrdfChoice(
        main,
        (
            OtherCandidate("my_robot_core.xacro", "another candidate includes it", is_part=True),
            OtherCandidate("box.urdf", ANOTHER),
        ),
    )
    tree = tree_of(
        main,
        "my_robot.urdf.xacro",
        **{name: includes % b"my_robot.urdf.xacro"},
        my_robot=LINKS,
        box=LINKS,
    )
    assert find_urdf(tree, EXPECTED).path == "my_robot.urdf.xacro"


@pytest.mark.parametrize(
    ("better", "backup"),
    [
        ("my_robot.urdf", "old/urdf/my_robot.urdf"),
        ("x/y/my_robot.urdf.xacro", "Backup/my_robot.urdf"),
        ("a/robot.urdf", "a/my_robot_old.urdf"),
        ("x/y/my_robot.urdf", "my_robot - Copy/my_robot.urdf"),
        ("x/y/my_robot.urdf", "oldWorkspace/src/my_robot/urdf/my_robot.urdf"),
    ],
)
def test_backups(better: str, backup: str) -> None:
    """A file that is named like a backup is graded only if no other one has the name or the robot of the lab."""
    named = LINKS.replace(b"'r'", b"'my_robot'")
    tree = tree_of(better, backup, my_robot=named, robot=named)
    assert find_urdf(tree, EXPECTED) == UrdfChoice(
        better, (OtherCandidate(backup, "it is named like a backup"),)
    )
    assert find_urdf(tree_of(backup), EXPECTED).path == backup
    assert find_urdf(tree_of(backup, "box.urdf", my_robot=LINKS, box=BOX), EXPECTED).path == backup
    assert (
        find_urdf(tree_of("z/golden/my_robot.urdf", "y/old/my_robot.urdf"), EXPECTED).path
        == "z/golden/my_robot.urdf"
    )


@pytest.mark.parametrize(
    "content",
    [
        MACROS,
        b"<robot><material name='green'/></robot>",
        b"<robot><!-- <link name='a'/> --><gazebo reference='base_link'/></robot>",
        XACRO + b"<xacro:property name='a' value='1'/>" * 200 + MACROS[len(XACRO) :],
    ],
)
def test_a_file_without_links_is_no_robot(content: bytes) -> None:
    """Macros, materials and settings of a simulator are not graded if another file has a link, whatever their names."""
    tree = tree_of("urdf/my_robot.urdf.xacro", "urdf/parts.xacro", my_robot=content, parts=LINKS)
    reason = OtherCandidate("urdf/my_robot.urdf.xacro", ANOTHER, is_part=True)
    assert find_urdf(tree, EXPECTED) == UrdfChoice("urdf/parts.xacro", (reason,))
    alone = tree_of("urdf/my_robot.urdf.xacro", "urdf/empty.urdf", my_robot=content, empty=b"")
    assert find_urdf(alone, EXPECTED).path == "urdf/my_robot.urdf.xacro"


@pytest.mark.parametrize(
    "content",
    [
        b"<robot name='a'>" + b"<material name='m'/>" * 300 + b"<link name='base_link'/></robot>",
        MACROS[:-8] + b"<xacro:a/></robot>",
        XACRO + b"<xacro:if value='1'><link name='base_link'/></xacro:if></robot>",
        XACRO + b"<xacro:include filename='parts.xacro'/></robot>",
    ],
)
def test_links_anywhere_in_the_beginning(content: bytes) -> None:
    """A link below other things, of a call, a condition or an included file makes a file the robot."""
    tree = tree_of("urdf/my_robot.urdf.xacro", "urdf/parts.xacro", my_robot=content, parts=LINKS)
    assert find_urdf(tree, EXPECTED).path == "urdf/my_robot.urdf.xacro"


@pytest.mark.parametrize(
    "tag", [b"<xacro:macro ", b"<xacro:include ", b"<!--", b"</xacro:macro ", b"filename = '/"]
)
def test_tags_that_never_end(tag: bytes) -> None:
    """The search in the beginning of a file takes linear time."""
    data = b"<robot>" + tag * (60_000 // len(tag))
    with limited_work(1_000):
        assert find_urdf(tree_of("a.xacro", a=data), EXPECTED).path == "a.xacro"


def test_a_file_of_the_right_name_needs_no_content() -> None:
    """A file at the expected path is graded whatever its content, if there is no robot."""
    for content in (b"nonsense", b""):
        assert (
            find_urdf(tree_of("urdf/my_robot.urdf", my_robot=content), EXPECTED).path
            == "urdf/my_robot.urdf"
        )
        assert (
            find_urdf(tree_of("urdf/my_robot.urdf", "other.urdf", my_robot=content), EXPECTED).path
            == "other.urdf"
        )


def test_a_file_that_cannot_be_read() -> None:
    """A file whose content cannot be read is no robot by its content."""

    def refuse(limit: int, *, first: bool = False) -> bytes:
        raise InputError("cannot read it")

    assert find_urdf(make_tree("", [File("a.xml", 10, refuse)], ()), EXPECTED).path is None


def test_other_endings() -> None:
    """A rubric may expect a file that is no .urdf."""
    tree = tree_of("urdf/my_robot.urdf.xacro", "urdf/my_robot.urdf")
    assert find_urdf(tree, "urdf/my_robot.urdf.xacro").path == "urdf/my_robot.urdf.xacro"
    assert find_urdf(tree, "my_robot.urdf").path == "urdf/my_robot.urdf"
    assert find_urdf(tree, "./urdf//my_robot.urdf").path == "urdf/my_robot.urdf"


def test_the_package_is_preferred() -> None:
    """Among equals the one in the package is graded, however deep; a better one outside is graded all the same."""
    inside, outside = "ws/src/my_robot/urdf/my_robot.urdf", "urdf/my_robot.urdf"
    tree = tree_of(outside, inside, "ws/src/my_robot/package.xml", package=manifest("my_robot"))
    assert find_urdf(tree, EXPECTED) == UrdfChoice(inside, (OtherCandidate(outside, OUTSIDE),))
    tree = tree_of(outside, "my_robot/a.urdf", "my_robot/package.xml", package=manifest("my_robot"))
    assert find_urdf(tree, EXPECTED).path == outside


def test_build_products() -> None:
    """At most twenty build products are listed, and none is graded."""
    generated = [f"install/{n}.urdf" for n in range(30)]
    found = find_urdf(make_tree("", [_file("a.urdf", ROBOT)], (), generated=generated), EXPECTED)
    assert found.path == "a.urdf"
    assert set(rejected(found).values()) == {
        "it was generated by a build, and only source files are graded"
    }
    assert len(found.others) == 20
    assert find_urdf(make_tree("", (), (), generated=generated[:1]), EXPECTED).path is None


def test_many_texts() -> None:
    """Only so many texts are examined; a file with the expected name is found all the same."""
    tree = tree_of(*(f"{n:04}.txt" for n in range(3000)), "z/robot.urdf")
    with limited_work(2_000_000):
        found = find_urdf(tree, EXPECTED)
    assert found.path == "z/robot.urdf"
    assert len(found.others) == 400


@pytest.mark.slow
def test_very_many_urdfs() -> None:
    """All are listed, and only so many are read; files that include each other take no more time."""
    text = b"<robot>" + b"".join(b"<xacro:include filename='%d.urdf'/>" % n for n in range(80))
    tree = tree_of(
        *(f"p{n % 200}/{n}/{n % 80}.urdf" for n in range(5000)), **{str(n): text for n in range(10)}
    )
    with limited_work(40_000_000):
        found = make_submission(tree, "many", Lab(EXPECTED, "my_robot", ("Lab6",)))
    assert len(found.other_candidates) == 4999


def test_likely_files_are_read_first() -> None:
    """Of very many files, those are read whose names say that they may be robots."""
    tree = make_tree(
        "",
        [
            *(_file(f"a/{n:04}.txt", b"text") for n in range(3000)),
            _file("z/urdf.xacro file", ROBOT),
        ],
        (),
    )
    assert find_urdf(tree, EXPECTED).path == "z/urdf.xacro file"


@given(
    st.lists(st.sampled_from(["my_robot", "urdf", "a", "b", "lab6"]), max_size=3).map("/".join),
    st.permutations(["my_robot.urdf", "x.urdf", "my_robot.txt", "y.xml"]),
)
def test_the_order_of_files_does_not_matter(folder: str, names: list[str]) -> None:
    """The same files are ranked the same."""
    paths = [f"{folder}/{name}" if folder else name for name in names]
    assert find_urdf(tree_of(*paths), EXPECTED) == find_urdf(tree_of(*sorted(paths)), EXPECTED)


@pytest.mark.parametrize(
    ("paths", "folders"),
    [
        (["package.xml", "setup.py"], [""]),
        (
            ["b/package.xml", "a/package.xml", "package.xml", "x/y/package.xml"],
            ["", "a", "b", "x/y"],
        ),
        (["my_robot/setup.py"], ["my_robot"]),
        (["other/setup.py"], ["other"]),
        (["other/package.xml", "my_robot/setup.py"], ["my_robot", "other"]),
        (["other/package.xml", "third/setup.py"], ["other"]),
        (["other/setup.py", "my_robot/setup.py"], ["my_robot"]),
        (["a/Package.xml", "a/package.xml.txt", "a/setup.cfg"], []),
        ([], []),
    ],
)
def test_packages_are_found(paths: list[str], folders: list[str]) -> None:
    """A package has a package.xml, or at least a setup.py in a folder of the expected name; the shortest path is first."""
    assert find_packages(tree_of(*paths), "my_robot") == folders


def test_many_packages() -> None:
    """Only so many packages are read."""
    assert len(find_packages(tree_of(*(f"p{n}/package.xml" for n in range(100))), "my_robot")) == 40


def packages(expected: str, names: dict[str, str | None]) -> tuple[Package, ...]:
    """Return the packages of a file tree: folders and the names in their package.xml, None for only a setup.py."""
    files = [
        _file(
            f"{folder}/{'setup.py' if name is None else 'package.xml'}".lstrip("/"),
            b"" if name is None else manifest(name),
        )
        for folder, name in names.items()
    ]
    return read_packages(make_tree("upload", files, ()), "", expected)


@pytest.mark.parametrize(
    ("names", "folder", "name"),
    [
        ({"a": "other", "b/c": "my_robot"}, "b/c", "my_robot"),
        ({"a": "other", "b/my_robot": "another"}, "b/my_robot", "another"),
        ({"a": "other", "x/y": "my_robott"}, "x/y", "my_robott"),
        ({"a": "other", "b": "another"}, "a", "other"),
        ({"x/my_robot": "my_robot", "my_robot": "my_robot"}, "my_robot", "my_robot"),
        ({"a": "other", "my_robot": None}, "my_robot", "my_robot"),
        ({"": "other"}, "", "other"),
        ({"": None}, "", "upload"),
        ({"src": None}, "src", "src"),
        ({"a": ""}, "a", "a"),
    ],
)
def test_the_package_that_is_graded(names: dict[str, str | None], folder: str, name: str) -> None:
    """By its name, then by that of its folder, then by a similar name, then the shortest path."""
    first, *_ = packages("my_robot", names)
    assert (first.folder, first.name) == (folder, name)


def test_all_packages_are_listed_by_name() -> None:
    """Every package is known by its name, the graded one first among equals."""
    found = packages("my_robot", {"b/my_robot": "my_robot", "a/my_robot": "my_robot", "c": "other"})
    assert [submission.folder for submission in found] == ["a/my_robot", "b/my_robot", "c"]
    assert {name: package.folder for name, package in found[1].packages.items()} == {
        "my_robot": "a/my_robot",
        "other": "c",
    }


def test_no_package() -> None:
    """A submission without a package has none."""
    assert packages("my_robot", {}) == ()


def team(first: list[str], second: list[str]) -> Tree:
    """Return the repository of a team of two: a package my_robot for each."""
    paths = [
        "README.md",
        *(f"Lab6/Adams/my_robot/{path}" for path in first),
        *(f"Lab6/Brown/my_robot/{path}" for path in second),
    ]
    return tree_of(*paths, package=manifest("my_robot"))


def test_a_team_is_not_mixed_up() -> None:
    """One member's package is not graded with the other's URDF, even if that has a better name, and a note names both."""
    found = make_submission(
        team(["package.xml", "robot.urdf"], ["package.xml", "urdf/my_robot.urdf"]),
        "team",
        Lab(EXPECTED, "my_robot"),
    )
    assert (
        "Lab6/Brown/my_robot/urdf/my_robot.urdf was graded, not Lab6/Adams/my_robot/robot.urdf"
        in found.several
    )
    assert found.path == "Lab6/Brown/my_robot/urdf/my_robot.urdf"
    assert found.package is not None
    assert found.package.folder == "Lab6/Brown/my_robot"


def test_a_package_with_the_labs_files_takes_precedence() -> None:
    """Of packages of one name the one with the URDF at its path is graded, then the one with more of the usual files."""
    tree = tree_of(
        *("Lab5/my_robot/package.xml", "Lab5/my_robot/setup.py", "Lab5/my_robot/urdf/box.urdf"),
        *(
            "Lab6/my_robot/package.xml",
            "Lab6/my_robot/setup.py",
            "Lab6/my_robot/urdf/my_robot.urdf",
        ),
        package=manifest("my_robot"),
    )
    found = make_submission(tree, "a", Lab(EXPECTED, "my_robot"))
    assert found.path == "Lab6/my_robot/urdf/my_robot.urdf"
    assert found.package is not None
    assert found.package.folder == "Lab6/my_robot"
    stub = team(["package.xml"], ["package.xml", "setup.py", "rviz/a.rviz"])
    package = make_submission(stub, "a", Lab(EXPECTED, "my_robot")).package
    assert package is not None
    assert package.folder == "Lab6/Brown/my_robot"


def test_a_description_package() -> None:
    """A URDF in another package beside the graded one is found by its path."""
    tree = tree_of(
        "my_robot/package.xml",
        "my_robot/test.urdf",
        "my_robot_description/package.xml",
        "my_robot_description/urdf/my_robot.urdf",
        package=manifest("my_robot"),
    )
    assert (
        make_submission(tree, "a", Lab(EXPECTED, "my_robot")).path
        == "my_robot_description/urdf/my_robot.urdf"
    )


@pytest.mark.parametrize(("is_link", "status"), [(True, "pending"), (False, "failed")])
def test_a_link_may_hide_what_is_missing(is_link: bool, status: str, tmp_path: Path) -> None:
    """A launch folder that is a symlink needs manual grading; one that is missing, beside a build, fails."""
    package = tmp_path / "lab6" / "my_robot"
    copytree(ROOT / "rubrics/lab6/my_robot", package)
    (package / "launch").rename(tmp_path / "launch")
    (package / "build").mkdir()
    if is_link:
        (package / "launch").symlink_to(tmp_path / "launch")
    results = grade(LAB6, open_submission(str(tmp_path / "lab6"), LAB6.lab)).results
    found = {result.criterion.id: result.outcome.status for result in results}
    assert found["launch-found"] == status
    assert found["setup-installs-launch"] == ("pending" if is_link else "skipped")
