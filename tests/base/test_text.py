"""Text for people: lists and counts in words."""

from grader.base.text import counted, enumerated, first_lines


def test_enumerated_names_all_items_or_counts_the_rest() -> None:
    """The last item follows the word; what exceeds the limit is counted."""
    assert enumerated([]) == ""
    assert enumerated(["a"]) == "a"
    assert enumerated(["a", "b"], word="or") == "a or b"
    assert enumerated(["a", "b", "c"], 3) == "a, b and c"
    assert enumerated(["a", "b", "c", "d"], 2) == "a, b and 2 more"


def test_first_lines_counts_the_rest_in_a_line() -> None:
    """A line says how many are missing; if none is, it is absent."""
    assert first_lines(["a", "b"], 2) == ["a", "b"]
    assert first_lines(["a", "b", "c"], 1) == ["a", "... and 2 more"]


def test_counted_agrees_with_its_noun() -> None:
    """One file, two files; an irregular plural is given."""
    assert [counted(1, "file"), counted(0, "file"), counted(2, "entry", "entries")] == [
        "1 file",
        "0 files",
        "2 entries",
    ]
