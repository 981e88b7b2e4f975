"""Whatever is wrong with a rubric's TOML, there is one short complaint with a place; `tests/corpus/rubrics` has the messages."""

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import RubricError
from grader.base.toml_file import read_toml
from grader.lab.rubric.rubric import shipped_rubrics
from tests.examples import examples

pytestmark = pytest.mark.slow

SHIPPED = next(iter(shipped_rubrics().values())).read_text(encoding="utf-8")[:3000]


@pytest.mark.parametrize(
    "text",
    [
        "a = " + "b" * 1_000_000,
        "b" * 1_000_000 + " c",
        "a = [" + "1 " * 500_000,
        'a = "' + "b" * 1_000_000,
    ],
)
def test_long_lines_are_cut(text: str) -> None:
    """Only the text around the mistake is looked at and shown."""
    with pytest.raises(RubricError) as caught:
        read_toml(text.encode(), Path("lab.toml"))
    (complaint,) = caught.value.complaints
    assert complaint.startswith("lab.toml:1:")
    assert len(complaint) < 500


@examples(20)
@given(
    st.integers(0, len(SHIPPED)),
    st.integers(0, 3),
    st.text("\"'[]{}=,.\n\r#\\ aT1“\0\u00a0", max_size=3),
)
def test_no_text_is_a_crash(at: int, deleted: int, inserted: str) -> None:
    """Whatever a typing error does to a rubric, it is TOML, or there is one complaint with a place."""
    text = SHIPPED[:at] + inserted + SHIPPED[at + deleted :]
    try:
        read_toml(text.encode(), Path("lab.toml"))
    except RubricError as error:
        (complaint,) = error.complaints
        _, line, column, what = complaint.split(":", 3)
        assert 1 <= int(line) <= text.count("\n") + 1
        assert int(column) >= 1
        assert what.isprintable()
