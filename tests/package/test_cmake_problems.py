"""What CMakeLists.txt does not compile or install is a warning, where all of it is known."""

import json
from pathlib import Path

import pytest

from grader.files.tree import make_tree, overlaid
from grader.ros.package.finding import read_packages
from grader.ros.package.found_problems import build_problems
from tests.command_line import run

pytestmark = pytest.mark.slow

_HEAD = "cmake_minimum_required(VERSION 3.8)\nproject(hub)\nfind_package(ament_cmake REQUIRED)\nfind_package(rclcpp_components REQUIRED)\n"
_NODE = "#include <rclcpp/rclcpp.hpp>\nint main() {}\n"
_PART = "#include <rclcpp/rclcpp.hpp>\nRCLCPP_COMPONENTS_REGISTER_NODE(Part)\n"
_BUILT = "add_executable(talk src/talk.cpp)\ninstall(TARGETS talk DESTINATION lib/hub)\n"
_LIBRARY = 'add_library(part SHARED src/part.cpp)\nrclcpp_components_register_node(part PLUGIN "Part" EXECUTABLE p)\n'


def problems(commands: str, **sources: str) -> list[tuple[str, str]]:
    """Return the problems of CMakeLists.txt in a package with these sources."""
    manifest = "<package format='3'><name>hub</name><export><build_type>ament_cmake</build_type></export></package>"
    texts = {
        "package.xml": manifest,
        "CMakeLists.txt": f"{_HEAD}{commands}ament_package()\n",
        **{f"src/{name}.cpp": text for name, text in sources.items()},
    }
    files = {f"ws/hub/{path}": text.encode() for path, text in texts.items()}
    [package] = read_packages(overlaid(make_tree("work", (), ()), files), "urdf/hub.urdf")
    found = [(it.code, it.message) for it in build_problems(package)]
    return [each for each in found if each[0] in ("PKG019", "PKG020", "PKG021", "PKG024")]


def test_a_source_without_target() -> None:
    """A file with a main() or a component that no target lists."""
    assert problems(_BUILT, talk=_NODE) == []
    message = "no target of CMakeLists.txt compiles src/walk.cpp"
    assert problems(_BUILT, talk=_NODE, walk=_NODE) == [("PKG019", message)]
    assert problems(_BUILT, talk=_NODE, walk=_PART) == [("PKG019", message)]


NO_PROGRAMS = [
    "#include <rclcpp/rclcpp.hpp>\nvoid help() {}\n",
    "int main() {}\n",
    "// #include <rclcpp/rclcpp.hpp>\nint main() {}\n",
    "#include <rclcpp/rclcpp.hpp>\n// int main() {}\n",
]


@pytest.mark.parametrize("text", NO_PROGRAMS)
def test_sources_that_are_no_programs(text: str) -> None:
    """A file without a main(), or that has nothing to do with ROS 2, may be included or left."""
    assert problems(_BUILT, talk=_NODE, other=text) == []


def test_a_target_that_is_not_installed() -> None:
    """ros2 run does not find an executable, nor a container a library."""
    missing = "no install() names the target 'talk', so ros2 run does not find it"
    assert problems("add_executable(talk src/talk.cpp)\n", talk=_NODE) == [("PKG020", missing)]
    assert problems("add_executable(talk src/talk.cpp)\n", talk="int main() {}") == []
    missing = "no install() names the target 'part', so nothing can load its components"
    assert problems(_LIBRARY, part=_PART) == [("PKG020", missing)]
    assert problems(f"{_LIBRARY}install(TARGETS part DESTINATION lib)\n", part=_PART) == []
    assert problems("add_library(part SHARED src/part.cpp)\n", part=_PART) == []


UNKNOWN = [
    "if(UNSEEN_FOUND)\nadd_executable(talk src/talk.cpp)\nendif()\n",
    "add_executable(talk ${unseen_FILES} src/talk.cpp)\nfind_package(unseen REQUIRED)\nmine()\n",
    "add_executable(talk src/talk.cpp)\ninstall(TARGETS ${rclcpp_components_TARGETS} DESTINATION lib/hub)\n",
]


@pytest.mark.parametrize("commands", UNKNOWN)
def test_what_is_not_known(commands: str) -> None:
    """Nothing is said where a command or a value is not known."""
    assert problems(commands, talk=_NODE, walk=_NODE) == []


def test_targets_of_tests() -> None:
    """Programs of tests need no installation."""
    assert problems("add_executable(test_talk src/test_talk.cpp)\n", test_talk=_NODE) == []


_FOUND = "find_package(rclcpp REQUIRED)\nfind_package(std_msgs REQUIRED)\nfind_package(tf2_ros REQUIRED)\n"
_INCLUDING = f"#include <std_msgs/msg/bool.hpp>\n{_NODE}"


def test_a_package_that_a_target_does_not_depend_on() -> None:
    """The headers of a package are found by targets that depend on it, also by way of others."""
    head = f"{_FOUND}{_BUILT}ament_target_dependencies(talk"
    message = "src/talk.cpp includes headers of std_msgs, but the target 'talk' does not depend on it: see ament_target_dependencies()"
    assert problems(f"{head} rclcpp)\n", talk=_INCLUDING) == [("PKG021", message)]
    assert problems(f"{head} rclcpp std_msgs)\n", talk=_INCLUDING) == []
    assert (
        problems(f"{head} rclcpp sensor_msgs)\nfind_package(sensor_msgs)\n", talk=_INCLUDING) == []
    )


DEPENDING = [
    "ament_target_dependencies(talk rclcpp)\\ninclude_directories(${std_msgs_INCLUDE_DIRS})\n",
    "target_link_libraries(talk std_msgs::std_msgs)\n",
    "find_package(unseen REQUIRED)\nament_target_dependencies(talk rclcpp unseen)\n",
    "",
]


@pytest.mark.parametrize("commands", DEPENDING)
def test_dependencies_that_are_not_known(commands: str) -> None:
    """What else is linked may bring the headers; without ament_target_dependencies() nothing is said."""
    assert problems(f"{_FOUND}{_BUILT}{commands}", talk=_INCLUDING) == []


_GUESS = "file(GLOB parts /elsewhere/*.cpp)\nadd_library(parts ${parts})\n"


def test_a_target_that_is_not_known_silences_no_other_one() -> None:
    """It may compile any file, so that nothing is said of those that no target names."""
    missing = "no install() names the target 'talk', so ros2 run does not find it"
    commands = f"{_GUESS}add_executable(talk src/talk.cpp)\n"
    assert problems(commands, talk=_NODE, walk=_NODE) == [("PKG020", missing)]


_IMU = "#include <rclcpp/rclcpp.hpp>\n#include <sensor_msgs/msg/imu.hpp>\nint main() {}\n"


@pytest.mark.parametrize(
    ("more", "is_said"),
    [
        ("target_link_libraries(other m)\n", True),
        ("link_libraries(${sensor_msgs_TARGETS})\n", False),
        ("target_link_libraries(talk ${sensor_msgs_TARGETS})\n", False),
        ("include_directories(${sensor_msgs_INCLUDE_DIRS})\n", False),
    ],
)
def test_a_header_of_a_package_that_a_target_does_not_name(more: str, is_said: bool) -> None:
    """Another target's libraries are no way to find it, those of all targets are."""
    commands = (
        "find_package(rclcpp REQUIRED)\nfind_package(sensor_msgs REQUIRED)\n"
        f"add_library(other src/other.cpp)\n{_BUILT}ament_target_dependencies(talk rclcpp)\n{more}"
    )
    reported = problems(commands, talk=_IMU, other="int other;")
    assert [code for code, _ in reported] == (["PKG021"] if is_said else [])


def test_a_library_that_a_program_loads() -> None:
    """It has to be installed, unless it is linked into the program."""
    commands = "target_link_libraries(talk parts)\n"
    sources = {"talk": "int main() {}", "parts": "int part;"}
    shared = f"{_BUILT}add_library(parts SHARED src/parts.cpp)\n{commands}"
    message = "no install() names the target 'parts', so 'talk', which links it, does not find the library when it starts"
    assert problems(shared, **sources) == [("PKG020", message)]
    assert problems(shared.replace("SHARED ", ""), **sources) == []
    assert problems(shared.replace(commands, ""), **sources) == []
    assert problems(f"{shared}install(TARGETS parts DESTINATION lib)\n", **sources) == []


@pytest.mark.parametrize("end", ["", ">"])
def test_a_generator_expression_without_end(end: str) -> None:
    """CMake takes it for text; the `>` may be in a later argument."""
    target = "add_library(parts src/parts.cpp)\n"
    option = f"{target}target_compile_options(parts PRIVATE $<$<CONFIG:Debug>:-g -O0{end})\n"
    [*reported] = problems(option, parts="int part;")
    assert [code for code, _ in reported] == ([] if end else ["PKG024"])
    assert (
        problems(f"{target}if(UNSEEN)\ntarget_compile_options(parts PRIVATE $<a)\nendif()\n") == []
    )


def test_an_interface_package_that_a_target_does_not_depend_on(tmp_path: Path) -> None:
    """No package of ROS 2 exports the headers of one of the workspace."""
    texts = {
        "hub_msgs/package.xml": "<package format='3'><name>hub_msgs</name></package>",
        "hub_msgs/msg/Talk.msg": "string words\n",
        "hub/package.xml": "<package format='3'><name>hub</name></package>",
        "hub/src/talk.cpp": f"#include <hub_msgs/msg/talk.hpp>\n{_NODE}",
    }
    build = (
        "cmake_minimum_required(VERSION 3.8)\nproject(hub)\nfind_package(ament_cmake REQUIRED)\n"
        "find_package(hub_msgs REQUIRED)\nfind_package(rclcpp_action REQUIRED)\n{}"
        "add_executable(talk src/talk.cpp)\nament_target_dependencies(talk rclcpp_action{})\n"
        "install(TARGETS talk DESTINATION lib/hub)\nament_package()\n"
    )
    messages = []
    for more, named in (
        ("", ""),
        ("", " hub_msgs"),
        ("include_directories(${hub_msgs_INCLUDE_DIRS})\n", ""),
    ):
        for path, text in {**texts, "hub/CMakeLists.txt": build.format(more, named)}.items():
            (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / path).write_text(text)
        found = json.loads(run(["inspect", tmp_path, "--format", "json"]).stdout)["problems"]
        messages.append([each["message"] for each in found if each["code"] == "PKG021"])
    message = "src/talk.cpp includes headers of hub_msgs, but the target 'talk' does not depend on it: see ament_target_dependencies()"
    assert messages == [[message], [], []]
