"""Mutants of the code of nodes, and of interfaces."""

from collections import Counter

import pytest

from grader.base.source import Source
from grader.lab.authoring.node_mutants import node_changes
from grader.workspace.rules.rule_table import Family
from tests.workspace.carts import cart
from tests.workspace.test_nodes import laundry_files

pytestmark = pytest.mark.slow

TOPICS: tuple[Family, ...] = ("topics",)
CODE: tuple[Family, ...] = ("code",)


def test_interfaces_and_code_have_mutants() -> None:
    """Fields and separators of files, and what nodes import, use and do."""
    submission = cart(laundry_files())
    found = Counter[str]()
    for path, text in laundry_files().items():
        for change in node_changes(submission, Source(path, text), ("interfaces", "code")):
            assert text[change.start : change.end] != change.new
            found[change.mutation] += 1
    assert found == {
        "field renamed": 10,
        "separator removed": 3,
        "name misspelt": 31,
        "spin removed": 3,
        "callback called": 5,
        "response not returned": 1,
        "response replaced": 1,
        "callback parameter added": 3,
        "callback parameter removed": 3,
        "constructor after its use": 2,
        "message of a class": 2,
        "spin of a class": 2,
        "init removed": 3,
        "constructor removed": 3,
        "declaration removed": 5,
        "quality of service changed": 2,
        "call awaited": 1,
        "interface not generated": 3,
        "field type changed": 9,
    }


PYTHON = """import rclpy
class Lamp(Node):
    def __init__(self):
        super().__init__('lamp')
        self.lights = self.create_publisher(Bool, 'light', 10)
        self.create_timer(1.0, self.tick)
        self.create_timer(1.0, unknown)
        self.create_subscription(Bool, 'on', self.switch, 5)
    def tick(self):
        light = Bool()
        self.lights.publish(light)
        self.lights.publish(self.made())
    def switch(self, message, count=0):
        pass
def main():
    node = Lamp()
    rclpy.spin(node)
"""


def test_nodes_in_python_have_mutants() -> None:
    """Each is what rclpy refuses for certain."""
    source = Source("lamp.py", PYTHON)
    changes = node_changes(cart(laundry_files()), source, CODE)
    found = {(it.mutation, PYTHON[it.start : it.end], it.new) for it in changes}
    order = "self.lights = self.create_publisher(Bool, 'light', 10)"
    init = "super().__init__('lamp')"
    assert found >= {
        ("callback parameter added", "", ", event"),
        ("message of a class", "light", "Bool"),
        ("spin of a class", "node", "Lamp"),
        ("quality of service as text", "10", "'10'"),
        ("quality of service as text", "5", "'5'"),
        ("constructor after its use", f"{init}\n        {order}", f"{order}\n        {init}"),
    }
    assert not any(mutation == "callback parameter removed" for mutation, _, _ in found)


def test_a_family_that_is_not_compared_has_no_mutants() -> None:
    """A criterion has to look at it."""
    submission = cart(laundry_files())
    for path, text in laundry_files().items():
        assert [*node_changes(submission, Source(path, text), TOPICS)] == []


CPP = """#include "rclcpp/rclcpp.hpp"
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<Beacon>();
  node->get_logger();
  rclcpp::spin(node);
}
"""


def test_nodes_in_cpp_have_mutants() -> None:
    """Without what initialises rclcpp, or what spins."""
    source = Source("src/beacon.cpp", CPP)
    found = [*node_changes(cart(laundry_files()), source, CODE)]
    assert [(it.mutation, CPP[it.start : it.end].strip()) for it in found] == [
        ("spin removed", "rclcpp::spin(node);"),
        ("init removed", "rclcpp::init(argc, argv);"),
    ]
