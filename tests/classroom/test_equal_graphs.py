"""Students whose graphs are equal but for names are listed beside equal work."""

import json
from pathlib import Path
from shutil import copytree

import pytest

from grader.workspace.graph.graph_form import graph_form
from tests.command_line import run
from tests.labs.test_graph_labs import rubric_text, written
from tests.workspace.launch_graphs import graph_of_actions

pytestmark = pytest.mark.slow
_TALKER = "Node(package='demo', executable='talker', name='{0}', remappings=[('answer', '{1}')])"
_LABEL = "the same graph of nodes, but for names"


def renamed(workspace: Path) -> None:
    """Give a node and the topic between nodes other names."""
    launch = workspace / "hallway/launch/hallway.launch.py"
    text = launch.read_text().replace('executable="eye"', 'executable="eye", name="looker"')
    launch.write_text(text.replace('"smooth")', '"calm")'))
    smoother = workspace / "hallway/hallway/smoother.py"
    smoother.write_text(smoother.read_text().replace('"smooth"', '"calm"'))


def test_a_class_lists_equal_graphs(tmp_path: Path) -> None:
    """Not the graph of the solution, which the handout asks for."""
    (tmp_path / "reference").mkdir()
    solution = written("hallway", "solution", tmp_path / "reference")
    text = rubric_text("hallway").replace('title = "Lab"', 'title = "Lab"\nreference = "reference"')
    (tmp_path / "lab.toml").write_text(text, "utf-8")
    for student in ("ash", "birch"):
        copytree(solution, tmp_path / "class" / student)
    for student in ("cedar", "elm"):
        written("hallway", "r2-split-in-two", tmp_path / "class" / student)
    renamed(tmp_path / "class/elm/hallway")
    written("hallway", "w4-not-started", tmp_path / "class/fir")
    book = tmp_path / "book"
    words = [
        "--rubric",
        tmp_path / "lab.toml",
        "--gradebook",
        book,
        "--jobs",
        "1",
        "--report-format",
        "html",
    ]
    assert run(["batch", tmp_path / "class", *words]).returncode == 0
    done = run(["stats", "--gradebook", book, "--format", "json"])
    equal = json.loads(done.stdout)["equal"]
    assert [(row["students"], row["equal"]) for row in equal] == [(["cedar", "elm"], _LABEL)]
    assert _LABEL in (next(book.rglob("index.html"))).read_text("utf-8")


def test_the_form_of_a_graph() -> None:
    """Names do not matter, types and what is connected do; small graphs have no form."""
    three = [_TALKER.format(name, f"/{name}/reply") for name in "abc"]
    other = [_TALKER.format(name, f"/{name}/answer") for name in "xyz"]
    joined = [_TALKER.format(name, "/reply") for name in "abc"]
    first = graph_form(graph_of_actions(*three))
    assert first == graph_form(graph_of_actions(*other)) != ""
    assert first != graph_form(graph_of_actions(*joined))
    assert graph_form(graph_of_actions(*three[:2])) == ""
