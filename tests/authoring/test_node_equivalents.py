"""Equivalents of packages with nodes: what they change, and that they are what the solution is."""

from pathlib import Path

import pytest

from grader.files.tree import overlaid
from grader.lab.authoring.node_equivalents import node_equivalents
from grader.lab.submission.opening import open_with_packages
from grader.lab.submission.submission import Submission
from grader.workspace.api import launch_graph
from grader.workspace.rules.reading import read_agreement

pytestmark = pytest.mark.slow

MANIFEST = """<package format="3"><name>pair</name><version>0.1.0</version><description>d</description>
<maintainer email="a@example.org">a</maintainer><license>MIT</license>
<depend>rclpy</depend><depend>std_msgs</depend>
<exec_depend>launch</exec_depend><exec_depend>launch_ros</exec_depend>
<export><build_type>ament_python</build_type></export></package>"""
SETUP = """from glob import glob
from setuptools import find_packages, setup

setup(
    name='pair',
    version='0.1.0',
    packages=find_packages(),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/pair']),
        ('share/pair', ['package.xml']),
        ('share/pair/launch', glob('launch/*')),
        ('share/pair/config', glob('config/*.yaml')),
    ],
    entry_points={'console_scripts': ['giver = pair.giver:main', 'taker = pair.taker:main']},
)
"""
GIVER = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


class Giver(Node):
    def __init__(self):
        super().__init__('giver')
        self.declare_parameter('step', 1)
        self.publisher = self.create_publisher(Int32, 'number', 10)
        self.create_timer(1.0, self.give)

    def give(self):
        self.publisher.publish(Int32(data=self.get_parameter('step').value))


def main():
    rclpy.init()
    rclpy.spin(Giver())
"""
TAKER = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Int32


class Taker(Node):
    def __init__(self):
        super().__init__('taker')
        self.declare_parameter('factor', 2.0)
        self.create_subscription(Int32, 'number', self.take, 10)

    def take(self, message):
        self.get_logger().info(str(message.data * self.get_parameter('factor').value))


def main():
    rclpy.init()
    rclpy.spin(Taker())
"""
LAUNCH = """from launch import LaunchDescription
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    numbers = PathJoinSubstitution([FindPackageShare('pair'), 'config', 'pair.yaml'])
    taker = Node(package='pair', executable='taker', parameters=[{'factor': 3.0}])
    return LaunchDescription([
        Node(package='pair', executable='giver', name='giver', parameters=[numbers]),
        taker,
    ])
"""
PAIR = {
    "pair/package.xml": MANIFEST,
    "pair/setup.py": SETUP,
    "pair/setup.cfg": "[install]\ninstall_scripts=$base/lib/pair\n",
    "pair/resource/pair": "",
    "pair/pair/__init__.py": "",
    "pair/pair/giver.py": GIVER,
    "pair/pair/taker.py": TAKER,
    "pair/config/pair.yaml": "giver:\n  ros__parameters:\n    step: 5\n",
    "pair/launch/pair.launch.py": LAUNCH,
}
EVERY_FAMILY = {
    "parameters in the launch file",
    "parameters in a parameter file",
    "names remapped",
    "two nodes in one program",
}


def write_pair(folder: Path, changes: dict[str, str]) -> Submission:
    """Write the package with other texts, and open it."""
    changed = set()
    for path, text in PAIR.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        for old, new in changes.items():
            if old in text:
                text = text.replace(old, new)
                changed.add(old)
        (folder / path).write_text(text)
    assert changed == changes.keys()
    return open_with_packages(str(folder))


def rewritings(submission: Submission, named: tuple[str, ...] = ()) -> dict[str, Submission]:
    """Return the submission as each rewriting leaves it."""
    assert submission.reopen is not None
    rewritten = {}
    for rewriting, texts in node_equivalents(submission, named):
        files = {path: None if text is None else text.encode() for path, text in texts.items()}
        rewritten[rewriting] = submission.reopen(overlaid(submission.whole_tree, files))
    return rewritten


def running(submission: Submission) -> set[tuple[object, ...]]:
    """Return the nodes that run, what each opens, and the parameters that it gets."""
    found: set[tuple[object, ...]] = set()
    [path] = [launch.source.path for launch in submission.workspace.launches.outermost]
    for node in launch_graph(submission.workspace, path).nodes:
        assert not node.doubt + node.opens_more
        found |= {(node.name, end.kind, end.name, end.type) for end in node.ends}
        found |= {(node.name, given.name, given.value) for given in node.parameters}
    return found


def test_nodes_are_started_in_other_ways(tmp_path: Path) -> None:
    """The same nodes run, by the same names, with the same parameters; nothing disagrees."""
    submission = write_pair(tmp_path, {})
    rewritten = rewritings(submission)
    assert rewritten.keys() == EVERY_FAMILY
    for rewriting, same in rewritten.items():
        assert not [row for row in read_agreement(same.workspace).mismatches if row.is_certain]
        # A table of the launch file is given to both nodes of a program.
        more = running(same) - running(submission)
        assert running(submission) <= running(same), rewriting
        assert not more or rewriting == "two nodes in one program"


@pytest.mark.parametrize(
    ("changes", "absent"),
    [
        ({"{'factor': 3.0}": "{'factor': input()}"}, {"parameters in a parameter file"}),
        ({"{'factor': 3.0}": "{'words': 'true'}"}, {"parameters in a parameter file"}),
        ({"step: 5": "step: []"}, {"parameters in the launch file"}),
        ({"'number'": "'/number'"}, {"names remapped"}),
        ({"'number'": "'num' + 'ber'"}, {"names remapped"}),
        ({"self):\n        super": "self, name):\n        super"}, {"two nodes in one program"}),
        ({"name='giver'": "name='other'"}, {"two nodes in one program"}),
        ({"parameters=[numbers]": "parameters=[{'factor': 1.0}]"}, {"two nodes in one program"}),
        ({"taker = pair.taker:main": "taker=pair.taker:main "}, {"two nodes in one program"}),
        ({"executable='taker'": "executable='taker', remappings=[('a', 'b')]"}, set()),
        ({"executable='taker'": "executable='taker', condition=input()"}, set()),
    ],
)
def test_what_is_not_all_known_is_not_rewritten(
    changes: dict[str, str], absent: set[str], tmp_path: Path
) -> None:
    """A value of run time, a text that launch reads as YAML, a class that needs an argument."""
    rewritten = rewritings(write_pair(tmp_path, changes))
    assert rewritten.keys() <= EVERY_FAMILY - absent


def test_a_program_that_a_rubric_names_stays(tmp_path: Path) -> None:
    """As it asks for the program, two nodes in another one are not the same."""
    rewritten = rewritings(write_pair(tmp_path, {}), ("pair/giver",))
    assert rewritten.keys() == EVERY_FAMILY - {"two nodes in one program"}
