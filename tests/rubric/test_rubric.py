"""Loading a rubric: its digest, exact points, and files of any size and kind; mistakes are in `tests/corpus/rubrics`."""

import os
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.base.errors import InputError, RubricError
from grader.lab.rubric.rubric import Rubric, load_rubric, shipped_rubrics
from tests.command_line import ROOT
from tests.examples import examples

SMALL = (ROOT / "tests/corpus/rubrics/small.toml").read_text(encoding="utf-8")


def write(folder: Path, text: str) -> str:
    """Return the path of a rubric with this content."""
    path = folder / "rubric.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def loaded(folder: Path, text: str) -> Rubric:
    """Return the rubric in a text without mistakes."""
    return load_rubric(write(folder, text))


def test_arguments_have_the_types_of_their_checks(tmp_path: Path) -> None:
    """Integers are accepted as floats; lists become tuples if the check has one."""
    given = 'with = { link = "w", base = "b", forward = [1, 0, 0], tolerance = 1 }'
    (criterion,) = loaded(tmp_path, SMALL.replace("urdf_loads", "rolls_forward") + given).criteria
    assert criterion.arguments == {
        "link": "w",
        "base": "b",
        "forward": (1.0, 0.0, 0.0),
        "tolerance": 1.0,
    }
    assert isinstance(criterion.arguments["forward"], tuple)
    assert isinstance(criterion.arguments["tolerance"], float)


def test_the_digest_is_of_the_bytes(tmp_path: Path) -> None:
    """Two files with the same meaning but different bytes are different rubrics; one of Windows means the same."""
    one = loaded(tmp_path, SMALL)
    for text in (SMALL + "# a comment\n", SMALL.replace("\n", "\r\n")):
        other = loaded(tmp_path, text)
        assert one.sha256 != other.sha256
        assert one.criteria == other.criteria


@pytest.mark.parametrize("name", sorted(shipped_rubrics()))
def test_shipped_rubrics_load(name: str) -> None:
    """Every shipped rubric loads by its id as by its path."""
    rubric = load_rubric(name)
    assert (rubric.id, rubric.points > 0) == (name, True)
    by_path = load_rubric(str(shipped_rubrics()[name]))
    assert (by_path.sha256, by_path.criteria) == (rubric.sha256, rubric.criteria)


def test_a_late_policy_is_read(tmp_path: Path) -> None:
    """Missing values have their defaults; the deadline keeps its offset."""
    late = loaded(
        tmp_path, SMALL + "[late]\ndue = 2026-11-20T23:59:00+01:00\npercent_per_day = 10.5\n"
    ).late
    assert late is not None
    assert late.due is not None
    assert late.due.isoformat() == "2026-11-20T23:59:00+01:00"
    assert [late.grace_minutes, late.percent_per_day, late.floor_percent] == [
        Decimal(0),
        Decimal("10.5"),
        Decimal(0),
    ]


def worth(points: list[str], total: str) -> str:
    """Return a rubric with criteria of these points, whose totals are declared."""
    head, _, criterion = SMALL.partition("[[criterion]]")
    head = head.replace("[[part]]", f"points = {total}\n[[part]]").replace(
        '"Part A"', f'"Part A"\npoints = {total}'
    )
    rows = (
        criterion.replace("loads", f"c{index}", 1).replace("= 1\n", f"= {one}\n")
        for index, one in enumerate(points)
    )
    return head + "".join(f"[[criterion]]{row}" for row in rows)


@pytest.mark.parametrize(
    ("points", "total"),
    [
        (["0.1", "0.2"], "0.3"),
        (["0.1"] * 10, "1"),
        (["1e-3", "0.999"], "1"),
        (["0.1", "0.7"], "8e-1"),
        (["1_000.5", "0.5"], "1_001"),
        (["0.0001", "1"], "1.0001"),
        (["0.50000", "0.5"], "1"),
    ],
)
def test_points_are_exact(tmp_path: Path, points: list[str], total: str) -> None:
    """Points add up as on paper, not as floats do."""
    rubric = loaded(tmp_path, worth(points, total))
    assert rubric.points == Decimal(total)
    assert [criterion.points for criterion in rubric.criteria] == [
        Decimal(value) for value in points
    ]


@examples(10)
@given(cents=st.lists(st.integers(0, 10_000), min_size=1, max_size=20))
def test_any_points_in_hundredths_add_up(
    tmp_path_factory: pytest.TempPathFactory, cents: list[int]
) -> None:
    """However many criteria share the points, the declared total is their exact sum, and one cent more is refused."""
    folder = tmp_path_factory.mktemp("rubric")
    points = [f"{cent // 100}.{cent % 100:02d}" for cent in cents]
    total, wrong = (f"{cent // 100}.{cent % 100:02d}" for cent in (sum(cents), sum(cents) + 1))
    assert loaded(folder, worth(points, total)).points * 100 == sum(cents)
    with pytest.raises(RubricError) as caught:
        loaded(folder, worth(points, wrong))
    assert len(caught.value.complaints) == 2


@pytest.mark.parametrize(
    "text",
    [
        "x = " + "[" * 100_000,
        "[" + ".".join("a" * 5000) + "]\nx = 1\n",
        "x = '''" + "[" * 100_000 + "'''\n",
        "x = 1" + "0" * 5000,
        ".".join("a" * 5000) + " = 1\n",
    ],
    ids=["open", "header", "only-text", "digits", "dotted"],
)
def test_extreme_values_cause_no_crash(tmp_path: Path, text: str) -> None:
    """Endless brackets and numbers are a mistake in the rubric, which is reported."""
    with pytest.raises(RubricError):
        loaded(tmp_path, text + SMALL)


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    """A folder and a pipe are refused at once, and a huge file is not read."""
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(InputError, match="not a regular file"):
        load_rubric(str(tmp_path / "pipe.toml"))
    with pytest.raises(InputError, match="larger than"):
        loaded(tmp_path, SMALL + "#" * (1 << 21))
