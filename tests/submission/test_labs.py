"""A repository of several labs: the folder of this lab decides what is graded."""

from collections.abc import Mapping

import pytest

from grader.lab.submission.labs import Belonging, LabFolders
from tests.submission.trees import BOX, PICTURE, ROBOT, manifest, others, package, submission

OTHER_LAB = "it is in the folder of another lab"
OUTSIDE = "it is outside the folder of this lab"


@pytest.mark.parametrize(
    "name",
    [
        "Lab6",
        "lab6",
        "LAB 6",
        "lab_6",
        "lab-06",
        "Lab6.zip",
        "lab 6.tar.gz",
        "Lab6_Ash",
        "Ash - Lab 6",
        "Lab6 and Lab7",
        "Lab6 (1)",
        "Lab 6_2026-11-20",
        "2026 Lab6",
        "Lab Six",
    ],
)
def test_names_of_this_lab(name: str) -> None:
    """Case, spaces, hyphens, underscores, leading zeros and the ending of an archive do not matter; more words may follow."""
    assert LabFolders(["Lab6"], [f"{name}/a"]).belonging(f"{name}/a") is Belonging.THIS_LAB


@pytest.mark.parametrize(
    "name",
    [
        "Lab7",
        "lab_5",
        "LAB 10",
        "Lab7_Ash",
        "Final Project",
        "FinalProject",
        "final_project_ash",
        "Lab7.zip",
        "Lab5 (1)",
        "Lab 16",
        "Lab 5_2026",
        "Lab seven",
    ],
)
def test_names_of_other_labs(name: str) -> None:
    """The same name with another number, and a final project."""
    assert LabFolders(["Lab6"], [f"{name}/a"]).belonging(f"{name}/a") is Belonging.OTHER_LAB


@pytest.mark.parametrize(
    "name", ["lab", "prelab6", "src", "6", "final", "laboratory 6", "my_robot", "project"]
)
def test_names_of_no_lab(name: str) -> None:
    """Anything else."""
    assert LabFolders(["Lab6"], [f"{name}/a"]).belonging(f"{name}/a") is Belonging.NO_LAB


def test_the_nearest_folder_decides() -> None:
    """A folder in a lab's folder may be of another lab; a package named for a lab tells nothing."""
    labs = LabFolders(["Lab6"], ["Lab6/a", "lab6_description/package.xml", "Lab7 robot/setup.py"])
    assert labs.belonging("Lab6/Lab5/a") is Belonging.OTHER_LAB
    assert labs.belonging("Lab7/Lab6/src/a") is Belonging.THIS_LAB
    assert labs.belonging("lab6_description/urdf/a") is Belonging.NO_LAB
    assert labs.belonging("Lab7 robot/a") is Belonging.NO_LAB
    assert labs.belonging("Lab6 resources/a") is Belonging.NO_LAB  # there is a Lab6
    assert (
        LabFolders(["robot"], ["my robot/a"]).belonging("my robot/a") is Belonging.NO_LAB
    )  # it has no number
    assert LabFolders([], ["Lab6/a"]).belonging("Lab6/a") is Belonging.NO_LAB


@pytest.mark.parametrize("name", ["lab6_robot", "lab6_nodes", "my_lab6", "lab_6_bot", "Lab5"])
@pytest.mark.parametrize("above", ["", "Lab6/"])
def test_a_folder_in_a_package_names_no_lab(name: str, above: str) -> None:
    """Such as a module of setup.py; the folders above a package do."""
    found = submission({**package(f"{above}my_robot"), f"{above}my_robot/{name}/__init__.py": b""})
    assert found.package is not None
    assert f"{name}/__init__.py" in found.package.tree.files
    assert found.notes == ()


@pytest.mark.parametrize(
    ("files", "urdf", "folder", "reasons"),
    [
        (
            {
                "Lab_7/my_robot.urdf": ROBOT,
                **package("Lab7/my_robot"),
                **package("Lab6/Ash/ws/src/my_robot"),
            },
            "Lab6/Ash/ws/src/my_robot/urdf/my_robot.urdf",
            "Lab6/Ash/ws/src/my_robot",
            {
                "Lab_7/my_robot.urdf": OTHER_LAB,
                "Lab7/my_robot/urdf/my_robot.urdf": OTHER_LAB,
                "Lab7/my_robot/package.xml": OTHER_LAB,
            },
        ),
        (
            {
                **package("Lab6/my_robot"),
                **package("ws/src/my_robot"),
                "Lab6 resources/my_robot.urdf": ROBOT,
            },
            "Lab6/my_robot/urdf/my_robot.urdf",
            "Lab6/my_robot",
            {
                "ws/src/my_robot/urdf/my_robot.urdf": OUTSIDE,
                "ws/src/my_robot/package.xml": OUTSIDE,
                "Lab6 resources/my_robot.urdf": OUTSIDE,
            },
        ),
        (
            {
                "lab 6/deep/er/robot.txt": ROBOT,
                "my_robot.urdf": ROBOT,
                **package("Final Project/my_robot"),
            },
            "lab 6/deep/er/robot.txt",
            None,
            {
                "my_robot.urdf": OUTSIDE,
                "Final Project/my_robot/urdf/my_robot.urdf": OTHER_LAB,
                "Final Project/my_robot/package.xml": OTHER_LAB,
            },
        ),
        (
            {"Lab6/step.png": PICTURE, **package("Final Project/my_robot")},
            None,
            None,
            {
                "Final Project/my_robot/urdf/my_robot.urdf": OTHER_LAB,
                "Final Project/my_robot/package.xml": OTHER_LAB,
            },
        ),
        (
            {**package("ws/src/my_robot"), **package("Lab7/my_robot")},
            "ws/src/my_robot/urdf/my_robot.urdf",
            "ws/src/my_robot",
            {"Lab7/my_robot/urdf/my_robot.urdf": OTHER_LAB, "Lab7/my_robot/package.xml": OTHER_LAB},
        ),
        (
            {"Lab6/my_robot.urdf": ROBOT, **package("ws/src/my_robot", urdf=False)},
            "Lab6/my_robot.urdf",
            "ws/src/my_robot",
            {},
        ),
    ],
)
def test_the_folder_of_the_lab_wins(
    files: Mapping[str, bytes], urdf: str | None, folder: str | None, reasons: dict[str, str]
) -> None:
    """Over depth and names; what it lacks may be in no lab's folder, but never in a final project."""
    found = submission(files)
    assert found.path == urdf
    assert (found.package.folder if found.package is not None else None) == folder
    assert others(found) == reasons
    assert found.notes == ()


def test_another_lab_is_used_if_there_is_nothing_else() -> None:
    """The note says so, and of several other labs only that one is read."""
    found = submission(
        {"README.md": b"", **package("Lab5/my_robot"), "Lab4/b.urdf": BOX, "Lab4/x.png": PICTURE}
    )
    assert (found.path, found.package and found.package.folder) == (
        "Lab5/my_robot/urdf/my_robot.urdf",
        "Lab5/my_robot",
    )
    assert found.notes == (
        "no folder of this lab was found: Lab5, the folder of another lab, was graded",
    )
    assert others(found) == {"Lab4/b.urdf": "its path is less like urdf/my_robot.urdf"}
    assert found.labelled_files == ()
    assert "README.md" in found.tree.files


def test_a_robot_outside_of_the_folder_is_noted() -> None:
    """A lab's folder with pictures, and the workspace in the root of the repository."""
    found = submission(
        {"Lab6/step.png": PICTURE, **package("ws/src/my_robot"), "other.png": PICTURE}
    )
    urdf = "ws/src/my_robot/urdf/my_robot.urdf"
    assert found.path == urdf
    assert found.notes == (
        f"Lab6, the folder of this lab, has no robot of this lab: {urdf}, which is outside of it, was graded",
    )
    assert [file.file.path for file in found.labelled_files] == ["Lab6/step.png"]


def test_the_folder_confines_evidence_and_documents() -> None:
    """A picture or answer of another lab is none of this lab; without a folder of the lab all others are ignored."""
    files = {
        name: PICTURE
        for name in ("Lab6/a.png", "Lab7/Task1_Step8.png", "b.png", "Lab7/answers.md", "Lab6/c.md")
    }
    found = submission({**files, "Lab6/my_robot.urdf": ROBOT})
    assert [file.file.path for file in found.labelled_files] == ["Lab6/a.png"]
    assert [document.file.path for document in found.documents.named(["*.md"])[0]] == ["Lab6/c.md"]
    found = submission({**files, "my_robot.urdf": ROBOT}, folders=("Lab 8",))
    assert [file.file.path for file in found.labelled_files] == ["b.png"]


def test_without_lab_folders_everything_is_read() -> None:
    """As before: of a rubric without folders, and of a submission without a lab's folder."""
    files = {**package("Lab7/my_robot"), "Lab7/a.png": PICTURE, "b.png": PICTURE}
    assert submission(files, folders=()).notes == ()
    assert len(submission(files, folders=()).labelled_files) == 2
    plain = {**package("ws/src/my_robot"), "a.png": PICTURE}
    assert submission(plain).tree.files.keys() == plain.keys()


@pytest.mark.parametrize(
    ("files", "folder"),
    [
        (
            {
                "my_robot.urdf": ROBOT,
                **package("other_robot_gazebo", "other_robot_gazebo", urdf=False),
            },
            None,
        ),
        ({"my_robot.urdf": ROBOT, **package("my_robott", "my_robott", urdf=False)}, None),
        (package("other", "other"), "other"),
        (package("my_robott", "my_robott"), "my_robott"),
        ({**package("a", "My_Robot", urdf=False), "my_robot.urdf": ROBOT}, "a"),
        ({**package("a", "a"), **package("b", "my_robot", urdf=False)}, "b"),
        (
            {
                **package("a", "a"),
                "a/b/package.xml": manifest("b"),
                "a/b/urdf/my_robot.urdf": ROBOT,
            },
            "a",
        ),
    ],
)
def test_another_package_is_not_graded(files: Mapping[str, bytes], folder: str | None) -> None:
    """Only the package with the rubric's name, or else the one that holds the graded URDF."""
    found = submission(files)
    assert (found.package.folder if found.package is not None else None) == folder


def test_another_lab_is_graded_where_this_one_has_no_work() -> None:
    """The robot that is wanted is taken from another lab's folder if there is no other, with a note; no other robot is."""
    found = submission(
        {"Lab6/step.png": PICTURE, **package("Lab7/my_robot"), **package("Lab8/my_robot", "other")}
    )
    assert (found.path, found.package and found.package.folder) == (
        "Lab7/my_robot/urdf/my_robot.urdf",
        "Lab7/my_robot",
    )
    why = "Lab6, the folder of this lab, has no robot of this lab"
    assert found.notes == (found.several, f"{why}: Lab7, the folder of another lab, was graded")
    assert "not Lab8/my_robot/urdf/my_robot.urdf" in found.several
    assert list(found.tree.files) == ["Lab6/step.png"]
