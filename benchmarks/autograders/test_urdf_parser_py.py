"""What a course would write instead: six asserts on urdf_parser_py. The file to grade is named by URDF."""

import os

import numpy as np
from urdf_parser_py.urdf import URDF

ROBOT = URDF.from_xml_file(os.environ["URDF"])


def pose(joint):
    """Return the pose of a joint in its parent link as a matrix."""
    origin = ROBOT.joint_map[joint].origin
    (roll, pitch, yaw), matrix = origin.rpy or (0, 0, 0), np.eye(4)
    (sr, cr), (sp, cp), (sy, cy) = ((np.sin(angle), np.cos(angle)) for angle in (roll, pitch, yaw))
    matrix[:3, :3] = (
        np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
        @ np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
        @ np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    )
    matrix[:3, 3] = origin.xyz
    return matrix


def test_box_size():
    assert np.allclose(ROBOT.link_map["base_link"].visual.geometry.size, (0.6, 0.4, 0.2))


def test_box_on_the_ground_plane():
    visual = ROBOT.link_map["base_link"].visual
    assert np.isclose(visual.origin.xyz[2], visual.geometry.size[2] / 2)


def test_lidar():
    assert np.allclose(pose("base_lidar_joint")[:3, 3], (0.15, 0, 0.225))


def test_left_wheel_turns_forward():
    axis = pose("base_left_wheel_joint")[:3, :3] @ ROBOT.joint_map["base_left_wheel_joint"].axis
    assert np.allclose(axis, (0, 1, 0), atol=1e-2)


def test_right_wheel_turns_forward():
    axis = pose("base_right_wheel_joint")[:3, :3] @ ROBOT.joint_map["base_right_wheel_joint"].axis
    assert np.allclose(axis, (0, 1, 0), atol=1e-2)


def test_footprint():
    assert np.allclose(pose("base_joint")[:3, 3], (0, 0, 0.1))
