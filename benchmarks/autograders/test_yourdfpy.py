"""What a course would write instead: six asserts on yourdfpy. The file to grade is named by URDF."""

import os

import numpy as np
from yourdfpy import URDF

ROBOT = URDF.load(os.environ["URDF"], load_meshes=False, build_collision_scene_graph=False)


def axis_of(joint):
    """Return the axis of a joint in the frame of its parent link."""
    return ROBOT.joint_map[joint].origin[:3, :3] @ ROBOT.joint_map[joint].axis


def test_box_size():
    assert np.allclose(ROBOT.link_map["base_link"].visuals[0].geometry.box.size, (0.6, 0.4, 0.2))


def test_box_on_the_ground_plane():
    visual = ROBOT.link_map["base_link"].visuals[0]
    assert np.isclose(visual.origin[2, 3], visual.geometry.box.size[2] / 2)


def test_lidar():
    assert np.allclose(ROBOT.get_transform("lidar", "base_link")[:3, 3], (0.15, 0, 0.225))


def test_left_wheel_turns_forward():
    assert np.allclose(axis_of("base_left_wheel_joint"), (0, 1, 0), atol=1e-2)


def test_right_wheel_turns_forward():
    assert np.allclose(axis_of("base_right_wheel_joint"), (0, 1, 0), atol=1e-2)


def test_footprint():
    assert np.allclose(ROBOT.get_transform("base_link", "base_footprint")[:3, 3], (0, 0, 0.1))
