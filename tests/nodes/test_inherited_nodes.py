"""Nodes whose class is derived from another class of the package."""

import pytest

from grader.ros.nodes.node_facts import NodeFacts
from tests.workspace.carts import cart

MANIFEST = """<package format="3"><name>lamp</name><version>1.0.0</version><description>d</description>
<maintainer email="a@example.org">a</maintainer><license>MIT</license>
<export><build_type>ament_python</build_type></export></package>
"""
SETUP = """from setuptools import setup
setup(name='lamp', packages=['lamp'], entry_points={'console_scripts': ['lamp = lamp.app:main']})
"""
BASE = """from rclpy.node import Node
from std_msgs.msg import Bool


class Base(Node):
    TOPIC = 'light'

    def __init__(self, name, **options):
        super().__init__(name, **options)
        self.lights = self.create_publisher(Bool, self.TOPIC, 10)
        self.create_timer(1.0, self.tick)
        self.listen()

    def listen(self):
        self.create_subscription(Bool, 'on', self.switch, 10)

    def switch(self, message):
        pass
"""
APP = """import rclpy
from lamp.base import Base


class Lamp(Base):
    def __init__(self):
        super().__init__('lamp')
        self.declare_parameter('power', 1.0)

    def tick(self):
        pass


def main():
    rclpy.init()
    rclpy.spin(Lamp())
"""


def lamp_node(app: str, base: str = BASE) -> NodeFacts:
    """Return the node of the class Lamp."""
    files = {
        "package.xml": MANIFEST,
        "setup.py": SETUP,
        "lamp/__init__.py": "",
        "lamp/base.py": base,
        "lamp/app.py": app,
    }
    [nodes] = cart(files).workspace.code.by_package.values()
    [node] = [node for node in nodes.nodes if node.class_name == "lamp.app.Lamp"]
    return node


def test_a_class_adds_what_its_base_declares_and_opens() -> None:
    """Its name passes through the constructor of the base, in another file or in the same one."""
    one_file = f"{BASE}\n\n{APP}".replace("from lamp.base import Base\n", "")
    for node in (lamp_node(APP), lamp_node(one_file)):
        assert node.name == "lamp"
        assert {(end.kind, end.name) for end in node.endpoints} == {
            ("publisher", "light"),
            ("subscription", "on"),
        }
        assert [parameter.name for parameter in node.parameters] == ["power"]
        assert len(node.timers) == 1
        assert node.doubts == ()


TWO_PACKAGES = {
    "app/package.xml": MANIFEST,
    "app/setup.py": SETUP,
    "app/lamp/__init__.py": "",
    "app/lamp/app.py": APP.replace("lamp.base", "light.base"),
    "base/package.xml": MANIFEST.replace("lamp", "light"),
    "base/setup.py": SETUP.replace("lamp", "light"),
    "base/light/__init__.py": "",
    "base/light/base.py": BASE,
}


def test_a_base_may_be_in_another_package() -> None:
    """The class of the base stays a node of its package alone."""
    nodes = cart(TWO_PACKAGES).workspace.code.by_package
    assert [node.class_name for node in nodes["light"].nodes] == ["light.base.Base"]
    assert nodes["light"].faults == ()  # tick() is a method of the other package's class
    [node] = nodes["lamp"].nodes
    assert (node.name, node.doubts) == ("lamp", ())
    assert [end.location.path for end in node.endpoints] == ["base/light/base.py"] * 2


def test_what_a_base_opens_may_be_used_in_its_package() -> None:
    """No module that has a base class of the node needs to use it."""
    text = "def switch(node):\n    node.lights.publish(True)\n"
    files = {**TWO_PACKAGES, "base/light/switch.py": text}
    [node] = cart(files).workspace.code.by_package["lamp"].nodes
    assert not any(end.is_unused for end in node.endpoints if end.kind == "publisher")


def test_a_base_may_use_what_a_class_opens() -> None:
    """The publisher of a class in one package is used by the base in another one."""
    opens = "        self.own = self.create_publisher(Int8, 'own', 10)\n        self.declare_p"
    app = TWO_PACKAGES["app/lamp/app.py"].replace("        self.declare_p", opens)
    files = {
        **TWO_PACKAGES,
        "app/lamp/app.py": f"from std_msgs.msg import Int8\n{app}",
        "base/light/base.py": BASE.replace("pass", "self.own.publish(message)"),
    }
    [node] = cart(files).workspace.code.by_package["lamp"].nodes
    assert [end.is_unused for end in node.endpoints if end.name == "own"] == [False]


@pytest.mark.parametrize("folder", ["app/base", "base"])
def test_a_base_is_not_in_a_package_that_is_not_built(folder: str) -> None:
    """One that is in another one, or that colcon ignores, gives a class nothing."""
    files = {path.replace("base/", f"{folder}/", 1): text for path, text in TWO_PACKAGES.items()}
    if folder == "base":
        files["base/COLCON_IGNORE"] = ""
    [node] = cart(files).workspace.code.by_package["lamp"].nodes or [None]
    assert not node or not node.endpoints


NAMES = [
    ("super().__init__('lamp')", "super().__init__(name='other')", "other"),
    ("super().__init__('lamp')", "Base.__init__(self, 'other')", "other"),
    ("super().__init__('lamp')", "super().__init__()", None),
    ("super().__init__('lamp')", "super().__init__(NAME)", None),
    ("class Lamp", "NAME = 'far'\n\n\nclass Lamp", "lamp"),
    ("    def __init__(self):\n        super().__init__('lamp')\n", "    def other(self):\n", None),
]


@pytest.mark.parametrize(("old", "new", "name"), NAMES)
def test_the_name_of_a_node_passes_through(old: str, new: str, name: str | None) -> None:
    """One that is computed, or that only who makes the node knows, is not known."""
    node = lamp_node(APP.replace(old, new))
    assert node.name == name
    assert len(node.endpoints) == 2


def test_the_name_may_be_a_default_or_be_bound_again() -> None:
    """A name that the constructor of the base binds again is not known."""
    app = APP.replace("super().__init__('lamp')", "super().__init__()")
    assert lamp_node(app, BASE.replace("self, name, ", "self, name='lamp', ")).name == "lamp"
    again = "        name = name + '2'\n        super().__init__(name, **options)"
    base = BASE.replace("        super().__init__(name, **options)", again)
    assert lamp_node(APP, base).name is None


OPEN = [
    ("def tick(self)", "def listen(self)"),
    ("    def __init__(self)", "    TOPIC = 'other'\n\n    def __init__(self)"),
    (
        "        super().__init__('lamp')\n",
        "        self.TOPIC = 'x'\n        super().__init__('lamp')\n",
    ),
    ("        super().__init__('lamp')\n", ""),
    (
        "        super().__init__('lamp')\n",
        "        if Base:\n            super().__init__('lamp')\n",
    ),
    ("class Lamp(Base)", "class Lamp(Base, Other)"),
    ("class Lamp(Base)", "@decorated\nclass Lamp(Base)"),
]


@pytest.mark.parametrize(("old", "new"), OPEN)
def test_what_a_class_may_replace_is_open(old: str, new: str) -> None:
    """An attribute or a method that decides what the base does, the constructor, another base."""
    changed = APP.replace(old, new)
    assert changed != APP
    node = lamp_node(changed)
    assert "what another base class does is not added" in [doubt.reason for doubt in node.doubts]


OPTIONS = [
    ("'lamp', namespace='far'", True),
    ("'lamp', allow_undeclared_parameters=False", False),
    ("'lamp', **self.options", True),
]


@pytest.mark.parametrize(("given", "is_open"), OPTIONS)
def test_more_arguments_of_a_node_are_passed_on(given: str, is_open: bool) -> None:
    """Those that change nothing leave nothing open."""
    node = lamp_node(APP.replace("'lamp'", given, 1))
    assert bool(node.doubts) == is_open


def test_classes_that_are_derived_from_each_other_are_no_nodes() -> None:
    """They end nowhere; a decorated constructor may do anything."""
    base = BASE.replace("    def __init__", "    @wrapped\n    def __init__")
    assert lamp_node(APP, base).doubts
    assert lamp_node(APP, BASE.replace("(Node)", "(Far, Node)")).doubts
