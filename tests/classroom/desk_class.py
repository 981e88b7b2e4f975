"""A class of Lab 6 as a teaching assistant gets it: few of the submissions have answers, and some of them are equal."""

import random
import shutil
from pathlib import Path

from tests.checks.submissions import png
from tests.samples import ROOT

STUDENTS, ANSWERS, PICTURES = 121, 40, 50
_ENDS = (
    "vanishes",
    "is gone",
    "stays",
    "has two roots",
    "is not in the tree",
    "cannot be placed",
    "fails to load",
)
_WHYS = (
    "no joint joins it",
    "the tree has two roots",
    "nothing says where it is",
    "the parser refuses it",
)
_NODES = ("robot_state_publisher", "joint_state_publisher", "joint_state_publisher_gui", "rviz2")


def make_desk_class(folder: Path) -> Path:
    """Write STUDENTS submissions and a roster with two sections; ANSWERS have answers, PICTURES a picture."""
    package = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"
    urdf = (package / "urdf/my_robot.urdf").read_text()
    chance = random.Random(30)
    rows = ["id,name,section"]
    for number in range(STUDENTS):
        key = f"s{number:03}"
        rows.append(f"{key},Student {number},{'AB'[number % 2]}")
        top = folder / "class" / key
        shutil.copytree(package, top / "my_robot")
        (top / "my_robot/urdf/my_robot.urdf").write_text(f"{urdf}<!-- {key} -->\n")
        if number < ANSWERS:
            why = f"The link {chance.choice(_ENDS)}, because {chance.choice(_WHYS)}."
            nodes = f"It starts {' and '.join(chance.sample(_NODES, 2))}, which show the robot."
            (top / "answers.md").write_text(
                f"# Task 1 Step 15\n\n{why}\n\n# Task 2 Step 2\n\n{nodes}\n"
            )
        if number % 2 and number < 2 * PICTURES:
            (top / "Task3_Step3.png").write_bytes(png(640 + number, 400))
    (folder / "roster.csv").write_text("\n".join(rows) + "\n")
    return folder / "class"
