"""Containers, components and nodes have the names, namespaces and remappings that the real launch_ros gives them."""

import json
from typing import Any

import pytest

from grader.ros.launch.launch_model import Launch, StartedNode
from tests.launch.record_components import FILE, text_of
from tests.workspace.launch_graphs import open_files

CASES: list[dict[str, Any]] = json.loads(FILE.read_text("utf-8"))


def read(case: dict[str, Any]) -> Launch:
    """Return the launch file of a case as it is read."""
    path = f"demo/launch/case.launch.{case['language']}"
    [package] = [each for each in open_files({path: text_of(case)}).packages if each.name == "demo"]
    return package.launch(path.removeprefix("demo/"))


def rules_of(node: StartedNode) -> list[str]:
    """Return the remappings of a node as launch_ros writes them."""
    assert node.remaps is not None
    return [":=".join(rule) for rule in node.remaps]


def test_there_are_two_hundred_cases() -> None:
    """Each with something that starts, or a condition that prevents it."""
    assert len(CASES) >= 200
    assert len({case["name"] for case in CASES}) == len(CASES)
    assert sum(not case["outcome"] for case in CASES) == 1


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["name"])
def test_what_is_started_and_loaded(case: dict[str, Any]) -> None:
    """It is what the real launch_ros starts and loads."""
    launch = read(case)
    components = [row for row in case["outcome"] if "component" in row]
    # Launch does not know that a node without a namespace is in that of its process.
    started = [
        row["node"].replace("<node_namespace_unspecified>", "")
        for row in case["outcome"]
        if "node" in row
    ]
    nodes = [node for node in launch.nodes if node.when]
    names = [node.full_name(node.node_name) for node in nodes if node.node_name]
    names += [each.name for each in launch.containers if each.when and each.name is not None]
    unnamed = [name for name in started if "<node_name_unspecified>" in name]
    assert sorted(names) == sorted({*started} - {*unnamed})
    assert len(nodes) + sum(each.when is True for each in launch.containers) == len(started)
    loaded = [each for each in launch.components if each.when]
    assert len(loaded) == len(components)
    for component, row in zip(loaded, components, strict=True):
        node = component.node
        assert node is not None
        assert node.executable == row["component"]
        assert (node.node_name or "") == row["name"]
        assert f"/{(node.namespace or '').strip('/')}" == (row["namespace"] or "/")
        assert rules_of(node) == row["remaps"]
        if component.container:
            assert component.container.strip("/") == row["container"].strip("/")
