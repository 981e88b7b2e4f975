"""Moodle's bulk download: folders or files, files and texts, teams, and hidden names."""

import tempfile
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from tests.classroom.class_folders import pack
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
