"""The page of a graded submission shows its graph where the rubric asks about that."""

from pathlib import Path

import pytest

from tests.command_line import run
from tests.labs.test_graph_labs import rubric_text, written

pytestmark = pytest.mark.slow
_START = '<h2 id="graph-title">'


def graph_on_page(path: Path, rubric: Path) -> str:
    """Return the part of a submission's page that shows its graph; empty without one."""
    done = run(["grade", path, "--rubric", rubric, "--hints", "none", "--format", "html"])
    return done.stdout.decode().partition(_START)[2].partition("</section>")[0]


@pytest.fixture
def rubric(tmp_path: Path) -> Path:
    """Return a rubric with criteria about the graph."""
    file = tmp_path / "lab.toml"
    file.write_text(rubric_text("hallway"), "utf-8")
    return file


def test_a_page_shows_the_graph_of_the_submission(rubric: Path, tmp_path: Path) -> None:
    """With its own names, not those of the solution."""
    drawn = graph_on_page(written("hallway", "r1-other-names", tmp_path), rubric)
    assert drawn.startswith("What hallway/launch/hallway.launch.py connects</h2>")
    assert "/looker" in drawn and "/wall/distance" in drawn
    assert ">/eye<" not in drawn and ">/nearest<" not in drawn


def test_the_launch_file_that_is_asked_for_is_shown(rubric: Path, tmp_path: Path) -> None:
    """Not the first one."""
    named = rubric.read_text().replace('"map", child', '"map", launch = "frames.launch.xml", child')
    rubric.write_text(named)
    drawn = graph_on_page(written("hallway", "r4-two-files", tmp_path), rubric)
    assert drawn.startswith("What hallway/launch/frames.launch.xml connects</h2>")


def test_without_such_a_criterion_there_is_no_graph(rubric: Path, tmp_path: Path) -> None:
    """Neither without a launch file, nor where it starts nothing."""
    solution = written("hallway", "solution", tmp_path)
    launch = solution / "hallway/launch/hallway.launch.py"
    launch.write_text(
        "from launch import LaunchDescription\n\n\n"
        "def generate_launch_description():\n    return LaunchDescription([])\n"
    )
    assert graph_on_page(solution, rubric) == ""
    launch.unlink()
    assert graph_on_page(solution, rubric) == ""
    plain = rubric.read_text().partition("[[criterion]]")[0]
    plain += '[[criterion]]\nid = "a"\ntitle = "a"\npart = "nodes"\npoints = 1\n'
    rubric.write_text(plain + 'check = "package_found"\nwith = { name = "hallway" }\n')
    assert graph_on_page(written("hallway", "solution", tmp_path / "other"), rubric) == ""


@pytest.mark.parametrize(("count", "length"), [(80, 5), (80, 200), (30, 30), (12, 3000)])
def test_a_graph_is_at_most_20_kb(rubric: Path, tmp_path: Path, count: int, length: int) -> None:
    """Of many nodes the first are drawn."""
    solution = written("hallway", "solution", tmp_path)
    launch = solution / "hallway/launch/hallway.launch.py"
    name = "n" * length
    nodes = "".join(
        f'Node(package="hallway", executable="eye", name="{name}{number}"),\n        '
        for number in range(count)
    )
    before = 'Node(package="hallway", executable="eye"),'
    launch.write_text(launch.read_text().replace(before, nodes))
    drawn = graph_on_page(solution, rubric)
    assert len(drawn) < 20_000
    assert drawn.count('class="item') > 9
