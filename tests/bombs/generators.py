"""Inputs by their size n: what grows with n, and with what it is joined, is in the name.

Each has a few bytes for each n; a reader that compares all with all takes n * n.
"""

from collections.abc import Callable

from tests.bombs.files import (
    URDF,
    Files,
    cmake,
    launched,
    lines,
    package,
    program,
    robot,
    started,
    word,
)

Bomb = Callable[[int], Files]
BOMBS: dict[str, Bomb] = {}


def put_into_bombs(build: Bomb) -> Bomb:
    """Put a generator into the table of all."""
    BOMBS[build.__name__] = build
    return build


# --- YAML and parameters
# ----------------------------------------------------------------------


@put_into_bombs
def yaml_aliases(n: int) -> Files:
    levels = lines(n, lambda i: f"a{i + 1}: &a{i + 1} {{a: *a{i}, b: *a{i}, c: *a{i}}}")
    text = f"a0: &a0 {{x: 1, y: 2}}\n{levels}\nn0:\n  ros__parameters: *a{n}\n"
    return {**launched(started(1, "P + 'p.yaml'")), "config/p.yaml": text}


@put_into_bombs
def yaml_aliases_of_lists(n: int) -> Files:
    levels = lines(n, lambda i: f"a{i + 1}: &a{i + 1} [*a{i}, {{k: *a{i}}}]")
    text = f"a0: &a0 [{{plugin: a}}]\n{levels}\nn0:\n  ros__parameters: {{p: *a{n}}}\n"
    return {**launched(started(1, "P + 'p.yaml'")), "config/p.yaml": text}


@put_into_bombs
def nodes_with_one_file(n: int) -> Files:
    values = lines(n, lambda i: f"    p{i}: {i}")
    text = f"/**:\n  ros__parameters:\n{values}\n"
    return {**launched(started(n, "P + 'p.yaml'")), "config/p.yaml": text}


@put_into_bombs
def nodes_with_many_files(n: int) -> Files:
    files = ", ".join(f"P + 'p{i}.yaml'" for i in range(20))
    texts = {
        f"config/p{k}.yaml": lines(n // 20, lambda i: f"n{i}:\n  ros__parameters: {{p: {i}}}")
        for k in range(20)
    }
    return {**launched(started(n, files)), **texts}


@put_into_bombs
def own_nodes_with_files(n: int) -> Files:
    code = program(f"self.declare_parameter('p{i}', {i})" for i in range(n))
    text = f"/**:\n  ros__parameters:\n{lines(n, lambda i: f'    p{i}: {i}')}\n"
    files = launched(started(n, "P + 'p.yaml'"), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": code, "config/p.yaml": text}


@put_into_bombs
def sections_with_wildcards(n: int) -> Files:
    text = lines(n, lambda i: f"n*{i}*x:\n  ros__parameters: {{p: 1}}")
    return {**launched(started(n, "P + 'p.yaml'")), "config/p.yaml": text}


@put_into_bombs
def sections_of_other_names(n: int) -> Files:
    text = lines(n, lambda i: f"node_of_robot_{i}_x:\n  ros__parameters: {{p: 1}}")
    more = ", namespace='node_of_robot_%d_y' % i"
    files = launched(started(n, "P + 'p.yaml'", more=more).replace("'n%d'", "'node_of_robot_%d_y'"))
    return {**files, "config/p.yaml": text}


@put_into_bombs
def keys_with_dots(n: int) -> Files:
    text = "n0:\n  ros__parameters:\n" + lines(n, lambda i: f"    a.b{i}.c: {i}")
    return {**launched(started(1, "P + 'p.yaml'")), "config/p.yaml": text}


@put_into_bombs
def parameters_in_words(n: int) -> Files:
    words = ", ".join(f"'-p', 'p{i}:={i}'" for i in range(n))
    more = f", arguments=['--ros-args', {words}]"
    return launched(started(20, more=more))


@put_into_bombs
def plugin_lists(n: int) -> Files:
    files: Files = {}
    for k in range(n // 10):
        names = ", ".join(f"a{i}" for i in range(10))
        sections = lines(10, lambda i: f"    b{i}: {{plugin: x}}")
        files[f"config/p{k}.yaml"] = (
            f"m{k}:\n  ros__parameters:\n    filter_plugins: [{names}]\n{sections}\n"
        )
    return {**package(), **files}


@put_into_bombs
def aliases_to_misspelt_keys(n: int) -> Files:
    text = lines(n, lambda i: f"n{i}:\n  ros__parametersx{i}: {{p: 1}}")
    return {**launched(started(1, "P + 'p.yaml'")), "config/p.yaml": text}


# --- Topics and nodes
# ----------------------------------------------------------------------


@put_into_bombs
def topics_of_one_name(n: int) -> Files:
    code = program(
        f"self.create_{kind}(String, 't', {last})"
        for kind, last in (("publisher", "10"), ("subscription", "self.c, 10"))
        for _ in range(n)
    )
    files = launched(started(1), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": code}


@put_into_bombs
def topics_of_similar_names(n: int) -> Files:
    code = program(
        line
        for i in range(n)
        for line in (
            f"self.create_publisher(String, 'topic_of_robot_{word(i)}_a', 10)",
            f"self.create_subscription(String, 'topic_of_robot_{word(i)}_b', self.c, 10)",
        )
    )
    files = launched(started(1), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": code}


@put_into_bombs
def node_started_often(n: int) -> Files:
    code = program(
        line
        for i in range(n // 4)
        for line in (
            f"self.create_publisher(String, 'a{i}', 10)",
            f"self.create_subscription(String, 'b{i}', self.c, 10)",
        )
    )
    files = launched(started(n), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": code}


@put_into_bombs
def remappings(n: int) -> Files:
    code = program(f"self.create_publisher(String, 'a{i}', 10)" for i in range(n))
    rules = ", ".join(f"('a{i}', 'b{i}')" for i in range(n))
    files = launched(started(10, more=f", remappings=[{rules}]"), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": code}


@put_into_bombs
def nodes_without_program(n: int) -> Files:
    programs = ", ".join(f"'program_{word(i)}_of_robot = my_robot.x:main'" for i in range(n))
    files = launched(started(n, program="'program_%d_of_robat' % i"), programs=programs)
    return {**files, "my_robot/x.py": program(["pass"])}


@put_into_bombs
def launches_of_one_node(n: int) -> Files:
    text = launched(started(2))["launch/a.launch.py"]
    files: Files = {}
    for k in range(n // 20):
        files |= {f"p{k}/{path}": data for path, data in package(f"p{k}").items()}
        files |= {f"p{k}/launch/a{i}.launch.py": text for i in range(20)}
    return files


@put_into_bombs
def lifecycle_names(n: int) -> Files:
    names = ", ".join(f"node_{word(i)}_of_robat" for i in range(n))
    text = f"lifecycle_manager:\n  ros__parameters:\n    node_names: [{names}]\n"
    manager = (
        "Node(package='nav2_lifecycle_manager', executable='lifecycle_manager', "
        "name='lifecycle_manager', parameters=[P + 'p.yaml'])"
    )
    nodes = started(n).replace("'n%d'", "'node_%d_of_robot'")
    return {**launched(f"[{manager}] + {nodes}"), "config/p.yaml": text}


@put_into_bombs
def modules_that_import(n: int) -> Files:
    files = launched(started(1), programs="'x = my_robot.m0:main'")
    for i in range(n):
        imports = "\n".join(f"from my_robot.m{(i + j + 1) % n} import N as N{j}" for j in range(3))
        files[f"my_robot/m{i}.py"] = f"{imports}\n{program(['pass'])}"
    return files


@put_into_bombs
def callbacks_that_are_functions(n: int) -> Files:
    timers = [f"self.create_timer(1.0, f_{word(i)})" for i in range(n)]
    functions = lines(n, lambda i: f"def f_{word(i)}():\n    pass")
    files = launched(started(1), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": f"{functions}\n{program(timers)}"}


@put_into_bombs
def callbacks_that_are_methods(n: int) -> Files:
    services = [f"self.create_service(Trigger, 's{i}', self.m_{word(i)})" for i in range(n)]
    methods = lines(
        n, lambda i: f"    def m_{word(i)}(self, request, response):\n        return response"
    )
    code = program(services).replace("def main():", f"{methods}\ndef main():")
    files = launched(started(1), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": f"from std_srvs.srv import Trigger\n{code}"}


@put_into_bombs
def classes_of_nodes_of_each_other(n: int) -> Files:
    classes = lines(
        n,
        lambda i: (
            f"class C{i + 1}({f'C{i}' if i else 'N'}):\n    def __init__(self):\n        super().__init__()"
        ),
    )
    code = program(["self.create_timer(1.0, self.destroy_node)"])
    files = launched(started(1), programs="'x = my_robot.x:main'")
    return {**files, "my_robot/x.py": f"{code}\n{classes}"}


# --- Robots, SRDF, controllers and Gazebo
# ----------------------------------------------------------------------


@put_into_bombs
def frames_of_similar_names(n: int) -> Files:
    text = "n0:\n  ros__parameters:\n" + lines(
        n, lambda i: f"    a{i}: {{base_frame: link_{word(i)}}}"
    )
    return {**package(urdf=robot(n)), "config/p.yaml": text}


@put_into_bombs
def joints_of_controllers(n: int) -> Files:
    joints = ", ".join(f"joint_{word(i)}" for i in range(n))
    text = (
        "controller_manager:\n  ros__parameters:\n    a: {type: "
        "joint_trajectory_controller/JointTrajectoryController}\n"
        f"a:\n  ros__parameters:\n    joints: [{joints}]\n    command_interfaces: [position]\n"
    )
    system = lines(
        n, lambda i: f'<joint name="joint_{i}"><command_interface name="velocity"/></joint>'
    )
    urdf = robot(n, f'<ros2_control name="s" type="system">{system}</ros2_control>')
    return {**package(urdf=urdf), "config/p.yaml": text}


@put_into_bombs
def controllers_and_spawners(n: int) -> Files:
    types = lines(
        n,
        lambda i: f"    c{i}: {{type: diff_drive_controller/DiffDriveController{word(i)}}}",
    )
    sections = lines(n, lambda i: f"c{word(i)}:\n  ros__parameters: {{left_wheel_names: [a]}}")
    text = f"controller_manager:\n  ros__parameters:\n{types}\n{sections}\n"
    manager = (
        "Node(package='controller_manager', executable='ros2_control_node', "
        "parameters=[P + 'p.yaml'])"
    )
    spawner = "Node(package='controller_manager', executable='spawner', arguments=['c%d' % i])"
    actions = f"[{manager}] + [{spawner} for i in range({n})]"
    return {**launched(actions), "config/p.yaml": text}


@put_into_bombs
def srdf_links(n: int) -> Files:
    pairs = lines(
        n,
        lambda i: (
            f'<disable_collisions link1="link_{word(i)}" link2="link_{word(i + 1)}" reason="Never"/>'
        ),
    )
    groups = lines(n, lambda i: f'<group name="g{i}"><joint name="joint_{word(i)}"/></group>')
    text = f'<robot name="my_robot">\n{groups}\n{pairs}\n</robot>'
    return {**package(urdf=robot(n)), "config/my_robot.srdf": text}


@put_into_bombs
def static_transforms(n: int) -> Files:
    words = "['--frame-id', 'link_x%d' % i, '--child-frame-id', 'link_%d_a' % i]"
    node = f"Node(package='tf2_ros', executable='static_transform_publisher', arguments={words})"
    return launched(f"[{node} for i in range({n})]", urdf=robot(n))


@put_into_bombs
def bridges_and_sensors(n: int) -> Files:
    sensors = lines(
        n,
        lambda i: f'<sensor name="s{i}" type="imu"><topic>imu/{word(i)}/of/robot</topic></sensor>',
    )
    urdf = robot(1, f'<gazebo reference="link_aaaaa_a">{sensors}</gazebo>')
    rows = lines(
        n,
        lambda i: (
            f"- ros_topic_name: a{i}\n  gz_topic_name: imu/{word(i)}/of/robat\n"
            "  ros_type_name: sensor_msgs/msg/Imu\n  gz_type_name: gz.msgs.IMU\n"
            "  direction: GZ_TO_ROS"
        ),
    )
    return {**package(urdf=urdf), "config/bridge.yaml": rows}


@put_into_bombs
def models_of_a_world(n: int) -> Files:
    uris = lines(n, lambda i: f"<include><uri>model://model_of_raam_{word(i)}</uri></include>")
    world = f'<sdf version="1.9"><world name="w">\n{uris}\n</world></sdf>'
    models = {f"models/model_of_room_{word(i)}/model.sdf": "<sdf/>" for i in range(n)}
    return {**package(), "worlds/w.sdf": world, **models}


@put_into_bombs
def arguments_of_xacro(n: int) -> Files:
    macros = lines(
        n,
        lambda i: (
            f'<xacro:property name="p{i}" value="${{p{i + 1}}}"/>'
            f'<xacro:if value="$(arg a)"><link name="${{p{i}}}_x"/></xacro:if>'
        ),
    )
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base_link"/>'
        f'<xacro:arg name="a" default="0"/>\n{macros}\n</robot>'
    )
    return {**package(), "urdf/other.urdf.xacro": text}


@put_into_bombs
def paths_in_xacro(n: int) -> Files:
    properties = lines(
        n, lambda i: f'<xacro:property name="p{i}" value="$(find my_robot)/meshes/m{i}.stl"/>'
    )
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base_link"/>\n'
        f"{properties}\n</robot>"
    )
    meshes = {f"meshes/m{i}x.stl": "" for i in range(n)}
    return {**package(), "urdf/other.urdf.xacro": text, **meshes}


@put_into_bombs
def robots_of_xacro(n: int) -> Files:
    loop = '<xacro:macro name="m" params="n"><xacro:if value="${n}"><xacro:m n="${n - 1}"/></xacro:if></xacro:macro>'
    calls = '<xacro:m n="60"/>' * 40
    text = (
        '<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"><link name="base_link"/>'
        f"{loop}{calls}</robot>"
    )
    return {**package(), **{f"urdf/r{i}.urdf.xacro": text for i in range(n // 10)}}


@put_into_bombs
def paths_that_are_absent(n: int) -> Files:
    text = "n0:\n  ros__parameters:\n" + lines(
        n, lambda i: f"    a{i}: $(find-pkg-share my_robot)/config/file_of_robot_{word(i)}.yaml"
    )
    others = {f"config/file_of_robat_{word(i)}.yaml": "a: 1" for i in range(n // 4)}
    return {**launched(started(1, "P + 'p.yaml'")), "config/p.yaml": text, **others}


@put_into_bombs
def maps_without_image(n: int) -> Files:
    maps = {f"maps/m{i}.yaml": f"image: room_{word(i)}.pgm\nresolution: 0.05\n" for i in range(60)}
    images = {f"maps/rooms_{word(i)}.pgm": "" for i in range(n)}
    return {**package(), **maps, **images}


@put_into_bombs
def displays_of_rviz(n: int) -> Files:
    displays = lines(n, lambda i: f"    - {{Class: rviz/TF{i}, Name: d{i}, Enabled: true}}")
    text = f"Visualization Manager:\n  Displays:\n{displays}\n"
    return {**package(), "rviz/a.rviz": text}


@put_into_bombs
def dependencies(n: int) -> Files:
    more = lines(n, lambda i: f"<depend>package_of_robot_{word(i)}</depend>")
    finds = lines(n, lambda i: f'<mesh filename="package://package_of_robat_{word(i)}/a.stl"/>')
    urdf = f'<robot name="my_robot"><link name="base_link"><visual><geometry>{finds}</geometry></visual></link></robot>'
    return package(more=more, urdf=urdf)


@put_into_bombs
def packages_that_depend(n: int) -> Files:
    files: Files = {}
    for k in range(n // 10):
        more = lines(15, lambda i: f"<depend>p{i}</depend>")
        files |= {f"p{k}/{path}": data for path, data in package(f"p{k}", more).items()}
    return files


# --- Launch files
# ----------------------------------------------------------------------


@put_into_bombs
def launch_files_with_loops(n: int) -> Files:
    loop = "def f():\n    x = 0\n    for a in range(100):\n        for b in range(100):\n            x = x + 1\nf()\n"
    text = launched(started(1))["launch/a.launch.py"]
    return {**package(), **{f"launch/a{i}.launch.py": loop + text for i in range(n)}}


@put_into_bombs
def launch_files_in_xml(n: int) -> Files:
    groups = lines(
        n,
        lambda i: (
            f'<arg name="a{i}" default="$(var a{max(i - 1, 0)})"/>'
            f'<node pkg="my_robot" exec="x" name="n{i}" if="$(eval \'1 + 1\')"/>'
        ),
    )
    return {**package(), "launch/a.launch.xml": f"<launch>\n{groups}\n</launch>"}


@put_into_bombs
def launch_files_in_yaml(n: int) -> Files:
    nodes = lines(n, lambda i: f"- node: {{pkg: my_robot, exec: x, name: n{i}}}")
    return {**package(), "launch/a.launch.yaml": f"launch:\n{nodes}\n"}


@put_into_bombs
def includes_with_arguments(n: int) -> Files:
    passed = lines(n, lambda i: f'<arg name="argument_{word(i)}_x" value="1"/>')
    declared = lines(n, lambda i: f'<arg name="argument_{word(i)}" default="1"/>')
    include = '<include file="$(find-pkg-share my_robot)/launch/b.launch.xml">'
    return {
        **package(),
        "launch/a.launch.xml": f"<launch>{include}\n{passed}\n</include></launch>",
        "launch/b.launch.xml": f"<launch>\n{declared}\n</launch>",
    }


@put_into_bombs
def includes_of_includes(n: int) -> Files:
    include = '<include file="$(find-pkg-share my_robot)/launch/a{}.launch.xml"/>'
    files = {
        f"launch/a{i}.launch.xml": f"<launch>{include.format(i + 1) * 3}</launch>"
        for i in range(n // 10)
    }
    nodes = lines(n, lambda i: f'<node pkg="my_robot" exec="x" name="n{i}"/>')
    last = {f"launch/a{n // 10}.launch.xml": f"<launch>{nodes}</launch>"}
    return {**package(), **files, **last}


# --- Builds
# ----------------------------------------------------------------------


@put_into_bombs
def cmake_targets(n: int) -> Files:
    targets = lines(n, lambda i: f"add_library(library_of_robot_{word(i)} INTERFACE)")
    links = lines(n, lambda i: f"target_link_libraries(library_of_robat_{word(i)} a)")
    return cmake(f"{targets}\n{links}")


@put_into_bombs
def cmake_unset_variables(n: int) -> Files:
    found = lines(n, lambda i: f"find_package(p{i})")
    return cmake(f"{found}\n{lines(n, lambda i: f'set(x ${{z{i}}})')}")


@put_into_bombs
def cmake_missing_files(n: int) -> Files:
    names = " ".join(f"config/file_{word(i)}_x.yaml" for i in range(n))
    text = f"install(FILES {names} DESTINATION share/my_robot)"
    return cmake(text, (f"config/file_{word(i)}_y.yaml" for i in range(n)))


@put_into_bombs
def cmake_calls(n: int) -> Files:
    variables = lines(n, lambda i: f"set(v{i} 1)")
    calls = lines(n, lambda _: "f()")
    return cmake(f"{variables}\nfunction(f)\nendfunction()\n{calls}")


@put_into_bombs
def cmake_globs(n: int) -> Files:
    globs = lines(n, lambda i: f"file(GLOB_RECURSE g{i} config/*{i}*a*b.yaml)")
    return cmake(globs, (f"config/f{i}.yaml" for i in range(n)))


@put_into_bombs
def cmake_patterns(n: int) -> Files:
    patterns = " ".join(f"PATTERN *a{i}*b EXCLUDE" for i in range(n))
    text = f"install(DIRECTORY config DESTINATION share/my_robot {patterns})"
    return cmake(text, (f"config/f{i}.yaml" for i in range(n)))


@put_into_bombs
def cmake_folders(n: int) -> Files:
    names = " ".join("config" for _ in range(n))
    text = f"install(DIRECTORY {names} DESTINATION share/my_robot)"
    return cmake(text, (f"config/f{i}.yaml" for i in range(n)))


@put_into_bombs
def cmake_lists(n: int) -> Files:
    return cmake(lines(n, lambda i: f"list(APPEND L item_{i})\nset(x ${{L}})"))


@put_into_bombs
def cmake_packages(n: int) -> Files:
    found = lines(n, lambda i: f"find_package(package_of_robot_{word(i)} REQUIRED)")
    names = " ".join(f"package_of_robat_{word(i)}" for i in range(n))
    return cmake(f"{found}\nadd_library(a INTERFACE)\nament_target_dependencies(a {names})")


@put_into_bombs
def cmake_conditions(n: int) -> Files:
    words = " OR ".join(f'EXISTS "${{CMAKE_SOURCE_DIR}}/a{i}"' for i in range(n))
    return cmake(f"if({words})\nendif()", (f"b/c{i}" for i in range(n)))


@put_into_bombs
def setup_globs(n: int) -> Files:
    globs = ", ".join(f"('share/my_robot/g{i}', glob('config/*{i}*x'))" for i in range(n))
    files = package()
    files["setup.py"] = files["setup.py"].replace("data_files=[", f"data_files=[{globs},")
    return {**files, **{f"config/f{i}.yaml": "" for i in range(n)}}


@put_into_bombs
def setup_missing_files(n: int) -> Files:
    names = ", ".join(f"'config/file_{word(i)}_x.yaml'" for i in range(n))
    files = package()
    files["setup.py"] = files["setup.py"].replace(
        "data_files=[", f"data_files=[('share/my_robot', [{names}]),"
    )
    return {**files, **{f"config/file_{word(i)}_y.yaml": "" for i in range(n)}}


@put_into_bombs
def entry_points(n: int) -> Files:
    programs = ", ".join(f"'x{i} = my_robot.x:function_{word(i)}_x'" for i in range(n))
    code = lines(n, lambda i: f"def function_{word(i)}(): pass")
    return {**package(programs=programs), "my_robot/x.py": code}


@put_into_bombs
def meshes_that_are_absent(n: int) -> Files:
    visuals = lines(
        n,
        lambda i: (
            f'<visual><geometry><mesh filename="package://my_robot/meshes/part_{word(i)}_x.stl"/>'
            "</geometry></visual>"
        ),
    )
    urdf = f'<robot name="my_robot"><link name="base_link">{visuals}</link></robot>'
    return {**package(urdf=urdf), **{f"meshes/part_{word(i)}_y.stl": "" for i in range(n)}}


@put_into_bombs
def ignored_files(n: int) -> Files:
    rules = lines(n, lambda i: f"*a{i}*b*c")
    return {**package(), ".gitignore": rules, **{f"config/f{i}.yaml": "" for i in range(n)}}


@put_into_bombs
def names_in_documents(n: int) -> Files:
    return {**package(), "README.md": "ROS 2 humble " * n, "Dockerfile": "FROM ros:humble\n" * n}


@put_into_bombs
def loose_robots(n: int) -> Files:
    return {**package(), **{f"robots/r{i}.urdf": URDF for i in range(n)}}


# --- C++
# ----------------------------------------------------------------------


def compiled(text: str, more: str = "", count: int = 1) -> Files:
    """Return the files of a package that CMake builds, with this text of one program."""
    targets = "".join(f"add_executable(p{i} src/p.cpp)\n" for i in range(count))
    head = "#include <rclcpp/rclcpp.hpp>\n"
    main = "int main() { rclcpp::spin(std::make_shared<N>()); }\n"
    return {**cmake(f"{targets}{more}"), "src/p.cpp": f"{head}{text}{main}"}


def compiled_node(body: str, members: str = "") -> str:
    """Return the text of a node in C++ that does this when it is made."""
    return (
        f'class N : public rclcpp::Node {{ public: N() : Node("n") {{\n{body}\n}} {members} }};\n'
    )


@put_into_bombs
def cpp_variables_of_variables(n: int) -> Files:
    names = lines(n, lambda i: f'const std::string a{i + 1} = a{i} + "a";')
    return compiled(
        f'const std::string a0 = "a";\n{names}\n{compiled_node(f"create_client<A>(a{n});")}'
    )


@put_into_bombs
def cpp_constants_that_double(n: int) -> Files:
    names = lines(n, lambda i: f"const std::string a{i + 1} = a{i} + a{i};")
    return compiled(
        f'const std::string a0 = "a";\n{names}\n{compiled_node(f"create_client<A>(a{n}); create_client<A>(a20);")}'
    )


@put_into_bombs
def cpp_variables_of_each_other(n: int) -> Files:
    body = lines(
        n,
        lambda i: f"std::string a{i}; a{i} = a{i - 1} + a{i - 2}; a{i} = a{i + 1};",
    )
    return compiled(compiled_node(f"{body}\ncreate_client<A>(a{n - 1});"))


@put_into_bombs
def cpp_uses_of_one_variable(n: int) -> Files:
    uses = lines(n, lambda i: f"declare_parameter(name, {i});")
    return compiled(compiled_node(f'std::string name = "a";\n{uses}'))


@put_into_bombs
def cpp_declarations_of_one_variable(n: int) -> Files:
    body = lines(n, lambda i: f'{{ std::string name = "a"; declare_parameter(name, {i}); }}')
    return compiled(compiled_node(body))


@put_into_bombs
def cpp_uses_of_one_member(n: int) -> Files:
    uses = lines(n, lambda i: f"declare_parameter(name_, {i});")
    return compiled(compiled_node(uses, 'std::string name_ = "a";'))


@put_into_bombs
def cpp_classes_of_classes(n: int) -> Files:
    classes = lines(n, lambda i: f"class A{i + 1} : public A{i} {{}};")
    return compiled(f"class A0 : public rclcpp::Node {{}};\n{classes}\n{compiled_node('')}")


@put_into_bombs
def cpp_names_of_names(n: int) -> Files:
    names = lines(n, lambda i: f"using A{i + 1} = A{i};")
    return compiled(f"using A0 = rclcpp::Node;\n{names}\nclass N : public A{n} {{}};\n")


@put_into_bombs
def cpp_namespaces(n: int) -> Files:
    opened = lines(n, lambda i: f"using namespace a{i};")
    body = lines(n, lambda i: f'create_publisher<B{i}>("b", 1);')
    return compiled(f"{opened}\n{compiled_node(body)}")


@put_into_bombs
def cpp_nested_namespaces(n: int) -> Files:
    opened, closed = lines(n, lambda i: f"namespace a{i} {{"), "}" * n
    return compiled(f"{opened}\nconst auto b = c;\n{closed}\n{compiled_node('')}")


@put_into_bombs
def cpp_headers(n: int) -> Files:
    headers = {f"src/h{i}.hpp": f'#include "h{i + 1}.hpp"\n' for i in range(n)}
    return {**compiled(f'#include "h0.hpp"\n{compiled_node("")}'), **headers}


@put_into_bombs
def cpp_headers_of_each_other(n: int) -> Files:
    names = lines(20, lambda i: f'#include "h{i}.hpp"')
    headers = {f"src/h{i}.hpp": f"{names}\n{'int a;' * (n // 20)}\n" for i in range(20)}
    return {**compiled(f"{names}\n{compiled_node('')}"), **headers}


@put_into_bombs
def cpp_targets_of_one_file(n: int) -> Files:
    body = lines(n, lambda i: f'declare_parameter("p{i}", {i});')
    return compiled(compiled_node(body), count=max(1, n // 10))


@put_into_bombs
def cpp_macros(n: int) -> Files:
    macros = lines(n, lambda i: f"#define A{i + 1} A{i}")
    return compiled(f'#define A0 "a"\n{macros}\n{compiled_node(f"declare_parameter(A{n}, 1);")}')


@put_into_bombs
def cpp_texts_side_by_side(n: int) -> Files:
    texts = lines(n, lambda _: '"a"', " ")
    return compiled(compiled_node(f"declare_parameter({texts}, 1);"))


@put_into_bombs
def cpp_calls_in_calls(n: int) -> Files:
    return compiled(compiled_node(f"{'f(' * n}1{')' * n};"))


@put_into_bombs
def cpp_objects_that_are_given(n: int) -> Files:
    made = lines(n, lambda i: f"auto n{i} = std::make_shared<N>(); f{i}(n{i});")
    program = f"{compiled_node('')}int main() {{ {made} }}\n"
    return {**compiled(""), "src/p.cpp": program}


@put_into_bombs
def cpp_frames(n: int) -> Files:
    body = lines(n, lambda i: f't.child_frame_id = "b{i}"; b.sendTransform(t);')
    return compiled(compiled_node(f"geometry_msgs::msg::TransformStamped t;\n{body}"))
