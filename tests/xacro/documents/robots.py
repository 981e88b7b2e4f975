"""Whole robots as students write them: arithmetic on properties, pi, macros for inertia, wheels and materials."""

from tests.xacro.documents.document import Document, Documents, named, part, robot

_MATERIALS = """
  <material name="green"><color rgba="0 0.6 0 1"/></material>
  <material name="gray"><color rgba="${0.7} 0.7 0.7 1"/></material>
"""
_INERTIA = """
  <xacro:macro name="box_inertia" params="m w h d">
    <inertial>
      <origin xyz="0 0 ${h/2}" rpy="${pi/2} 0 ${pi/2}"/>
      <mass value="${m}"/>
      <inertia ixx="${(m/12) * (h*h + d*d)}" ixy="0.0" ixz="0.0" iyy="${(m/12) * (w*w + d*d)}" iyz="0.0" izz="${(m/12) * (w*w + h*h)}"/>
    </inertial>
  </xacro:macro>
  <xacro:macro name="cylinder_inertia" params="m r h">
    <inertial>
      <origin xyz="0 0 0" rpy="${pi/2} 0 0"/>
      <mass value="${m}"/>
      <inertia ixx="${m*(3*r*r+h*h)/12}" ixy="0" ixz="0" iyy="${m*(3*r*r+h*h)/12}" iyz="0" izz="${m*r*r/2}"/>
    </inertial>
  </xacro:macro>
  <xacro:macro name="sphere_inertia" params="m r">
    <inertial><mass value="${m}"/>
      <inertia ixx="${2*m*r*r/5}" ixy="0" ixz="0" iyy="${2*m*r*r/5}" iyz="0" izz="${2*m*r*r/5}"/></inertial>
  </xacro:macro>
"""
_VALUES = "".join(
    named(name, value)
    for name, value in {
        "base_length": "0.6", "base_width": "0.4", "base_height": "0.2", "wheel_radius": "0.1", "wheel_length": "0.05",
        "base_mass": "5.0", "wheel_mass": "0.5", "wheel_x": "${-base_length/4}", "wheel_y": "${base_width/2}",
        "half_turn": "${pi/2}",
    }.items()
)  # fmt: skip
_BASE = """
  <link name="base_footprint"/>
  <joint name="base_joint" type="fixed">
    <parent link="base_footprint"/><child link="base_link"/><origin xyz="0 0 ${wheel_radius}"/>
  </joint>
  <link name="base_link">
    <visual>
      <geometry><box size="${base_length} ${base_width} ${base_height}"/></geometry>
      <origin xyz="0 0 ${base_height/2}" rpy="0 0 0"/>
      <material name="green"/>
    </visual>
    <xacro:box_inertia m="${base_mass}" w="${base_length}" d="${base_width}" h="${base_height}"/>
  </link>
"""
_WHEEL = """
  <xacro:macro name="wheel" params="side y_sign">
    <link name="${side}_wheel">
      <visual>
        <origin xyz="0 0 ${y_sign * wheel_length/2}"/>
        <geometry><cylinder radius="${wheel_radius}" length="${wheel_length}"/></geometry>
        <material name="gray"/>
      </visual>
      <xacro:cylinder_inertia m="${wheel_mass}" r="${wheel_radius}" h="${wheel_length}"/>
    </link>
    <joint name="base_${side}_wheel_joint" type="continuous">
      <parent link="base_link"/>
      <child link="${side}_wheel"/>
      <origin xyz="${wheel_x} ${y_sign * wheel_y} 0" rpy="-${half_turn} 0 0"/>
      <axis xyz="0 0 1"/>
    </joint>
  </xacro:macro>
"""
_WHEELS = '<xacro:wheel side="left" y_sign="1"/><xacro:wheel side="right" y_sign="-1"/>'
_CASTER = """
  <link name="caster_wheel">
    <visual><geometry><sphere radius="${wheel_radius/2}"/></geometry><material name="gray"/></visual>
    <xacro:sphere_inertia m="0.2" r="${wheel_radius/2}"/>
  </link>
  <joint name="base_caster_wheel_joint" type="fixed">
    <parent link="base_link"/><child link="caster_wheel"/><origin xyz="0.2 0 ${-wheel_radius/2}"/>
  </joint>
"""
_LIDAR = """
  <xacro:arg name="lidar" default="true"/>
  <xacro:if value="$(arg lidar)">
    <link name="lidar"><visual><geometry><cylinder radius="0.1" length="0.05"/></geometry></visual></link>
    <joint name="base_lidar_joint" type="fixed">
      <parent link="base_link"/><child link="lidar"/><origin xyz="${base_length/4} 0 ${base_height + 0.05/2}"/>
    </joint>
  </xacro:if>
"""
_ALL = _MATERIALS + _VALUES + _INERTIA + _BASE + _WHEEL + _WHEELS + _CASTER + _LIDAR

_FILES: dict[str, str | bytes] = {
    "urdf/materials.xacro": part(_MATERIALS),
    "urdf/inertial_macros.xacro": part(_INERTIA),
    "urdf/values.xacro": part(_VALUES),
    "urdf/parts/wheel.xacro": part(_WHEEL),
    "urdf/parts/lidar.xacro": part(_LIDAR),
    "config/robot.yaml": "wheel: {radius: 0.1, length: 0.05}\nbase: {size: [0.6, 0.4, 0.2], color: 0 0.6 0 1}\n",
}
_INCLUDES = "".join(
    f'<xacro:include filename="{name}"/>' for name in ("materials.xacro", "inertial_macros.xacro", "values.xacro")
)
_FOUND = "".join(
    f'<xacro:include filename="$(find my_robot)/urdf/{name}"/>'
    for name in ("materials.xacro", "inertial_macros.xacro", "values.xacro", "parts/wheel.xacro", "parts/lidar.xacro")
)
_BLOCK = """
  <xacro:macro name="fixed" params="name parent child:=^|none *origin">
    <joint name="${name}" type="fixed"><parent link="${parent}"/><child link="${child}"/><xacro:insert_block name="origin"/></joint>
  </xacro:macro>
  <xacro:macro name="solid" params="name **shape material:=green">
    <link name="${name}">
      <visual><geometry><xacro:insert_block name="shape"/></geometry><material name="${material}"/></visual>
      <collision><geometry><xacro:insert_block name="shape"/></geometry></collision>
    </link>
  </xacro:macro>
  <xacro:solid name="base_link"><g><box size="${base_length} ${base_width} ${base_height}"/></g></xacro:solid>
  <xacro:solid name="lidar" material="gray"><g><cylinder radius="${wheel_radius}" length="${wheel_length}"/></g></xacro:solid>
  <xacro:fixed name="base_lidar_joint" parent="base_link" child="lidar"><origin xyz="${base_length/4} 0 ${base_height}"/></xacro:fixed>
"""
_YAML = """
  <xacro:property name="c" value="${xacro.load_yaml('$(find my_robot)/config/robot.yaml')}"/>
  <link name="base_link"><visual><geometry><box size="${' '.join([str(s) for s in c.base.size])}"/></geometry>
    <material name="m"><color rgba="${c.base.color}"/></material></visual></link>
  <link name="wheel"><visual><geometry><cylinder radius="${c.wheel.radius}" length="${c.wheel.length}"/></geometry></visual></link>
  <joint name="j" type="continuous"><parent link="base_link"/><child link="wheel"/><origin xyz="0 ${c.base.size[1]/2} 0"/></joint>
"""
_LEGS = """
  <link name="base_link"/>
  <xacro:macro name="legs" params="names"><xacro:if value="${len(names) > 0}">
    <link name="${names[0]}_leg"/>
    <joint name="${names[0]}_hip" type="revolute"><parent link="base_link"/><child link="${names[0]}_leg"/>
      <origin xyz="${0.1 * len(names)} 0 0" rpy="0 ${radians(45)} 0"/><axis xyz="0 1 0"/>
      <limit lower="${-pi/2}" upper="${pi/2}" effort="10" velocity="${2*pi}"/></joint>
    <xacro:legs names="${names[1:]}"/>
  </xacro:if></xacro:macro>
  <xacro:legs names="${'front_left front_right rear_left rear_right'.split()}"/>
"""


def _damaged(old: str, new: str) -> Document:
    assert old in _ALL
    return Document(robot(_ALL.replace(old, new)))


DOCUMENTS: Documents = {
    "in-one-file": Document(robot(_ALL)),
    "without-lidar": Document(robot(_ALL), arguments={"lidar": "false"}),
    "in-files": Document(robot(_INCLUDES + _BASE + _WHEEL + _WHEELS + _CASTER + _LIDAR), _FILES),
    "in-files-of-the-package": Document(robot(_FOUND + _BASE + _WHEELS + _CASTER), _FILES),
    "blocks": Document(robot(_MATERIALS + _VALUES + _BLOCK)),
    "yaml": Document(robot(_YAML), _FILES),
    "legs": Document(robot(_LEGS)),
    "no-macro": Document(robot(_MATERIALS + _VALUES + _BASE.replace('<xacro:box_inertia m="${base_mass}" w="${base_length}" d="${base_width}" h="${base_height}"/>', ""))),
    "carriage-returns": Document(robot(_ALL).replace("\n", "\r\n")),
    "tabs": Document(robot(_ALL).replace("  ", "\t")),
    "undeclared-namespace": Document(robot(_ALL).replace(' xmlns:xacro="http://www.ros.org/wiki/xacro"', "")),
    "misspelt-property": _damaged("${wheel_radius/2}", "${weel_radius/2}"),
    "misspelt-parameter": _damaged('y_sign="-1"', 'ysign="-1"'),
    "misspelt-macro": _damaged("<xacro:sphere_inertia", "<xacro:spere_inertia"),
    "missing-parameter": _damaged(' r="${wheel_radius/2}"', ""),
    "unclosed-expression": _damaged("${base_height/2}", "${base_height/2"),
    "unbalanced-brackets": _damaged("${(m/12) * (h*h + d*d)}", "${(m/12) * (h*h + d*d}"),
    "missing-operator": _damaged("${m*r*r/2}", "${m r*r/2}"),
    "comma-in-number": _damaged('value="0.05"', 'value="0,05"'),
    "unit-in-number": _damaged('value="0.1"', 'value="0.1m"'),
    "math-prefix": _damaged("${pi/2}", "${math.pi/2}"),
    "upper-case-pi": _damaged("${pi/2}", "${PI/2}"),
    "property-after-use": Document(robot(_MATERIALS + _INERTIA + _BASE + _VALUES)),
    "macro-after-use": Document(robot(_MATERIALS + _VALUES + _BASE + _INERTIA)),
    "missing-include": Document(robot(_INCLUDES + _BASE), {"urdf/materials.xacro": part(_MATERIALS)}),
    "include-of-other-package": Document(
        robot('<xacro:include filename="$(find course_description)/urdf/materials.xacro"/>' + _VALUES + _INERTIA + _BASE),
        undetermined="always",
    ),
    "negative-expression": _damaged("-${half_turn}", "-${-half_turn}"),
    "string-property": _damaged('value="5.0"', "value=\"'5.0'\""),
    "quoted-text-mass": _damaged('m="0.2"', 'm="heavy"'),
    "division-by-zero": _damaged("${m*r*r/2}", "${m*r*r/0}"),
    "closed-early": _damaged("</xacro:macro>", ""),
    "gazebo": Document(
        robot(_ALL + '<gazebo reference="lidar"><material>Gazebo/Gray</material><mu1>${wheel_radius * 2}</mu1></gazebo>')
    ),
}  # fmt: skip
