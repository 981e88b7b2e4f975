"""Moodle's bulk download: folders or files, files and texts, teams, and hidden names."""

import tempfile
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.classroom.class_folders import assigned, lay_out, pack
from tests.classroom.lab6_class import read_class
from tests.examples import examples

FOLDER = "assignsubmission_file"


NAMES = st.text(
    st.characters(categories=["L", "M", "Nd", "Zs", "Po", "Pc", "Sm"], exclude_characters="&<>\"`|':\\/"),
    min_size=1,
    max_size=15,
)


@examples(30)
@given(st.dictionaries(st.integers(0, 10**12), NAMES, min_size=2, max_size=6))
def test_any_download_is_grouped_again(people: dict[int, str]) -> None:
    """Whatever participants are called, each is identified by number and name."""
    names = {str(number): " ".join(name.split()).strip(".") or "x" for number, name in people.items()}
    with tempfile.TemporaryDirectory() as folder:
        target = pack(Path(folder, "class.zip"), [f"{name}_{number}_{FOLDER}/a.zip" for number, name in names.items()])
        found = {submission.student.moodle: submission.student.name for submission in read_class(target).submissions()}
    are_hidden = len(set(names.values())) == 1
    assert found == {number: "" if are_hidden else name for number, name in names.items()}


def test_too_many_files_are_not_put_beside_a_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The folder of files is the submission then."""
    top = "Jane Doe_12_assignsubmission_file"
    names = (*(f"{top}/{name}" for name in "abc"), "Jane Doe_12_assignsubmission_onlinetext/onlinetext.html")
    monkeypatch.setattr("grader.classroom.intake.layouts.moodle._MAX_FILES", 2)
    intake = read_class(lay_out(tmp_path, *names))
    assert assigned(intake) == {"Jane Doe_12": (top,)}
    assert intake.ignored == (f"{top} has more than 2 files: the files beside it were not read",)
