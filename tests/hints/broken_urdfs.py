"""Files that ROS 2 rejects, or drops content of, as students write them: the reference with one text replaced by another."""

import tomllib
from pathlib import Path
from typing import NamedTuple

from tests.samples import LAB6, ROOT

REFERENCE = (ROOT / "rubrics" / LAB6.id / "my_robot" / "urdf" / "my_robot.urdf").read_text(
    encoding="utf-8"
)


class Broken(NamedTuple):
    """A mistake: what stands in the reference, and what stands in the file. `everywhere`: wherever it stands."""

    name: str
    right: str
    wrong: str
    everywhere: bool = False

    @property
    def text(self) -> str:
        """Return the broken file."""
        assert self.right in REFERENCE, self.name
        return REFERENCE.replace(self.right, self.wrong, -1 if self.everywhere else 1)


BROKEN = [
    Broken(**row)
    for row in tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))["broken"]
]
