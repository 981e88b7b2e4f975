"""Real robots are drawn."""

from pathlib import Path

import pytest

from tests.command_line import run
from tests.oracles.example_robots import each_robot
from tests.report.readers import read_svg

pytestmark = pytest.mark.exhaustive


@each_robot
def test_robot_is_drawn(path: Path) -> None:
    """Without an exception, with the exit code of the other formats; many have only meshes, which the drawing names."""
    done = run(("inspect", path, "--format", "svg"))
    root = read_svg(done.stdout.decode())
    assert done.returncode == run(("inspect", path, "--format", "json")).returncode
    says = " ".join(element.text or "" for element in root.iter("{*}text", "{*}tspan"))
    is_drawn = len(root.findall(".//{*}polygon/{*}title")) > 0
    assert (
        is_drawn
        or "Not shown: " in says
        or "only frames of links are shown" in says
        or "No picture" in says
    )
