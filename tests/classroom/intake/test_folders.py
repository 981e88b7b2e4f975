"""The plain layout: a folder, archive or URDF for each student, attempts, copies, and names with a prefix."""

from hashlib import sha256
from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.intake.names import ENDINGS, ending_of
from tests.classroom.class_folders import assigned, lay_out
from tests.classroom.lab6_class import read_class

AWKWARD = ["=cmd()", 'quo"te', "com,ma", "Müller, Jörg", "עדה", "@x", "a\nb", "<b>", "ann ~2", "%00"]


def test_awkward_names(tmp_path: Path) -> None:
    """Names of all kinds are keys unchanged; for unprintable ones the key is the path and a digest."""
    lay_out(tmp_path, *(f"{name}/" for name in AWKWARD))
    printable = {name for name in AWKWARD if name.isprintable()}
    (odd,) = set(assigned(read_class(tmp_path))) - printable
    assert odd == f"./a\\x0ab-{sha256(b'a' + bytes([10]) + b'b').hexdigest()}"
    assert printable < set(assigned(read_class(tmp_path)))


@given(st.text(), st.sampled_from(ENDINGS))
def test_an_ending_is_found_after_any_name(stem: str, ending: str) -> None:
    """After a name without a similar ending, an ending is found whole."""
    if ending_of(f"{stem}{ending}") != ending:
        assert stem.lower().endswith((".tar", ".urdf"))
