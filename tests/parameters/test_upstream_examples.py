"""The example files of packages have no mistake in the parameters of their nodes.

The files are not copied: set PARAMETER_CHECKOUTS to a folder with clones of the repositories, as
OWNER+NAME/repo or NAME, from which they are read by commit.
"""

import os
import subprocess
from dataclasses import replace
from pathlib import Path

import pytest

from grader.files.reading import URDF_LIMIT
from grader.files.tree import make_tree, overlaid
from grader.ros.known.releases import Release
from grader.workspace.opening.all_robots import read_workspace
from grader.workspace.rules.reading import read_agreement
from tests.workspace.rovers import FILES

_VARIABLE = "PARAMETER_CHECKOUTS"
_NAV2, _DEMOS = "ros-navigation/navigation2", "ros-controls/ros2_control_demos"
_HUMBLE_NAV2 = "3c3db59d6969d8ecee8e68468693d006397f4a0c"
_JAZZY_NAV2 = "f4108e5b1c2bce804a1aa0c7be6673a8eb4a1501"
_KILTED_NAV2 = "71a1d84f49dc48e226c96619188ee12054824ff3"
_LYRICAL_NAV2 = "aa3dab8da45be5f899342f2f9002189aa4874a90"
_HUMBLE_DEMOS = "70950c56540edfec085b4e1e4585e30d70ca9b00"
_EKF, _SLAM = "cra-ros-pkg/robot_localization", "SteveMacenski/slam_toolbox"
_HUMBLE_EKF = "72f9e936062a2a6b9a210a36ba5e554058191a92"
_JAZZY_EKF = "1cb953379378d13b3e0935ed73d0c7407bd80543"
_HUMBLE_SLAM = "94cec982a7f850818187c81295d1212f145efe37"
_JAZZY_SLAM = "a3442d2f6824ff058fab0cb0a635e7a454294855"
# Of the repositories that packages are released from, by commit.
_EKF_RELEASES: dict[str, Release] = {
    "829140669542655894d2acbac8a54be91d6dfa5f": "humble",  # 3.5.4
    "11e68b5502d458c55fb84b5f6d35aee772dc012a": "kilted",  # 3.9.4
}
_SLAM_RELEASES: dict[str, Release] = {
    "33c9f5a3ca94daa8b34c5bfb2a275a3036cc2079": "humble",  # 2.6.10
    "b4d30cedb9ac9cc108336667c0335edbe9379d19": "kilted",  # 2.9.0
}
_JOY_RELEASES: dict[str, Release] = {
    "8c35e87d8ac85608554f4d4ecaba4c9e9836412a": "humble",  # 2.4.8
    "8b6d887193e448b1d8d700e4f85b707f21aa8fd7": "kilted",  # 2.6.5
}
_HUMBLE_MUX = "deeda8e3c49bad2095c795da5473f34a1b19fb46"
_PARAMS = "nav2_bringup/params/nav2_params.yaml"
EXAMPLES: list[tuple[str, str, str, Release]] = [
    (_NAV2, _HUMBLE_NAV2, _PARAMS, "humble"),
    (_NAV2, _JAZZY_NAV2, _PARAMS, "jazzy"),
    (_NAV2, _KILTED_NAV2, _PARAMS, "kilted"),
    (_NAV2, _LYRICAL_NAV2, _PARAMS, "lyrical"),
    (_EKF, _HUMBLE_EKF, "params/ekf.yaml", "humble"),
    (_EKF, _JAZZY_EKF, "params/ekf.yaml", "jazzy"),
    (_EKF, _JAZZY_EKF, "params/ukf.yaml", "jazzy"),
    (_EKF, _JAZZY_EKF, "params/navsat_transform.yaml", "jazzy"),
    (_SLAM, _HUMBLE_SLAM, "config/mapper_params_online_async.yaml", "humble"),
    (_SLAM, _JAZZY_SLAM, "config/mapper_params_online_async.yaml", "jazzy"),
    (_SLAM, _JAZZY_SLAM, "config/mapper_params_localization.yaml", "jazzy"),
    (
        "ros-teleop/twist_mux",
        "d929f1b19a437abcf131287b9e3af27fb40ed34e",
        "config/twist_mux_topics.yaml",
        "jazzy",
    ),
    *(
        ("ros2-gbp/robot_localization-release", commit, f"params/{name}.yaml", release)
        for commit, release in _EKF_RELEASES.items()
        for name in ("dual_ekf_navsat_example", "ekf", "navsat_transform", "ukf")
    ),
    *(
        ("SteveMacenski/slam_toolbox-release", commit, f"config/mapper_params_{name}.yaml", release)
        for commit, release in _SLAM_RELEASES.items()
        for name in ("lifelong", "localization", "offline", "online_async", "online_sync")
    ),
    *(
        ("ros2-gbp/teleop_twist_joy-release", commit, f"config/{name}.config.yaml", release)
        for commit, release in _JOY_RELEASES.items()
        for name in ("atk3", "ps3", "ps3-holonomic", "ps5", "xbox", "xd3")
    ),
    *(
        ("ros2-gbp/twist_mux-release", _HUMBLE_MUX, f"config/twist_mux_{name}.yaml", "humble")
        for name in ("locks", "topics")
    ),
    *(
        (_DEMOS, _HUMBLE_DEMOS, f"example_{number}/bringup/config/{name}.yaml", "humble")
        for number, name in (
            (1, "rrbot_controllers"),
            (2, "diffbot_controllers"),
            (3, "rrbot_multi_interface_forward_controllers"),
            (4, "rrbot_with_sensor_controllers"),
            (11, "carlikebot_controllers"),
            (13, "three_robots_controllers"),
        )
    ),
]


def _checkout(repository: str) -> Path | None:
    folder = Path(os.environ.get(_VARIABLE, ""))
    owner, _, name = repository.partition("/")
    for path in (folder / f"{owner}+{name}" / "repo", folder / name):
        if os.environ.get(_VARIABLE) and path.is_dir():
            return path
    return None


@pytest.mark.exhaustive  # needs checkouts
@pytest.mark.parametrize(
    ("repository", "commit", "path", "release"),
    EXAMPLES,
    ids=[f"{it[0]} {it[3]} {it[2].rpartition('/')[2]}" for it in EXAMPLES],
)
def test_an_example_of_a_package_has_no_mistake(
    repository: str, commit: str, path: str, release: Release
) -> None:
    """What a package gives its own nodes is right in its release."""
    checkout = _checkout(repository)
    if checkout is None:
        pytest.skip(f"needs a checkout of {repository} in {_VARIABLE}")
    shown = subprocess.run(
        ["git", "-C", str(checkout), "show", f"{commit}:{path}"], capture_output=True, check=True
    )
    files = {name: text.encode() for name, text in FILES.items() if "launch" not in name}
    for name in ("controllers", "costmap", "joint_limits"):
        del files[f"rover/config/{name}.yaml"]
    files["rover/config/example.yaml"] = shown.stdout
    tree = overlaid(make_tree("ws", (), ()), files)
    workspace = replace(read_workspace(tree, "ws", URDF_LIMIT, {}).workspace, releases=(release,))
    agreement = read_agreement(workspace)
    assert "parameters" in agreement.families
    assert [it.message for it in agreement.mismatches if it.family == "parameters"] == []
