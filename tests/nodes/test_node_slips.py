"""What keeps a node in Python from running: it is found where it is certain, and nowhere else."""

import pytest

from grader.base.element_edits import edited
from tests.nodes.programs import slips_of
from tests.samples import ROOT

pytestmark = pytest.mark.slow

SCRIPT = (ROOT / "rubrics/diffdrive/diffdrive_robot/scripts/drive_circle.py").read_text()
SEND = "        command = TwistStamped()\n"
CREATE = "        self.publisher = self.create_publisher("


def reactions(text: str, *, is_script: bool = True) -> list[str]:
    """Return what is found in a program, whose corrections leave nothing to be found, and move no line."""
    slips = slips_of(text, is_script=is_script)
    corrected = text
    for slip in reversed(slips):
        corrected = edited(corrected, slip.location.path, slip.edits) or ""
    assert not slips or slips_of(corrected, is_script=is_script) == []
    assert corrected.count("\n") == text.count("\n") or "main()" in slips[0].reaction
    return [slip.reaction for slip in slips]


@pytest.mark.parametrize(
    ("old", "new", "reaction"),
    [
        (
            '        super().__init__("drive_circle")\n',
            "",
            "self.declare_parameter() needs what super().__init__() makes, which is not called",
        ),
        ("command.twist.linear", "command.linear", "geometry_msgs/msg/TwistStamped has no field"),
        ("command.header.stamp", "command.headr.stamp", "geometry_msgs/msg/TwistStamped has no"),
        ("self.publisher.publish", "self.publisher_.publish", "DriveCircle has no attribute pub"),
        ("self.create_publisher", "self.create_publishr", "DriveCircle has no attribute create_p"),
        (
            "0.1, self.send",
            "0.1, self.send()",
            "create_timer() is given what self.send() returns, which is None",
        ),
        ("    rclpy.init()\n", "", "rclpy.init() is missing, so rclpy makes no node"),
        (
            "rclpy.spin(DriveCircle())",
            "DriveCircle()",
            "nothing spins the node, so none of its callbacks",
        ),
        (
            "rclpy.spin(DriveCircle())",
            "node = DriveCircle()",
            "nothing spins the node, so none of its callbacks",
        ),
        ("import rclpy\n", "", "undefined name 'rclpy'"),
        ("from rclpy.node import Node\n", "", "undefined name 'Node'"),
        (
            "from geometry_msgs.msg import TwistStamped\n",
            "",
            "undefined name 'TwistStamped'",
        ),
        ("= TwistStamped()", "= TwistStampd()", "undefined name 'TwistStampd'"),
        (SEND, f"{SEND}        command.twist.linear.y = math.sin(0)\n", "undefined name 'math'"),
        ("    main()\n", "    pass\n", "main() is never called, so the program does nothing"),
        ('== "__main__"', '== "main"', "main() is never called, so the program does nothing"),
    ],
)
def test_what_keeps_a_node_from_running(old: str, new: str, reaction: str) -> None:
    """It is named, and nothing else."""
    assert old in SCRIPT
    [found] = reactions(SCRIPT.replace(old, new))
    assert found.startswith(reaction)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("", ""),
        # Under a condition, or caught.
        (SEND, f"{SEND}        if self.speed:\n            math.sin(0)\n"),
        (
            SEND,
            f"{SEND}        try:\n            math.sin(0)\n        except NameError:\n            pass\n",
        ),
        # After the node was stopped.
        ("rclpy.spin(DriveCircle())", "rclpy.spin(DriveCircle())\n    math.sin(0)"),
        # Other functions call rclpy, or keep the program alive.
        ("    rclpy.init()\n", "    rclpy.init(args=None)\n"),
        ("    rclpy.init()\n", "    with rclpy.init():\n        pass\n"),
        ("import rclpy\n", "import rclpy\nfrom own.tools import begin\n"),
        (
            "    rclpy.spin(DriveCircle())",
            "    node = DriveCircle()\n    while rclpy.ok():\n        rclpy.spin_once(node)",
        ),
        # What a node has itself, and what is set from outside.
        ("self.get_parameter(", "self.get_parameters("),
        (CREATE, f"        list(self.publishers)\n{CREATE}"),
        ("    main()\n", "    import sys\n    sys.exit(main())\n"),
        (
            "def send(self):\n",
            "def send(self, command=None):\n        command = command or TwistStamped()\n        command.linear\n",
        ),
        ("from geometry_msgs.msg import TwistStamped\n", "from geometry_msgs.msg import *\n"),
        ("import rclpy\n", "import rclpy\nexec('math = 1')\n"),
    ],
)
def test_what_may_run(old: str, new: str) -> None:
    """Nothing is said of it."""
    assert old in SCRIPT
    assert reactions(SCRIPT.replace(old, new)) == []


@pytest.mark.parametrize("module", ["cv2", "tf_transformations", "my_srvs.srv"])
def test_what_does_nothing_for_rclpy(module: str) -> None:
    """A node that imports it and is not spun certainly does nothing."""
    text = SCRIPT.replace("import rclpy\n", f"import rclpy\nimport {module}\n")
    assert reactions(text) == []
    [found] = reactions(text.replace("rclpy.spin(DriveCircle())", "DriveCircle()"))
    assert found.startswith("nothing spins the node")


def test_the_server_of_an_action_calls_its_callback() -> None:
    """It is a callback like that of a timer."""
    server = "        ActionServer(self, Reset, 'drive', self.send())\n"
    imports = "from rclpy.action import ActionServer\nfrom my_actions.action import Reset\n"
    text = SCRIPT.replace(CREATE, server + CREATE).replace(
        "import rclpy\n", f"import rclpy\n{imports}"
    )
    [found] = reactions(text)
    assert (
        found
        == "ActionServer() is given what self.send() returns, which is None; write self.send without the parentheses"
    )
    assert reactions(text.replace("self.send())\n", "self.send)\n", 1)) == []


def test_an_entry_point_calls_its_function() -> None:
    """Then the end of the file does not count, and names in other functions do not."""
    text = SCRIPT.replace("    main()\n", "    pass\n") + "\n\ndef other():\n    math.sin(0)\n"
    assert reactions(text, is_script=False) == []


def test_a_long_expression_takes_no_stack() -> None:
    """What a student writes is read in any depth that Python parses."""
    text = SCRIPT.replace("def main():\n", f"def main():\n    a = {'1+' * 900}1\n")
    assert reactions(text) == []


def test_a_name_that_is_misspelt_more_than_once_is_one_slip() -> None:
    """It is corrected wherever the program certainly uses it."""
    text = SCRIPT.replace("self.publisher.publish", "self.publishr.publish").replace(
        SEND, f"{SEND}        print(self.publishr)\n"
    )
    [slip] = slips_of(text)
    assert [edit.new for edit in slip.edits] == ["publisher", "publisher"]
    assert slips_of(edited(text, slip.location.path, slip.edits) or "") == []


@pytest.mark.parametrize("name", ["Publisher", "Path", "Drive"])
def test_a_name_that_may_mean_several_things_is_not_corrected(name: str) -> None:
    """A class is no variable, other libraries have a Path, and what is like no other name is open."""
    publisher = "        publisher = 1\n"
    assert (
        reactions(SCRIPT.replace(SEND, f"{SEND}{publisher}        print({name}(publisher))\n"))
        == []
    )


def test_any_well_known_message_has_its_fields() -> None:
    """A field of one that few nodes use is corrected as well."""
    text = SCRIPT.replace(
        "from geometry_msgs", "from sensor_msgs.msg import Range\nfrom geometry_msgs"
    )
    [reaction] = reactions(
        text.replace(SEND, f"{SEND}        near = Range()\n        near.max_rnge = 2.0\n")
    )
    assert reaction == "sensor_msgs/msg/Range has no field max_rnge"
