"""Texts in which one search, parse or comparison may run as often as the text is long, or oftener.

A budget does not see such work: it is inside of one call.
"""

from tests.bombs.files import Files, cmake, package
from tests.bombs.generators import compiled, compiled_node

_XACRO = (
    '<robot name="my_robot" xmlns:xacro="http://www.ros.org/wiki/xacro">{}<link name="a"/></robot>'
)
_LETTERS = 120_000  # readers of code refuse what is longer than 128 KiB
_MANY_LETTERS = 500_000  # those of other files take up to 1 MiB


def _repeated(part: str, letters: int = _LETTERS) -> str:
    return part * (letters // len(part))


def _robot_text(inside: str) -> Files:
    return {**package(), "urdf/a.xacro": _XACRO.format(inside)}


def _python(text: str) -> Files:
    return {**package(programs="'p = my_robot.p:main'"), "my_robot/p.py": text}


_PARTS = "${q}x" * 8
_LAMBDAS = "lambda:0\n" * 13_500
_CONTAINER = (
    '<launch><node_container pkg="rclcpp_components" exec="component_container" name="a" namespace="">'
    '<composable_node pkg="my_robot" plugin="a::B" name="x" namespace=""/></node_container></launch>'
)
_MACROS = "".join(f"macro(m{i + 1})\n" + f"  m{i}()\n" * 2 + "endmacro()\n" for i in range(300))

LONG_TEXTS: dict[str, Files] = {
    "unknown parts of the path of an include": {
        **_robot_text(f'<xacro:include filename="{_PARTS}.xacro"/>'),
        f"urdf/{'x' * 200}.urdf": "",
    },
    "a long word that a macro's name may be": compiled(
        f"{compiled_node('')}RCLCPP_{_repeated('PTR', 60_000)}{_repeated('DEFINITIONS', 60_000)}\n"
    ),
    "attributes before one declaration": compiled(
        f"{compiled_node('')}{_repeated('[[a]] ')} int x;\n"
    ),
    "release words without a space": {**package(), "README.md": _repeated("_ROSdistro")},
    "a key of many letters": {**package(), "config/c.yaml": f"? {_repeated('a')}\n: 1\n"},
    "openings of includes": _robot_text(f"<!--{_repeated('<xacro:include ', _MANY_LETTERS)}-->"),
    "openings of comments": {**package(), "urdf/a.xacro": _repeated("<!--")},
    "openings of nodes in a launch file": {
        **package(),
        "launch/a.launch.xml": f"<launch>{_repeated('<node ')}",
    },
    "comments that ignore a problem": {
        **package(
            urdf=_XACRO.format(f"<!--{_repeated('grader:ignore REF001 ', _MANY_LETTERS)}-->")
        ),
    },
    "a registration in a comment of CMake": {
        **cmake(
            "install(DIRECTORY launch DESTINATION share/my_robot)\n"
            f"#rclcpp_components_register_node({_repeated('a')}"
        ),
        "launch/a.launch.xml": _CONTAINER,
    },
    "macros of CMake that call two each": cmake(f"macro(m0)\nendmacro()\n{_MACROS}m300()"),
    "equal lambdas": _python(f"{_LAMBDAS}def main(): pass\n"),
}
