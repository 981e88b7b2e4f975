"""Reports of a class have unique file names that are safe on every system."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.classroom.reports.class_reports import file_names

pytestmark = pytest.mark.slow

AWKWARD = st.text(
    st.sampled_from('aA.-/\\:*?"<>| \u202e\u00e9e\u0301שß測😀\tcon01'), min_size=1, max_size=300
)


@given(st.lists(AWKWARD, max_size=8, unique=True))
def test_names_are_safe_and_distinct(keys: list[str]) -> None:
    """Names that differ in case or Unicode composition stay distinct."""
    names = file_names(keys)
    assert list(names) == keys
    assert len({unicodedata.normalize("NFC", name).casefold() for name in names.values()}) == len(
        keys
    )
    for name in names.values():
        assert not set(name) & set('/\\:*?"<>|\t\n')
        assert name[0] not in "-. "
        assert name[-1] not in ". "
        assert 0 < len(name.encode()) < 200


@pytest.mark.parametrize(
    "key", ["alice", "Alice Ash", "S700123", "O'Hara", "müller", "שלום", "a.b", "x(1)", "=1"]
)
def test_plain_names_stay_as_they_are(key: str) -> None:
    """Only unsafe characters are replaced; a space is kept."""
    name = file_names([key])[key]
    assert name == key or (" " in key and name.startswith("Alice_Ash-"))


@pytest.mark.parametrize("key", ["CON", "con", "nul.txt", "Lpt1", "COM9.a.b", "aux"])
def test_names_of_devices_are_avoided(key: str) -> None:
    """Windows has no files of such names."""
    assert file_names([key])[key].partition(".")[0] not in (key, key.partition(".")[0])


@pytest.mark.parametrize(
    "key", ["index", "INDEX", " Index.", "\u0131ndex", "\u0130NDEX", "ind\u200cex", "in\u00addex"]
)
def test_no_report_is_the_class_page(key: str) -> None:
    """Also where a file system ignores case, marks that are not seen, or spaces and dots at the end."""
    name = file_names([key])[key]
    seen = "".join(letter for letter in unicodedata.normalize("NFKC", name) if letter.isprintable())
    assert "index" not in (seen.casefold(), seen.upper().casefold(), seen.lower())


def test_a_name_depends_only_on_colliding_ones() -> None:
    """A report has the same name after the next run."""
    assert file_names(["a/b", "c"])["a/b"] == file_names(["a/b", "x", "y"])["a/b"]
    assert set(file_names(["ann", "Ann"]).values()).isdisjoint({"ann", "Ann"})
