"""What an editor offers and says of the parameters in a file."""

import pytest

from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.ros.known.releases import StatedReleases
from grader.workspace.index.offered_parameters import parameter_text, parameters_below
from grader.workspace.model.workspace import Workspace
from grader.workspace.opening.all_robots import read_workspace
from tests.command_line import ROOT
from tests.workspace.random_edits import files_of

pytestmark = pytest.mark.slow


def _workspace(folder: str) -> Workspace:
    tree = overlaid(make_tree("ws", (), ()), files_of(ROOT / folder))
    return read_workspace(tree, "ws", URDF_LIMIT, {}, stated=StatedReleases(("jazzy",))).workspace


def test_those_of_a_controller() -> None:
    workspace = _workspace("rubrics/diffdrive")
    offered = parameters_below(workspace, "diff_drive_controller", "")
    assert {"wheel_separation", "wheel_radius", "linear", "angular"} <= set(offered)
    assert "use_stamped_vel" not in offered  # until Iron
    assert "max_velocity" in parameters_below(workspace, "diff_drive_controller", "linear.x.")
    text = parameter_text(workspace, "diff_drive_controller", "wheel_radius")
    assert text.startswith("parameter of diff_drive_controller/DiffDriveController\ntype: double\n")


def test_those_of_a_well_known_node() -> None:
    workspace = _workspace("rubrics/diffdrive")
    assert "update_rate" in parameters_below(workspace, "controller_manager", "")
    assert "alpha1" in parameters_below(workspace, "amcl", "")
    assert "default: 0.2" in parameter_text(workspace, "amcl", "alpha1").split("\n")


def test_those_of_an_own_node() -> None:
    workspace = _workspace("rubrics/diffdrive")
    assert {"speed", "turn_rate"} <= set(parameters_below(workspace, "drive_circle", ""))
    text = parameter_text(workspace, "drive_circle", "speed")
    assert text.startswith("default: ")
    assert "declared at diffdrive_robot/scripts/drive_circle.py:12" in text


def test_nothing_of_a_node_that_nobody_knows() -> None:
    workspace = _workspace("rubrics/diffdrive")
    assert parameters_below(workspace, "nobody", "") == []
    assert parameter_text(workspace, "nobody", "speed") == ""
    assert parameter_text(workspace, "amcl", "speed") == ""
