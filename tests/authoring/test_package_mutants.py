"""Mutants of the files of a package: each makes one mistake, where the tool that reads the file meets it."""

from collections.abc import Callable

import pytest

from grader.files.tree import overlaid
from grader.lab.authoring.mutants import Mutant, package_mutants
from grader.lab.grading.deciding import decide
from grader.lab.submission.edited import content
from grader.lab.submission.submission import Submission
from tests.authoring.robots import CHANGES
from tests.samples import LAB6, reference

pytestmark = pytest.mark.slow

REFERENCE = reference()


def text(path: str) -> str:
    """Return the text of a file of Lab 6's reference."""
    return (content(REFERENCE, path) or b"").decode()


def found_in(submission: Submission, text: Callable[[str], str] = text) -> dict[str, Mutant]:
    """Return the mutants of a package by their ids."""
    assert submission.package is not None
    return {
        mutant.id: mutant
        for mutant in package_mutants(submission.package, ["base_link", "base_footprint"], text)
    }


FOUND = found_in(REFERENCE)


def mutants_of(name: str, content: str) -> list[Mutant]:
    """Return the mutants of a file that the package has besides, without those that delete or rename it."""
    assert REFERENCE.reopen is not None
    changed = REFERENCE.reopen(overlaid(REFERENCE.whole_tree, {name: content.encode()}))
    found = found_in(changed, lambda path: content if path == name else text(path)).values()
    return [mutant for mutant in found if mutant.path == name and not mutant.is_deleted]


@pytest.mark.parametrize("change", CHANGES["package"], ids=lambda change: change["id"])
def test_a_mutant_makes_one_change(change: dict[str, str]) -> None:
    """The file, the place in it and the mistake."""
    mutant = FOUND[change["id"]]
    before = text(mutant.path)
    assert change["old"] in before
    assert mutant.applied(before) == before.replace(change["old"], change["new"], 1)


def test_files_are_deleted_and_renamed() -> None:
    """Those that ROS 2 reads, not those for people."""
    deleted = {mutant.path for mutant in FOUND.values() if mutant.is_deleted}
    assert deleted == set(REFERENCE.whole_tree.files)
    renamed = FOUND["file renamed: urdf/my_robot.urdf"]
    assert (renamed.path, renamed.renamed) == ("urdf/my_robot.urdf", "urdf/my_robt.urdf")
    for_people = dict.fromkeys(
        ("README.md", "LICENSE", "docs/a.urdf", "test/test_a.py", ".gitignore", "a.png"), b""
    )
    assert REFERENCE.reopen is not None
    assert found_in(REFERENCE.reopen(overlaid(REFERENCE.whole_tree, for_people))) == FOUND
    built = found_in(REFERENCE.reopen(overlaid(REFERENCE.whole_tree, {"CMakeLists.txt": b""})))
    assert set(built) - set(FOUND) == {
        "file deleted: CMakeLists.txt",
        "file renamed: CMakeLists.txt",
    }


@pytest.mark.parametrize(
    ("name", "lost"),
    [
        ("text misspelt: package.xml export/build_type", "package-type"),
        ("import deleted: setup.py import os", "setup-imports"),
        ("action removed: launch/my_robot_rviz.launch.py rviz2", "launch-nodes"),
        ("display disabled: rviz/my_robot.rviz RobotModel", "rviz-shows-robot"),
        ("file deleted: launch/my_robot_rviz.launch.py", "launch-found"),
    ],
)
def test_a_criterion_fails_for_its_mutant(name: str, lost: str) -> None:
    """The grader reads the changed file as it is meant."""
    mutant = FOUND[name]
    data = None if mutant.is_deleted else mutant.applied(text(mutant.path)).encode()
    assert REFERENCE.reopen is not None
    changed = REFERENCE.reopen(overlaid(REFERENCE.whole_tree, {mutant.path: data}))
    (result,) = decide(LAB6, changed, [lost])
    assert result.outcome.status == "failed"


def test_texts_for_people_are_not_changed() -> None:
    """Docstrings, descriptions, licences."""
    setup = "'''Doc'''\nfrom setuptools import setup\nsetup(name='a', description='b', license='c', data_files=[('d', ['e'])])\n"
    labels = [mutant.id.partition(": ")[2] for mutant in mutants_of("setup.py", setup)]
    assert labels == [
        f"setup.py {it}" for it in ("('d', ['e'])", "from setuptools import setup", "a", "d", "e")
    ]
    launch = "def generate_launch_description():\n    '''Doc'''\n    ld = LaunchDescription()\n    ld.add_action(Node(executable='x'))\n"
    found = mutants_of("launch/a.launch.py", launch)
    assert [mutant.id.partition(": ")[2] for mutant in found] == ["launch/a.launch.py x"] * 2
    assert found[0].applied(launch) == launch.replace("ld.add_action(Node(executable='x'))", "None")


@pytest.mark.parametrize(
    ("name", "content", "ids"),
    [
        (
            "launch/a.launch.xml",
            '<launch><node pkg="rviz2" exec="rviz2"/></launch>',
            [
                "element deleted: launch/a.launch.xml node",
                "text misspelt: launch/a.launch.xml node exec",
            ],
        ),
        ("launch/c.launch.yaml", "launch: [", []),
        ("rviz/d.rviz", "a: [", []),
        ("launch/e.launch.py", "def (", []),
    ],
)
def test_other_files(name: str, content: str, ids: list[str]) -> None:
    """Launch files in XML have mutants, too; a file that cannot be read has none but its own deletion."""
    own = mutants_of(name, content)
    assert {*ids} <= {mutant.id for mutant in own}
    assert ids or not own
    assert all(mutant.applied(content) != content for mutant in own)
