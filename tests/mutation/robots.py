"""A robot with everything that mutants and rewritings look at, and rubrics for it."""

from pathlib import Path

from grader.grading.rubric import Rubric, load_rubric

ARM = """\
<?xml version="1.0"?>
<robot name="birch">
  <material name="steel">
    <color rgba="0.5 0.5 0.6 1"/>
  </material>
  <link name="base">
    <visual>
      <origin xyz="0 0 0.05"/>
      <geometry><cylinder radius="0.1" length="0.1"/></geometry>
      <material name="steel"/>
    </visual>
    <collision>
      <origin xyz="0 0 0.05"/>
      <geometry><cylinder radius="0.11" length="0.1"/></geometry>
    </collision>
  </link>
  <link name="plate">
    <visual>
      <geometry><box size="0.1 0.12 0.02"/></geometry>
    </visual>
  </link>
  <joint name="base_plate" type="fixed">
    <parent link="base"/>
    <child link="plate"/>
    <origin xyz="0 0 0.11" rpy="0 0 3.14159"/>
  </joint>
  <link name="upper">
    <visual>
      <origin xyz="0 0 0.2" rpy="0 1.5708 0"/>
      <geometry><box size="0.4 0.05 0.06"/></geometry>
    </visual>
    <inertial>
      <origin xyz="0 0 0.2" rpy="0.1 0 0"/>
      <mass value="1.2"/>
      <inertia ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0" izz="0.01"/>
    </inertial>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="plate"/>
    <child link="upper"/>
    <origin xyz="0 0 0.01" rpy="0.2 0 0"/>
    <axis xyz="0 1 0"/>
    <limit lower="-1.5" upper="1.4" effort="10" velocity="2"/>
    <dynamics damping="0.1"/>
  </joint>
  <link name="slider">
    <visual>
      <geometry><mesh filename="package://birch/meshes/hand.stl" scale="0.001 0.001 0.001"/></geometry>
    </visual>
  </link>
  <joint name="slide" type="prismatic">
    <parent link="upper"/>
    <child link="slider"/>
    <origin xyz="0 0 0.4"/>
    <axis xyz="0 1 2"/>
    <limit lower="0" upper="0.1" effort="10" velocity="2"/>
  </joint>
  <link name="finger">
    <visual>
      <geometry><sphere radius="0.02"/></geometry>
    </visual>
  </link>
  <joint name="finger_joint" type="revolute">
    <parent link="slider"/>
    <child link="finger"/>
    <origin xyz="0.02 0 0.1"/>
    <limit lower="-1" upper="1" effort="10" velocity="2"/>
    <mimic joint="shoulder" multiplier="-0.5" offset="0.1"/>
  </joint>
  <link name="tool">
    <visual>
      <origin xyz="0.1 0 0" rpy="0 0 0.3"/>
      <geometry><box size="0.01 0.02 0.03"/></geometry>
    </visual>
  </link>
  <joint name="tool_joint" type="fixed">
    <parent link="finger"/>
    <child link="tool"/>
    <origin xyz="0 0 0.05"/>
  </joint>
  <gazebo reference="base">
    <mu1>0.2</mu1>
  </gazebo>
  <gazebo>
    <plugin name="control" filename="libcontrol.so"/>
  </gazebo>
  <transmission name="drive">
    <joint name="shoulder"/>
  </transmission>
  <ros2_control name="arm" type="system">
    <joint name="slide">
      <param name="min">-1</param>
    </joint>
  </ros2_control>
</robot>
"""
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
