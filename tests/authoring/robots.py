"""A robot with everything that mutants and rewritings look at, and rubrics for it."""

import tomllib
from pathlib import Path

from grader.lab.rubric.rubric import Rubric, load_rubric

ARM = (Path(__file__).parent / "birch.urdf").read_text(encoding="utf-8")
CHANGES = tomllib.loads((Path(__file__).parent / "changes.toml").read_text(encoding="utf-8"))
TOP = """\
id = "arm"
title = "An arm"
reference = "birch.urdf"
[[part]]
id = "model"
title = "The model"
[[criterion]]
id = "loads"
part = "model"
title = "ROS 2 loads it"
points = 1
check = "urdf_loads"
"""
BOX = """\
[[criterion]]
id = "plate-box"
part = "model"
title = "The plate is a box"
points = 2
check = "shows_box"
with = { link = "plate", size = [0.1, 0.12, 0.02], tolerance = 0.002 }
"""
FRAME = """\
[[criterion]]
id = "tool-frame"
part = "model"
title = "The tool is above the finger"
points = 3
check = "frame_at"
with = { link = "tool", relative_to = "finger", xyz = [0, 0, 0.05], tolerance = 0.002 }
"""


def write_rubric(folder: Path, text: str = TOP + BOX + FRAME, robot: str = ARM) -> Path:
    """Write a rubric and its reference, and return the rubric's path."""
    (folder / "birch.urdf").write_text(robot, encoding="utf-8")
    path = folder / "arm.toml"
    path.write_text(text, encoding="utf-8")
    return path


def rubric_in(folder: Path, text: str = TOP + BOX + FRAME, robot: str = ARM) -> Rubric:
    """Return a rubric that is written to a folder, with its reference."""
    return load_rubric(str(write_rubric(folder, text, robot)))
