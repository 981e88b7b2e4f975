"""Inputs by their size n in which each thing is a finding: a name that is nowhere, in each kind of file.

`BOMBS` has them as well.
"""

from tests.bombs.files import Files, cmake, launched, lines, package, program, robot, started, word
from tests.bombs.generators import BOMBS, compiled, compiled_node, put_into_bombs

__all__ = ["BOMBS"]  # with the inputs of this module

_SYSTEM = (
    '<ros2_control name="x" type="system"><hardware><plugin>mock_components/GenericSystem</plugin>'
    "</hardware>{}</ros2_control>"
)
_SRDF = '<robot name="my_robot">{}</robot>'
_TOPICS = "self.create_publisher(String, 'pose_of_{0}', 10)"


def _robot(text: str) -> Files:
    """Return a package whose robot has this text inside of it."""
    return package(urdf=robot(1, text))


def _srdf(text: str) -> Files:
    """Return a package with an SRDF of this text."""
    return {**package(), "config/my_robot.srdf": _SRDF.format(text)}


def _node(*body: str, **more: str) -> Files:
    """Return a package whose node does this, and is started."""
    files = launched(started(1, more.pop("parameters", "")), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": more.pop("head", "") + program(body), **more}


# --- The robot and its SRDF


@put_into_bombs
def collisions_of_absent_links(n: int) -> Files:
    return _srdf(lines(n, lambda i: f'<disable_collisions link1="l{i}" link2="m{i}" reason="a"/>'))


@put_into_bombs
def groups_of_absent_links(n: int) -> Files:
    names = lines(n, lambda i: f'<link name="l{i}"/><joint name="j{i}"/>')
    return _srdf(f'<group name="arm">{names}</group>')


@put_into_bombs
def groups_of_absent_groups(n: int) -> Files:
    return _srdf(lines(n, lambda i: f'<group name="a{i}"><group name="b{i}"/></group>'))


@put_into_bombs
def chains_of_absent_links(n: int) -> Files:
    return _srdf(
        lines(n, lambda i: f'<group name="a{i}"><chain base_link="b{i}" tip_link="c{i}"/></group>')
    )


@put_into_bombs
def states_of_absent_joints(n: int) -> Files:
    joints = lines(n, lambda i: f'<joint name="j{i}" value="0"/>')
    return _srdf(
        f'<group name="arm"><link name="base_link"/></group><group_state name="a" group="arm">{joints}</group_state>'
    )


@put_into_bombs
def effectors_of_absent_groups(n: int) -> Files:
    return _srdf(
        lines(n, lambda i: f'<end_effector name="e{i}" parent_link="l{i}" group="g{i}"/>')
        + lines(n, lambda i: f'<passive_joint name="p{i}"/>')
    )


@put_into_bombs
def spheres_of_absent_links(n: int) -> Files:
    sphere = '<sphere center="0 0 0" radius="0.1"/>'
    return _srdf(
        lines(
            n,
            lambda i: (
                f'<link_sphere_approximation link="l{i}">{sphere}</link_sphere_approximation>'
            ),
        )
    )


@put_into_bombs
def interfaces_of_absent_joints(n: int) -> Files:
    joint = '<joint name="j{}"><command_interface name="position"/><state_interface name="position"/></joint>'
    return _robot(_SYSTEM.format(lines(n, joint.format)))


@put_into_bombs
def systems_of_absent_joints(n: int) -> Files:
    joint = '<joint name="j{}"><command_interface name="position"/></joint>'
    return _robot(lines(n, lambda i: _SYSTEM.format(joint.format(i))))


@put_into_bombs
def sensors_of_systems(n: int) -> Files:
    sensor = '<sensor name="s{}"><state_interface name="force.x"/><param name="frame_id">f{}</param></sensor>'
    return _robot(_SYSTEM.format(lines(n, lambda i: sensor.format(i, i))))


@put_into_bombs
def transmissions_of_absent_joints(n: int) -> Files:
    text = (
        '<transmission name="t{0}"><type>transmission_interface/SimpleTransmission</type><joint name="j{0}"/>'
        '<actuator name="a{0}"/></transmission>'
    )
    return _robot(lines(n, text.format))


@put_into_bombs
def gazebo_of_absent_links(n: int) -> Files:
    sensor = '<sensor name="s{0}" type="gpu_lidar"><topic>t{0}</topic></sensor>'
    return _robot(lines(n, lambda i: f'<gazebo reference="l{i}">{sensor.format(i)}</gazebo>'))


@put_into_bombs
def gazebo_plugins(n: int) -> Files:
    text = (
        '<gazebo><plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive"><left_joint>l{0}'
        "</left_joint><right_joint>r{0}</right_joint><topic>t{0}</topic></plugin></gazebo>"
    )
    return _robot(lines(n, text.format))


@put_into_bombs
def mimics_of_absent_joints(n: int) -> Files:
    joint = (
        '<link name="l{0}"/><joint name="j{0}" type="continuous"><parent link="base_link"/><child link="l{0}"/>'
        '<mimic joint="k{0}"/></joint>'
    )
    return _robot(lines(n, joint.format))


@put_into_bombs
def joints_of_absent_links(n: int) -> Files:
    joint = '<joint name="j{0}" type="fixed"><parent link="p{0}"/><child link="c{0}"/></joint>'
    return _robot(lines(n, joint.format))


@put_into_bombs
def materials_that_are_absent(n: int) -> Files:
    text = '<link name="l{0}"><visual><geometry><box size="1 1 1"/></geometry><material name="m{0}"/></visual></link>'
    return _robot(lines(n, text.format))


@put_into_bombs
def links_of_one_name(n: int) -> Files:
    return _robot(lines(n, lambda _: '<link name="arm"/>'))


@put_into_bombs
def unknown_attributes(n: int) -> Files:
    return _robot(lines(n, lambda i: f'<link name="l{i}" colour{i}="red"/>'))


@put_into_bombs
def comments_that_ignore(n: int) -> Files:
    return _robot(lines(n, lambda i: f'<!-- grader:ignore URDF --><link name="l{i}" colour="a"/>'))


@put_into_bombs
def processing_instructions(n: int) -> Files:
    return _robot(lines(n, lambda i: f"<?a{i} b?>"))


@put_into_bombs
def macros_that_are_absent(n: int) -> Files:
    text = robot(1, lines(n, lambda i: f'<xacro:wheel_{word(i)} name="a"/>'))
    head = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
    return {**package(), "urdf/other.urdf.xacro": text.replace("<robot", head, 1)}


@put_into_bombs
def includes_of_xacro_that_are_absent(n: int) -> Files:
    text = robot(1, lines(n, lambda i: f'<xacro:include filename="part_{word(i)}.xacro"/>'))
    head = '<robot xmlns:xacro="http://www.ros.org/wiki/xacro"'
    return {**package(), "urdf/other.urdf.xacro": text.replace("<robot", head, 1)}


# --- Launch files, parameters and displays


@put_into_bombs
def includes_that_are_absent(n: int) -> Files:
    included = "IncludeLaunchDescription(PythonLaunchDescriptionSource(P + '../launch/part_{0}.launch.py'))"
    files = launched("[" + lines(n, lambda i: included.format(word(i)), ",\n") + "]")
    head = (
        "from launch.actions import IncludeLaunchDescription\n"
        "from launch.launch_description_sources import PythonLaunchDescriptionSource\n"
    )
    return {**files, "launch/a.launch.py": head + files["launch/a.launch.py"]}


@put_into_bombs
def programs_that_are_absent(n: int) -> Files:
    node = "Node(package='my_robot', executable='program_{0}', name='n{0}')"
    return launched("[" + lines(n, lambda i: node.format(word(i)), ",\n") + "]")


@put_into_bombs
def parameter_files_that_are_absent(n: int) -> Files:
    node = "Node(package='my_robot', executable='x', name='n{0}', parameters=[P + 'file_{0}.yaml'])"
    files = launched(
        "[" + lines(n, lambda i: node.format(word(i)), ",\n") + "]",
        programs="'x = my_robot.x:main'",
    )
    return {**files, "my_robot/x.py": program(["pass"])}


@put_into_bombs
def remappings_of_absent_topics(n: int) -> Files:
    rules = lines(n, lambda i: f"('pose_{word(i)}', 'place_{word(i)}')", ",\n")
    files = launched(started(1, more=f", remappings=[{rules}]"), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": program(["self.create_publisher(String, 'pose', 10)"])}


@put_into_bombs
def nodes_in_xml_of_absent_programs(n: int) -> Files:
    nodes = lines(n, lambda i: f'<node pkg="my_robot" exec="program_{word(i)}" name="n{i}"/>')
    return {**package(), "launch/a.launch.xml": f"<launch>\n{nodes}\n</launch>\n"}


@put_into_bombs
def variables_in_xml_that_are_absent(n: int) -> Files:
    text = lines(n, lambda i: f'<arg name="a{i}" default="$(var variable_{word(i)})"/>')
    return {**package(), "launch/a.launch.xml": f"<launch>\n{text}\n</launch>\n"}


@put_into_bombs
def parameters_that_are_not_declared(n: int) -> Files:
    values = lines(n, lambda i: f"    speed_{word(i)}: 1")
    body = lines(n, lambda i: f"        self.declare_parameter('rate_{word(i)}', 1)").strip()
    return _node(
        body, parameters="P + 'p.yaml'", **{"config/p.yaml": f"n0:\n  ros__parameters:\n{values}\n"}
    )


@put_into_bombs
def sections_of_absent_nodes(n: int) -> Files:
    text = lines(n, lambda i: f"node_{word(i)}:\n  ros__parameters: {{p: 1}}")
    return _node("pass", parameters="P + 'p.yaml'", **{"config/p.yaml": text})


@put_into_bombs
def controllers_of_absent_joints(n: int) -> Files:
    joints = lines(n, lambda i: f"joint_{word(i)}", ", ")
    controller = "joint_trajectory_controller/JointTrajectoryController"
    text = (
        f"controller_manager:\n  ros__parameters:\n    arm:\n      type: {controller}\n"
        f"arm:\n  ros__parameters:\n    joints: [{joints}]\n"
    )
    return {**_robot(_SYSTEM.format("")), "config/c.yaml": text}


@put_into_bombs
def topics_of_rviz_that_are_absent(n: int) -> Files:
    display = "    - Class: rviz_default_plugins/LaserScan\n      Topic:\n        Value: /scan_{0}\n      Name: d{0}"
    text = "Visualization Manager:\n  Displays:\n" + lines(n, lambda i: display.format(word(i)))
    return {**_node("pass"), "rviz/a.rviz": text}


# --- Code


@put_into_bombs
def topics_that_nobody_hears(n: int) -> Files:
    return _node(
        *(_TOPICS.format(word(i)) for i in range(n)),
        "self.create_subscription(String, 'pose', self.c, 10)",
    )


@put_into_bombs
def subscriptions_that_nobody_serves(n: int) -> Files:
    text = "self.create_subscription(String, 'pose_of_{0}', self.on_{0}, 10)"
    return _node(*(text.format(word(i)) for i in range(n)))


@put_into_bombs
def modules_that_are_absent(n: int) -> Files:
    imports = lines(n, lambda i: f"from my_robot.part_{word(i)} import A{i}")
    return _node("pass", head=f"{imports}\n")


@put_into_bombs
def modules_with_findings(n: int) -> Files:
    files = _node("pass")
    for i in range(n // 4):
        files[f"my_robot/m{i}.py"] = program([f"self.create_publisher(Strin{i}, 'a', 10)"])
    return files


@put_into_bombs
def names_that_are_undefined(n: int) -> Files:
    return _node(*(f"value_{word(i)} + 1" for i in range(n)))


@put_into_bombs
def attribute_chains(n: int) -> Files:
    return _node("x = self" + ".get_clock()" * (n // 2), "y = self" + ".a" * n)


@put_into_bombs
def attributes_that_are_absent(n: int) -> Files:
    return _node(*(f"self.value_{word(i)}.x.y.z" for i in range(n)))


@put_into_bombs
def classes_of_one_name(n: int) -> Files:
    text = "class A(Node):\n    def __init__(self):\n        super().__init__('a')\n"
    return _node("pass", head="from rclpy.node import Node\n" + text * n)


@put_into_bombs
def frames_that_are_absent(n: int) -> Files:
    text = "self.buffer.lookup_transform('frame_{0}', 'base_link', rclpy.time.Time())"
    return _node(
        "self.buffer = Buffer()",
        *(text.format(word(i)) for i in range(n)),
        head="from tf2_ros import Buffer\n",
    )


@put_into_bombs
def clients_of_absent_services(n: int) -> Files:
    text = "self.create_client(Trigger, 'service_{0}')"
    return _node(
        *(text.format(word(i)) for i in range(n)), head="from std_srvs.srv import Trigger\n"
    )


@put_into_bombs
def cpp_includes_that_are_absent(n: int) -> Files:
    text = lines(n, lambda i: f'#include "my_robot/part_{word(i)}.hpp"')
    return compiled(f"{text}\n{compiled_node('')}")


@put_into_bombs
def cpp_topics_that_nobody_hears(n: int) -> Files:
    body = lines(n, lambda i: f'create_publisher<std_msgs::msg::String>("pose_of_{word(i)}", 1);')
    return compiled(compiled_node(body))


@put_into_bombs
def cpp_classes_of_one_name(n: int) -> Files:
    return compiled(f"{'class A : public rclcpp::Node { };' * n}\n{compiled_node('')}")


@put_into_bombs
def cpp_attribute_chains(n: int) -> Files:
    body = f"auto x = this->a{'.b' * n}; auto y = this{'->b()' * n};"
    return compiled(compiled_node(body))


@put_into_bombs
def cpp_components(n: int) -> Files:
    text = "class A{0} : public rclcpp::Node {{ }};\nRCLCPP_COMPONENTS_REGISTER_NODE(A{0})"
    return compiled(f"{lines(n, text.format)}\n{compiled_node('')}")


@put_into_bombs
def components_of_cmake(n: int) -> Files:
    text = 'add_library(l{0} SHARED src/l.cpp)\nrclcpp_components_register_node(l{0} PLUGIN "a::B{0}" EXECUTABLE e{0})'
    return cmake(lines(n, text.format), ["src/l.cpp"])


@put_into_bombs
def ignored_in_python(n: int) -> Files:
    return _node(*(f"value_{word(i)} + 1  # grader:ignore LCH" for i in range(n)))


# --- Packages and interfaces


@put_into_bombs
def dependencies_that_are_absent(n: int) -> Files:
    return package(more=lines(n, lambda i: f"<depend>package_{word(i)}</depend>"))


@put_into_bombs
def packages_of_cmake_that_are_absent(n: int) -> Files:
    return cmake(lines(n, lambda i: f"find_package(package_{word(i)} REQUIRED)"))


@put_into_bombs
def targets_that_are_absent(n: int) -> Files:
    text = "target_link_libraries(part_{0} m)\ninstall(TARGETS part_{0} DESTINATION lib/my_robot)"
    return cmake(lines(n, lambda i: text.format(word(i))))


@put_into_bombs
def entry_points_of_absent_modules(n: int) -> Files:
    return package(programs=", ".join(f"'p{i} = my_robot.part_{word(i)}:main'" for i in range(n)))


@put_into_bombs
def fields_of_absent_types(n: int) -> Files:
    text = lines(n, lambda i: f"Part{i} field_{word(i)}")
    files = cmake(
        'find_package(rosidl_default_generators REQUIRED)\nrosidl_generate_interfaces(${PROJECT_NAME} "msg/A.msg")'
    )
    return {**files, "msg/A.msg": f"{text}\n"}


@put_into_bombs
def interfaces_that_are_absent(n: int) -> Files:
    names = lines(n, lambda i: f'  "msg/Part{i}.msg"')
    return cmake(
        f"find_package(rosidl_default_generators REQUIRED)\nrosidl_generate_interfaces(${{PROJECT_NAME}}\n{names})"
    )


@put_into_bombs
def packages_with_control(n: int) -> Files:
    """Packages each of which has a robot with ros2_control, its controllers and its spawners."""
    files: Files = {}
    joint = '<joint name="joint"><command_interface name="position"/><state_interface name="position"/></joint>'
    moved = '<link name="arm"/><joint name="joint" type="continuous"><parent link="base_link"/><child link="arm"/></joint>'
    values = (
        "controller_manager:\n  ros__parameters:\n    arm:\n      type: forward_command_controller/ForwardCommandController\n"
        "arm:\n  ros__parameters:\n    joints: [joint]\n    interface_name: position\n"
    )
    launch = (
        "[Node(package='controller_manager', executable='ros2_control_node', parameters=[P + 'c.yaml']),"
        " Node(package='controller_manager', executable='spawner', arguments=['arm'])]"
    )
    for k in range(n // 10):
        name = f"robot_{word(k)}"
        own = {**package(name, urdf=robot(1, moved + _SYSTEM.format(joint)))}
        own["config/c.yaml"] = values
        own["launch/a.launch.py"] = launched(launch)["launch/a.launch.py"].replace("my_robot", name)
        own["urdf/my_robot.urdf"] = own["urdf/my_robot.urdf"].replace("my_robot", name)
        files |= {f"{name}/{path}": text for path, text in own.items()}
    return files
