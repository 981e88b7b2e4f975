"""Random robots: a reference or an equivalent of it with a few changes, each the same in every run for its seed."""

import copy
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from random import Random
from typing import Any, NamedTuple
from xml.etree import ElementTree as ET

from tests.second_opinion.changes import CHANGES

_ROOT = Path(__file__).parents[2]
_OF_LAB6 = (
    "mounts-between",
    "wheel-joints-at-centres",
    "turned-box",
    "with-collisions-and-inertia",
    "materials-in-links",
    "half-turns",
)
_OF_ARM = ("one-line", "mounts-between", "frames-turned")


class RandomRobot(NamedTuple):
    """A robot for a rubric."""

    rubric: str
    text: bytes


@cache
def _bases() -> dict[str, list[ET.Element]]:
    xacro: Any = __import__("xacro")  # of our own reference
    samples = _ROOT / "submissions"
    found = {
        "lab6": [
            _ROOT / "rubrics/lab6/my_robot/urdf/my_robot.urdf",
            *_urdfs(samples / "lab6", _OF_LAB6),
        ],
        "arm": [_ROOT / "rubrics/arm/arm.urdf", *_urdfs(samples / "arm", _OF_ARM)],
    }
    sensors = xacro.process_file(
        str(_ROOT / "rubrics/sensors/sensor_robot/urdf/sensor_robot.urdf.xacro")
    )
    trees = {
        name: [ET.fromstring(path.read_bytes()) for path in paths] for name, paths in found.items()
    }
    return trees | {"sensors": [ET.fromstring(sensors.toxml())]}


def _urdfs(folder: Path, names: Sequence[str]) -> list[Path]:
    return [
        path
        for name in names
        for path in sorted((folder / f"equivalent-{name}").rglob("*.urdf"))[:1]
    ]


def random_robot(seed: int) -> RandomRobot:
    """Return the robot of a seed: most are one to three changes from a correct one."""
    random = Random(seed)
    rubric = random.choices(("lab6", "arm", "sensors"), (6, 2, 2))[0]
    bases = _bases()[rubric]
    robot = copy.deepcopy(random.choice((bases[0], random.choice(bases))))
    for _ in range(random.choice((0, 1, 1, 1, 2, 2, 3, 5))):
        random.choice(CHANGES)(random, robot)
    return RandomRobot(rubric, ET.tostring(robot))
