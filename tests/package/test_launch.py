"""Launch files of every style that tutorials and students use, and hostile ones."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.package.launch.model import Launch
from tests.examples import examples, light
from tests.package.launch_samples import FOLDER, INNER, SAMPLES, read, summarize, summarize_sample
from tests.work import limited_work

# What is found in each sample: its nodes, and with their lines the files that it names, its faults and what is unknown.
EXPECTED = """\
add_action.launch.py
  nodes: joint_state_publisher_gui rviz2
  rviz 10: my_robot/rviz/my_robot.rviz
  forgotten: joint_state_publisher
anchors.launch.yaml
  nodes: joint_state_publisher_gui rviz2 joint_state_publisher joint_state_publisher rviz2
  rviz 7: my_robot/rviz/my_robot.rviz
  rviz 15: my_robot/rviz/my_robot.rviz
argument_never_declared.launch.py
  nodes: joint_state_publisher_gui? rviz2
  rviz 12: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
  faults 8: the launch argument 'gui' is used, but DeclareLaunchArgument does not declare it before
argument_used_before_declared.launch.py
  nodes: robot_state_publisher
  urdf 10: unknown: the launch argument 'model' is not declared
  faults 10: the launch argument 'model' is used, but DeclareLaunchArgument does not declare it before
argument_without_default.launch.py
  nodes: robot_state_publisher
  urdf 11: unknown: the launch argument 'model' has no default
arguments_of_arguments.launch.py
  nodes: robot_state_publisher
  urdf 15: my_robot/urdf/my_robot.urdf
bracket_missing.launch.py
  syntax: 8: Python cannot read the file
command_without_quotes.launch.xml
  nodes: robot_state_publisher
  urdf 3: my_robot/urdf/my_robot.urdf
  faults 3: $(command ...) needs quotes around its command: $(command 'xacro ...')
condition_on_the_environment.launch.py
  nodes: joint_state_publisher rviz2?
  rviz 10: /opt/a.rviz
conditions.launch.py
  nodes: a/equals a/not_equals! a/expression a/no_expression! a/environment? a/compared a/denied! a/calculated a/one a/wrong?
  faults 24: a condition is 'gui', expected true or false
conditions.launch.xml
  nodes: a/equal a/unequal! a/calculated a/denied! a/environment? joint_state_publisher_gui/chosen a/none a/still_none
description_in_the_file.launch.py
  nodes: robot_state_publisher
description_of_another_module.launch.py
  unknown 1: the value of my_robot.launching.generate_launch_description is known only at run time
environment_variables.launch.py
  nodes: rviz2 rviz2 rviz2 rviz2
  rviz 11: /<home>/ros2_ws/my_robot.rviz
  rviz 12: /<home>/a.rviz
  rviz 13: /<home>/a.rviz
  rviz 14: unknown: this operation is not supported
event_handlers.launch.py
  nodes: joint_state_publisher rviz2 turtlesim/turtlesim_node?
  rviz 10: /opt/a.rviz
execute_process.launch.py
  nodes: rviz2 robot_state_publisher joint_state_publisher
  urdf 9: /opt/my_robot.urdf
  rviz 8: my_robot/rviz/my_robot.rviz
file_content.launch.xml
  nodes: robot_state_publisher
  urdf 3: my_robot/urdf/my_robot.urdf
find_package_share_find.launch.py
  nodes: robot_state_publisher rviz2
  urdf 17: my_robot/urdf/my_robot.urdf
  rviz 19: my_robot/rviz/my_robot.rviz
group_and_timer.launch.py
  nodes: joint_state_publisher robot_state_publisher! rviz2
  rviz 9: /tmp/one.rviz
helper_functions.launch.py
  nodes: robot_state_publisher joint_state_publisher rviz2
  urdf 15: my_robot/urdf/my_robot.urdf
  rviz 20: my_robot/rviz/my_robot.rviz
helper_of_another_module.launch.py
  nodes: joint_state_publisher
  unknown 9: what make_rviz starts is known only at run time
include.launch.xml
  nodes: rviz2 joint_state_publisher_gui joint_state_publisher
  rviz 7: my_robot/rviz/my_robot.rviz
  include 2: my_robot/launch/inner.launch.py
include.launch.yaml
  nodes: rviz2 joint_state_publisher_gui joint_state_publisher
  rviz 10: /opt/a.rviz
  include 3: my_robot/launch/inner.launch.py
  include 7: my_robot/launch/broken.launch.py
  faults 1: Python cannot read the file
include_foreign.launch.py
  include 10: my_world/launch/world.launch.py
  unknown 10: it includes share/my_world/launch/world.launch.py, which the submission does not install
include_of_itself.launch.py
  nodes: rviz2
  rviz 8: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
  include 9: my_robot/launch/include_of_itself.launch.py
  faults 9: it includes itself
include_own.launch.py
  nodes: rviz2 joint_state_publisher_gui! joint_state_publisher
  rviz 18: my_robot/rviz/my_robot.rviz
  include 14: my_robot/launch/inner.launch.py
include_own_under_a_condition.launch.py
  nodes: joint_state_publisher_gui? joint_state_publisher?
  include 12: my_robot/launch/inner.launch.py
  include 15: my_robot/launch/broken.launch.py
  unknown 1: Python cannot read the file
include_urdf_launch.launch.py
  nodes: robot_state_publisher joint_state_publisher_gui rviz2
  urdf 14: my_robot/urdf/my_robot.urdf
  rviz 14: my_robot/rviz/my_robot.rviz
include_with_a_dict.launch.py
  nodes: joint_state_publisher_gui joint_state_publisher
  include 10: my_robot/launch/inner.launch.py
  faults 10: launch_arguments is given a dict: add .items() to it
list_in_the_list.launch.py
  nodes: rviz2 joint_state_publisher
  rviz 6: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
  faults 7: expected an action, found a list of actions: write * before it
list_returned.launch.py
  nodes: rviz2
  rviz 5: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
  faults 4: generate_launch_description does not return a LaunchDescription([...])
loop_over_nodes.launch.py
  nodes: joint_state_publisher rviz2 turtlesim/turtle_a_node turtlesim/turtle_b_node
  rviz 10: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
main_guard.launch.py
  nodes: rviz2
  rviz 6: /opt/a.rviz
misspelt_substitution.launch.xml
  nodes: rviz2 rviz2 rviz2
  rviz 2: unknown: the result of find-package-share is known only at run time
  rviz 3: my_robot/rviz/my_robot.rviz
  rviz 4: unknown: the result of my-own is known only at run time
  faults 2: there is no substitution $(find-package-share ...); did you mean $(find-pkg-share ...)?
  faults 3: the bracket of $(find-pkg-share is not closed
name_not_imported.launch.py
  nodes: rviz2
  rviz 5: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
  faults 5: the name 'Node' is not defined or imported
next_to_the_file.launch.py
  nodes: robot_state_publisher rviz2
  urdf 15: my_robot/launch/../urdf/my_robot.urdf
  rviz 16: my_robot/rviz/my_robot.rviz
no_launch.launch.xml
  syntax: 1: the root of the file is not <launch>; ros2 launch starts nothing
no_launch_key.launch.yaml
  syntax: 1: the file is not a list of actions below launch:; ros2 launch starts nothing
no_list_at_all.launch.py
  nodes: joint_state_publisher rviz2
  rviz 6: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
  faults 8: LaunchDescription takes one list: put [ ] around the actions
no_lists_for_parameters.launch.py
  nodes: robot_state_publisher
  urdf 9: /opt/a.urdf
  faults 8: parameters has to be a list: put [ ] around it
no_such_function.launch.py
  faults 1: the file does not define the function generate_launch_description, which ros2 launch calls
no_value.launch.xml
  nodes: robot_state_publisher robot_state_publisher
  urdf 2: unknown: this parameter has no value
  urdf 5: unknown: its parameters are known only at run time
  faults 3: <param> has no attribute 'textfile' in ROS 2; write 'value'
  unknown 8: what <node_container> starts is known only at run time
nodes_in_a_container.launch.py
  unknown 8: the nodes of a container are not supported
not_closed.launch.xml
  syntax: 3: not readable as XML
not_indented.launch.yaml
  faults 2: expected one action below one key, found node, pkg, exec. Is it indented far enough?
  faults 2: a node has no executable: add executable=...
  unknown 2: a node without a package is a program of the machine
not_yaml.launch.yaml
  syntax: 3: not readable as YAML
nothing_returned.launch.py
  faults 5: generate_launch_description does not return its LaunchDescription
  forgotten: rviz2
old_names_of_arguments.launch.py
  nodes: rviz2 joint_state_publisher
  rviz 7: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
  faults 7: Node has no argument 'node_executable'; did you mean 'executable'?
  faults 7: Node has no argument 'node_name'
  faults 8: Node has no argument 'paramters'; did you mean 'parameters'?
opaque_function.launch.py
  nodes: robot_state_publisher rviz2
  urdf 12: my_robot/urdf/my_robot.urdf
  rviz 17: my_robot/rviz/my_robot.rviz
opaque_function_that_decides.launch.py
  nodes: robot_state_publisher
  urdf 8: x.urdf
  unknown 9: a condition is known only at run time
  forgotten: joint_state_publisher_gui
open_read.launch.py
  nodes: robot_state_publisher
  urdf 6: my_robot/urdf/my_robot.urdf
parameters_from_yaml.launch.py
  nodes: robot_state_publisher rviz2
  urdf 11: unknown: its parameters are known only at run time
  rviz 12: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
path_instead_of_contents.launch.py
  nodes: robot_state_publisher
  urdf 9: wrong: robot_description is given the path of the URDF, not its contents: read the file first
path_join_substitution.launch.py
  nodes: robot_state_publisher rviz2
  urdf 8: my_robot/urdf/my_robot.urdf.xacro
  rviz 18: my_robot/rviz/my_robot.rviz
paths_of_one_machine.launch.py
  nodes: robot_state_publisher rviz2
  urdf 6: src/my_robot/urdf/my_robot.urdf
  rviz 11: /home/me/ros2_ws/src/my_robot/rviz/my_robot.rviz
program_chosen_at_run_time.launch.py
  unknown 9: the result of choice is known only at run time
  unknown 10: a node without a package is a program of the machine
publisher_without_robot.launch.py
  nodes: robot_state_publisher
  urdf 7: wrong: robot_state_publisher is started without robot_description: it has no robot to publish
quotes.launch.xml
  nodes: robot_state_publisher rviz2 rviz2 rviz2
  urdf 5: my_robot/urdf/my_robot.urdf
  rviz 7: my_robot/rviz/my(robot).rviz
  rviz 8: my_robot/launch/../rviz/a file.rviz
  rviz 9: $(find-pkg-share
quotes_around_a_substitution.launch.xml
  nodes: rviz2
  rviz 2: my_robot/rviz/my_robot.rviz
  faults 2: quotes cannot enclose a substitution in a line of arguments: remove them
  faults 3: a node has no executable: add executable=...
  unknown 3: the text of this value is known only at run time
  unknown 4: a node without a package is a program of the machine
read_text.launch.py
  nodes: robot_state_publisher
  urdf 12: my_robot/urdf/my_robot.urdf
ros1.launch.xml
  nodes: robot_state_publisher rviz2
  urdf 4: wrong: robot_state_publisher is started without robot_description: it has no robot to publish
  rviz 5: my_robot/rviz/my_robot.rviz
  faults 2: $(find ...) is a substitution of ROS 1; in ROS 2 write $(find-pkg-share ...)
  faults 2: <arg> has no attribute 'value' in ROS 2; write 'default'
  faults 3: $(arg ...) is a substitution of ROS 1; in ROS 2 write $(var ...)
  faults 3: <param> has no attribute 'command' in ROS 2; write 'value'
  faults 3: <param> in this place is from ROS 1 and not accepted by ROS 2: a <param> belongs in its <node>
  faults 4: <node> has no attribute 'type' in ROS 2; write 'exec'
  faults 5: $(find ...) is a substitution of ROS 1; in ROS 2 write $(find-pkg-share ...)
  faults 5: <node> has no attribute 'required' in ROS 2
  faults 5: <node> has no attribute 'type' in ROS 2; write 'exec'
ros2_launch_once_more.launch.py
  unknown 6: it starts another ros2 launch
rviz_option_in_one_text.launch.py
  nodes: rviz2 rviz2 rviz2
  rviz 9: wrong: '-d' and the path have to be two items of arguments: ['-d', path]
  rviz 10: wrong: rviz2 is given -d without the path of a file
  rviz 11: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
set_launch_configuration.launch.py
  nodes: rviz2 rviz2 rviz2
  rviz 13: /opt/one.rviz.bak
  rviz 15: /opt/one.rviz.bak
  rviz 17: unknown: the launch argument 'rviz' is set under a condition
share_directory.launch.py
  nodes: robot_state_publisher joint_state_publisher_gui rviz2
  urdf 11: my_robot/urdf/my_robot.urdf
  rviz 23: my_robot/rviz/my_robot.rviz
share_path.launch.py
  nodes: joint_state_publisher! joint_state_publisher_gui robot_state_publisher rviz2
  urdf 22: my_robot/urdf/my_robot.urdf
  rviz 39: my_robot/rviz/my_robot.rviz
slash_operator.launch.py
  nodes: robot_state_publisher rviz2
  urdf 12: my_robot/urdf/my_robot.urdf
  rviz 13: my_robot/rviz/my_robot.rviz
space_missing_in_command.launch.py
  nodes: robot_state_publisher
  urdf 11: my_robot/urdf/my_robot.urdf
  faults 11: a space is missing between xacro and the path: write 'xacro '
star_import.launch.py
  nodes: rviz2
  rviz 6: wrong: rviz2 is started without -d and a file, so it opens its own default instead of the lab's configuration
substitution_lists.launch.py
  nodes: robot_state_publisher rviz2
  urdf 10: my_robot/urdf/my_robot.urdf
  rviz 12: my_robot/rviz/my_robot.rviz
substitutions_taken_for_texts.launch.py
  nodes: robot_state_publisher robot_state_publisher rviz2
  urdf 16: /opt/a.urdf
  urdf 18: /opt/a.urdf
  rviz 19: my_robot/a.rviz
  faults 16: open takes a path, not a substitution: use Command(['cat ', ...])
  faults 18: xacro.process_file takes a path, not a substitution: use Command(['xacro ', ...])
  faults 19: os.path.join takes strings, not substitutions: use PathJoinSubstitution([...])
two_keys.launch.yaml
  syntax: 1: the file is not a list of actions below launch:; ros2 launch starts nothing
urdf_as_argument.launch.py
  nodes: robot_state_publisher
  urdf 11: my_robot/urdf/my_robot.urdf
values_that_are_no_texts.launch.yaml
  nodes: rviz2
  rviz 9: /opt/a.rviz
  faults 4: default of arg must be a string, but YAML reads true as another type: put quotes around it
  faults 7: default of arg must be a string, but YAML reads 3 as another type: put quotes around it
  faults 9: if of node must be a string, but YAML reads true as another type: put quotes around it
whole.launch.xml
  nodes: robot_state_publisher joint_state_publisher_gui joint_state_publisher! rviz2
  urdf 8: my_robot/urdf/my_robot.urdf
  rviz 15: my_robot/rviz/my_robot.rviz
whole.launch.yaml
  nodes: robot_state_publisher joint_state_publisher joint_state_publisher_gui! rviz2
  urdf 16: my_robot/urdf/my_robot.urdf
  rviz 28: my_robot/rviz/my_robot.rviz
xacro_file_read_as_it_is.launch.py
  nodes: robot_state_publisher
  urdf 9: unknown: my_robot.urdf.xacro is read without xacro; if it uses xacro, write Command(['xacro ', ...])
xacro_parse.launch.py
  nodes: robot_state_publisher
  urdf 11: my_robot/urdf/my_robot.urdf.xacro
xacro_process_file.launch.py
  nodes: robot_state_publisher
  urdf 11: my_robot/urdf/my_robot.urdf.xacro
xacro_with_options.launch.py
  nodes: robot_state_publisher robot_state_publisher robot_state_publisher robot_state_publisher
  urdf 9: /opt/a.urdf.xacro
  urdf 11: /opt/b.urdf.xacro
  urdf 13: /opt/my robot.urdf
  urdf 15: unknown: the output of this command is known only at run time
"""


def expectations() -> dict[str, list[str]]:
    """Return the lines of each sample."""
    found: dict[str, list[str]] = {}
    for line in EXPECTED.splitlines():
        if line.startswith("  "):
            found[[*found][-1]].append(line.strip())
        else:
            found[line] = []
    return found


@pytest.mark.parametrize("sample", SAMPLES)
def test_samples(sample: str) -> None:
    """Nodes, files, faults and values known only at run time are found, each with its line."""
    assert summarize_sample(sample) == expectations()[sample]


def test_every_expectation_has_its_sample() -> None:
    """The table names existing samples."""
    assert expectations().keys() == SAMPLES.keys()


PYTHON = """\
from launch import LaunchDescription
from launch.actions import *
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription, OpaqueFunction
from launch.actions import SetLaunchConfiguration
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution, PythonExpression
from launch_ros.actions import Node
{before}

def generate_launch_description():
    {inside}
    return LaunchDescription([{actions}])
"""
RVIZ = "Node(package='rviz2', executable='rviz2', arguments=['-d', {}])"


def python(actions: str, before: str = "", inside: str = "pass") -> bytes:
    """Return a launch file in Python."""
    return PYTHON.format(before=before, inside=inside, actions=actions).encode()


def doubling(last: str, name: str = "x", levels: int = 60) -> str:
    """Return nested lists, each containing the next twice: few lines that make more than any machine holds."""
    lines = [f"{name}0 = {last}", *(f"{name}{n} = [{name}{n - 1}, {name}{n - 1}]" for n in range(1, levels))]
    return "\n".join(lines)


def chained(levels: int = 60) -> str:
    """Return launch arguments, each with the one before it twice."""
    declaration = "DeclareLaunchArgument('a{}', default_value=[LaunchConfiguration('a{}'), LaunchConfiguration('a{}')])"
    return "DeclareLaunchArgument('a0', default_value='ab'), " + ", ".join(
        declaration.format(n, n - 1, n - 1) for n in range(1, levels)
    )


XML_NODE = '<node pkg="rviz2" exec="rviz2" args="{}"/>'
HOSTILE_PYTHON = {
    "nodes in doubled lists": python("x59", doubling("Node(package='a', executable='a')")),
    "texts in doubled lists": python(RVIZ.format("x59"), doubling("'ab'")),
    "package in doubled lists": python("Node(package=x59, executable='a')", doubling("'ab'")),
    "forgotten node in doubled lists": python("", doubling("'ab'"), "n = Node(package=x59, executable=x59)"),
    "command in doubled lists": python(RVIZ.format("Command(x59)"), doubling("'xacro '")),
    "path in doubled lists": python(RVIZ.format("PathJoinSubstitution(x59)"), doubling("'a'")),
    "expression in doubled lists": python(RVIZ.format("PythonExpression(x59)"), doubling("'1 + '")),
    "dicts in doubled lists": python("Node(package='rviz2', executable='rviz2', parameters=x59)", doubling("{'a': 1}")),
    "substitutions doubled": python(RVIZ.format("x"), "x = LaunchConfiguration('a', default='b')\n" + "x = PathJoinSubstitution([x, x])\n" * 60),
    "groups doubled": python("x", "x = Node(package='a', executable='a')\n" + "x = GroupAction([x, x])\n" * 60),
    "arguments doubled": python(chained() + ", " + RVIZ.format("LaunchConfiguration('a59')")),
    "list in itself": python("x", "x = []\nx.append(x)\nx.append(x)"),
    "list in itself as a text": python(RVIZ.format("x"), "x = []\nx.append(x)\nx.append(x)"),
    "list in a list, deep": python("x", "x = [Node(package='a', executable='a')]\nfor i in range(5000):\n    x = [x]"),
    "text in a list, deep": python(RVIZ.format("x"), "x = ['a']\nfor i in range(5000):\n    x = [x]"),
    "method of a method, deep": python(RVIZ.format("x"), "x = open('a')\nfor i in range(5000):\n    x = x.read()"),
    "argument of itself": python("DeclareLaunchArgument('a', default_value=LaunchConfiguration('a'))," + RVIZ.format("LaunchConfiguration('a')")),
    "thousands of nodes": python("*[Node(package='a', executable=f'b{i}') for i in range(9000)]"),
    "function of itself": python("OpaqueFunction(function=f)", "def f(context):\n    return [OpaqueFunction(function=f), OpaqueFunction(function=f)]"),
    "description of itself": python("", "ld = LaunchDescription()\nld.add_action(ld)\nld.add_action(ld)", "return ld"),
    "handler of itself": python("f", "def f():\n    return [f, f]"),
    "huge text": python(RVIZ.format("x"), "x = 'a' * 1000\nfor i in range(40):\n    x = x + x"),
    "huge number": python(RVIZ.format("x"), "x = 9\nfor i in range(9000):\n    x = x + x"),
    "long line": python("'" + "a" * 1_000_000 + "'"),
    "brackets": b"x = " + b"[" * 100_000,
    "closed brackets": b"x = " + b"[" * 90 + b"]" * 90,
    "minus signs": b"x = " + b"-" * 100_000 + b"1",
    "additions": b"x = 1" + b" + 1" * 20_000,
    "thousands of expressions": python(",".join([RVIZ.format("PythonExpression('[i for i in range(2000)]')")] * 4_000)),
    "zero bytes": b"\0" * 1000,
    "zero byte in a text": python(RVIZ.format("'a\0b'")),
    "no UTF-8": b"# \xe4\n" + python(""),
    "declared latin-1": "# -*- coding: latin-1 -*-\n# ä\n".encode("latin-1") + python(""),
    "lone surrogate": python(RVIZ.format(r"'\ud800'")),
    "surrogates everywhere": python(r"Node(package='\udcff', executable='\udcff', condition=IfCondition('\udcff'))"),
    "expression with quotes": python(RVIZ.format("PythonExpression(\"'\\\\x\\\\'\")")),
    "expression that calls": python(RVIZ.format("PythonExpression(\"__import__('os').system('echo')\")")),
    "expression that is deep": python(RVIZ.format("PythonExpression('(' * 900)")),
    "unclosed quotes of a command": python(RVIZ.format("Command('cat \"a')")),
    "empty command": python(RVIZ.format("Command('')") + ", Node(package='rviz2', executable='rviz2', arguments=[''])"),
    "break outside a loop": b"def generate_launch_description():\n    break\n",
    "continue outside a loop": python("OpaqueFunction(function=f)", "def f(context):\n    continue"),
    "return at the top": b"return 1\n",
    "end of Python": python("", "", "import sys; sys.exit(1)"),
    "strange types": python("1, None, True, 2.5, b'', (), {}, {'a': 1}, ..., Node, LaunchDescription, len, lambda: 1"),
    "strange arguments": python("Node(package=1, executable=None, parameters=1, arguments=2, condition=3), Node(**1), Node(*2)"),
    "strange calls": python("LaunchDescription(1), GroupAction(1), IncludeLaunchDescription(1), OpaqueFunction(1), DeclareLaunchArgument(1, 2), SetLaunchConfiguration(None)"),
}  # fmt: skip
HOSTILE_XML = {
    "deep": b"<launch>" + b"<group>" * 100_000,
    "deep and closed": b"<launch>" + b"<group>" * 200 + b"</group>" * 200 + b"</launch>",
    "deep substitution": f"<launch>{XML_NODE.format('$(var ' * 100_000)}</launch>".encode(),
    "deep quotes": f"<launch>{XML_NODE.format('$(var (&quot;' * 50_000)}</launch>".encode(),
    "wide": b"<launch>" + b'<node pkg="a" exec="b"/>' * 40_000 + b"</launch>",
    "wide attributes": b"<launch><node " + b" ".join(b'a%d="b"' % n for n in range(20_000)) + b"/></launch>",
    "long line": b'<launch><node pkg="' + b"a" * 1_000_000 + b'" exec="b"/></launch>',
    "many substitutions": f"<launch>{XML_NODE.format('$(var a) ' * 50_000)}</launch>".encode(),
    "backslashes": f"<launch>{XML_NODE.format(chr(92) * 100_000)}</launch>".encode(),
    "doctype": b'<!DOCTYPE launch SYSTEM "file:///etc/passwd"><launch/>',
    "entity": b'<!DOCTYPE l [<!ENTITY e SYSTEM "file:///etc/passwd">]><launch><node pkg="&e;" exec="b"/>&e;</launch>',
    "entities": b"<!DOCTYPE l [<!ENTITY a0 'ha'>"
    + b"".join(b"<!ENTITY a%d '&a%d;&a%d;'>" % (n, n - 1, n - 1) for n in range(1, 60))
    + b"]><launch><node pkg='&a59;' exec='b'/>&a59;</launch>",
    "zero bytes": b"<launch>\0</launch>",
    "no UTF-8": b'<launch><node pkg="\xe4" exec="b"/></launch>',
    "namespaces": b'<launch xmlns="urn:a" xmlns:b="urn:b"><b:node b:pkg="a"/></launch>',
    "comments": b"<launch><!-- <node> --><?pi <node> ?><![CDATA[<node>]]><node pkg='a' exec='b'/></launch>",
    "doubled arguments": (
        "<launch><let name='a0' value='ab'/>"
        + "".join(f"<let name='a{n}' value='$(var a{n - 1})$(var a{n - 1})'/>" for n in range(1, 60))
        + XML_NODE.format("-d $(var a59)") + "</launch>"
    ).encode(),
    "empty": b"",
}  # fmt: skip
HOSTILE_YAML = {
    "aliases doubled": b"launch:\n- group: &a0 [node: {pkg: a, exec: b}]\n"
    + b"".join(b"- group: &a%d [group: *a%d, group: *a%d]\n" % (n, n - 1, n - 1) for n in range(1, 60)),
    "children doubled": b"launch:\n- x: &a0 {y: z}\n"
    + b"".join(b"- x: &a%d {p: [*a%d, *a%d]}\n" % (n, n - 1, n - 1) for n in range(1, 60)),
    "alias of itself": b"launch: &a\n- group: *a\n- group: *a\n",
    "merge of itself": b"launch:\n- node: &a\n    <<: *a\n    pkg: a\n    exec: b\n",
    "merges of merges": b"launch:\n- node: &a0 {pkg: a, exec: b}\n"
    + b"".join(b"- node: &a%d {<<: [*a%d, *a%d]}\n" % (n, n - 1, n - 1) for n in range(1, 60)),
    "brackets": b"launch: " + b"[" * 100_000,
    "braces": b"launch: " + b"{a: " * 100_000,
    "dashes": b"launch: \n" + b"- " * 100_000,
    "long line": b"launch:\n- node: {pkg: " + b"a" * 400_000 + b", exec: b}",
    "zero bytes": b"launch: \0",
    "no UTF-8": b"launch:\n- node: {pkg: \xe4, exec: b}\n",
    "strange types": b"launch:\n- 1\n- \n- [node]\n- {}\n- {1: 2}\n- {[a]: b}\n- node: \n- node: 3\n- node: [a]\n- group: a\n",
    "a text": b"launch: yes",
    "many documents": b"---\n" * 10_000,
    "python tag": b"launch: !!python/object/apply:os.system ['true']\n",
    "empty": b"",
}


COSTLY = {
    "wide.launch.xml", "many substitutions.launch.xml", "thousands of expressions.launch.py", "deep substitution.launch.xml",
    "long line.launch.xml", "wide attributes.launch.xml", "thousands of nodes.launch.py", "deep quotes.launch.xml",
    "function of itself.launch.py", "aliases doubled.launch.yaml", "text in a list, deep.launch.py", "long line.launch.yaml",
    "method of a method, deep.launch.py", "huge number.launch.py",
}  # fmt: skip


def hostile() -> list[tuple[str, bytes]]:
    """Return every hostile file with its name as a launch file."""
    kinds = {".launch.py": HOSTILE_PYTHON, ".launch.xml": HOSTILE_XML, ".launch.yaml": HOSTILE_YAML}
    return [(name + ending, data) for ending, samples in kinds.items() for name, data in samples.items()]


def is_well_formed(launch: Launch) -> bool:
    """Return whether the results are bounded and have locations in the file."""
    nodes = [*launch.nodes, *launch.forgotten]
    faults = [*launch.faults, *launch.unknown, *filter(None, [launch.syntax])]
    locations = [item.location for part in (nodes, launch.references, faults) for item in part]
    return len(locations) < 20_000 and all(at_location.line > 0 and at_location.column > 0 for at_location in locations)


@pytest.mark.parametrize(
    ("name", "data"), light(hostile(), lambda row: row[0] in COSTLY), ids=[name for name, _ in hostile()]
)
def test_hostile_files(name: str, data: bytes) -> None:
    """Whatever a launch file contains, nothing raises or takes long."""
    with limited_work(30_000_000):
        launch = read(data, name)
        assert is_well_formed(launch)
        summarize(launch)


TWO = """\
<launch>
  <node pkg="a" exec="a"/>
  <include file="$(dirname)/{}.launch.xml"/>
  <include file="$(dirname)/{}.launch.xml"/>
</launch>
"""


def test_two_files_that_include_each_other() -> None:
    """A cycle of included files ends, and is a fault."""
    others = {f"{FOLDER}/{one}.launch.xml": TWO.format(two, two).encode() for one, two in ("ab", "ba")}
    launch = read(others[f"{FOLDER}/a.launch.xml"], "a.launch.xml", others)
    assert {fault.message for fault in launch.faults} == {"it includes itself"}
    assert len(launch.nodes) == 3


def test_many_includes() -> None:
    """Files that include the next one twice are evaluated up to a bound, which is reported."""
    others = {f"{FOLDER}/f{n}.launch.xml": TWO.format(f"f{n + 1}", f"f{n + 1}").encode() for n in range(40)}
    with limited_work(50_000):
        launch = read(others[f"{FOLDER}/f0.launch.xml"], "f0.launch.xml", others)
    assert "it includes more than 10 launch files" in {unknown.message for unknown in launch.unknown}
    assert len(launch.nodes) < 50


def test_arguments_of_an_include_stay_set() -> None:
    """The arguments of an include stay set after it, as in ROS 2; those of a group end with the group."""
    text = """\
<launch>
  <arg name="config" default="/opt/own.rviz"/>
  <group>
    <include file="$(dirname)/inner.launch.py"><arg name="config" value="/opt/given.rviz"/></include>
    <node pkg="rviz2" exec="rviz2" args="-d $(var config)"/>
  </group>
  <node pkg="rviz2" exec="rviz2" args="-d $(var config)"/>
</launch>
"""
    launch = read(text.encode(), "x.launch.xml")
    assert [node.path for node in launch.named("rviz")] == ["/opt/given.rviz", "/opt/own.rviz"]


PIECES = st.sampled_from(
    [piece for path in SAMPLES.values() for piece in path.read_bytes().split(b"\n")]
    + [b"$(", b")", b"'", b'"', b"\\", b"[", b"]", b"{", b"}", b"&a ", b"*a", b"<launch>", b"</launch>", b"\0", b"\xff", b"\xed\xa0\x80"]
)  # fmt: skip


@examples(20)
@given(
    st.sampled_from(sorted(SAMPLES)),
    st.lists(
        st.tuples(st.integers(0, 3000), st.integers(0, 40), PIECES | st.binary(max_size=6)), min_size=1, max_size=5
    ),
)
def test_changed_files(sample: str, changes: list[tuple[int, int, bytes]]) -> None:
    """A sample with some text removed and other text inserted is evaluated without an exception."""
    data = SAMPLES[sample].read_bytes()
    for at_location, length, piece in changes:
        at = at_location % (len(data) + 1)
        data = data[:at] + piece + data[at + length :]
    with limited_work(30_000):
        assert is_well_formed(read(data, sample, {**INNER, f"{FOLDER}/{sample}": data}))


@examples(20)
@given(
    st.binary(max_size=300) | st.lists(PIECES, max_size=20).map(b"\n".join),
    st.sampled_from([".py", ".xml", ".yaml", ""]),
)
def test_random_files(data: bytes, ending: str) -> None:
    """Any bytes are evaluated without an exception."""
    with limited_work(2_000):
        assert is_well_formed(read(data, f"x.launch{ending}"))


def test_an_included_file_is_read_again() -> None:
    """Of two equal launch files, each starts what the file that it includes starts in its own package."""
    starts = '<launch><node pkg="{0}" exec="{0}"/></launch>'
    outer = b'<launch><include file="$(dirname)/inner.launch.xml"/></launch>'
    launches = [
        read(outer, "outer.launch.xml", {f"{FOLDER}/inner.launch.xml": starts.format(name).encode()})
        for name in ("rviz2", "xacro", "rviz2")
    ]
    assert [[node.name for node in launch.nodes] for launch in launches] == [["rviz2"], ["xacro"], ["rviz2"]]
