"""Canvas' bulk download: the owner of each file, lateness, and resubmissions."""

import re
import tempfile
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.matching import canvas_name
from tests.classroom.class_folders import pack
from tests.classroom.lab6_class import read_class
from tests.examples import examples

WORDS = st.text(st.characters(categories=["L", "M", "Nd", "Pc", "Zs", "Po"]), min_size=1, max_size=12)
ORIGINAL = st.from_regex(r"[A-Za-z][A-Za-z0-9_ ]{0,9}\.(zip|png|urdf|tar\.gz)", fullmatch=True)


@examples(30)
@given(
    st.dictionaries(
        st.integers(1, 10**15),
        st.tuples(WORDS, st.booleans(), st.dictionaries(ORIGINAL, st.just(None), min_size=1, max_size=4)),
        min_size=1,
        max_size=6,
    )
)
def test_any_download_is_grouped_again(people: dict[int, tuple[str, bool, dict[str, None]]]) -> None:
    """Whatever students and files are called, Canvas' names for them give the same submissions."""
    attachment, names, expected = 1000, [], {}
    for user, (name, is_late, originals) in people.items():
        shown = re.sub(r"_\d+$", "", canvas_name(name))
        for original in originals:
            attachment += 1
            names.append(f"{shown}{'_LATE' if is_late else ''}_{user}_{attachment}_{original}")
        expected[str(user)] = (is_late, sorted(originals))
    with tempfile.TemporaryDirectory() as folder:
        intake = read_class(pack(Path(folder, "submissions.zip"), names), layout="canvas")
    assert {
        submission.student.canvas: (submission.is_late, sorted(submission.names)) for submission in intake.submissions()
    } == expected
