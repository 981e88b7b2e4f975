"""What a CMakeLists.txt installs, and what stops its build; `tests/oracles/test_cmake.py` compares both with CMake."""

import pytest

from grader.ros.installation.cmake.cmake_lists import read_cmake
from grader.ros.installation.installation import Installation
from tests.checks.submissions import Submitted
from tests.installation.cmake_grammar import FILES
from tests.work import limited_work

START = "cmake_minimum_required(VERSION 3.8)\nproject(bot)\nfind_package(ament_cmake REQUIRED)\n"
SHARE = "share/bot"


def read(text: str, *, ending: str = "\nament_package()\n") -> Installation:
    """Return what a file with these commands installs."""
    tree = Submitted({**FILES}).submission.whole_tree
    return read_cmake(f"{START}{text}{ending}", "CMakeLists.txt", tree, "bot")


@pytest.mark.parametrize(
    ("text", "installed"),
    [
        ("install(DIRECTORY urdf/parts DESTINATION s${MISSPELT})", {"s/parts/a.xacro"}),
        (
            'INSTALL(DIRECTORY\n "urdf/parts/" # a comment\n DESTINATION [[share/bot]])',
            {f"{SHARE}/a.xacro"},
        ),
        (
            "foreach(it a b)\n install(FILES config/${it}.yaml DESTINATION c)\nendforeach()",
            {"c/a.yaml", "c/b.yaml"},
        ),
        (
            "set(all README.md)\nlist(APPEND all rviz/bot.rviz)\ninstall(FILES ${all} DESTINATION s)",
            {"s/README.md", "s/bot.rviz"},
        ),
        ("file(GLOB found config/[a].yaml)\ninstall(FILES ${found} DESTINATION c)", {"c/a.yaml"}),
        (
            "if(NOT BUILD_TESTING AND EXISTS ${PROJECT_SOURCE_DIR}/urdf)\n install(FILES README.md DESTINATION s)\nendif()",
            {"s/README.md"},
        ),
        (
            'install(DIRECTORY urdf DESTINATION s FILES_MATCHING PATTERN "*.urdf")',
            {"s/urdf/bot.urdf"},
        ),
        ('install(DIRECTORY urdf/ DESTINATION s PATTERN "*.xacro" EXCLUDE)', {"s/bot.urdf"}),
        (
            "function(put it)\n install(FILES ${it} DESTINATION ${ARGN})\nendfunction()\nput(README.md s)",
            {"s/README.md"},
        ),
        ("install(FILES README.md DESTINATION s RENAME LIESMICH.md)", {"s/LIESMICH.md"}),
        (
            "add_executable(node src/node.cpp)\ninstall(TARGETS node DESTINATION lib/${PROJECT_NAME})",
            {"lib/bot/node"},
        ),
        ("add_executable(node src/node.cpp)\ninstall(TARGETS node)", {"bin/node"}),
        (
            "find_package(rclcpp_components)\nadd_library(parts SHARED src/node.cpp)\nrclcpp_components_register_node(parts PLUGIN bot::Node EXECUTABLE part)",
            {"lib/bot/part"},
        ),
        (
            "generate_parameter_library(bot_parameters config/a.yaml)\ninstall(TARGETS bot_parameters EXPORT all)",
            set[str](),
        ),
        ("install(PROGRAMS scripts/run.py DESTINATION lib/bot)", {"lib/bot/run.py"}),
        (
            "find_package(rosidl_default_generators)\nrosidl_generate_interfaces(bot msg/Reading.msg DEPENDENCIES ${known})",
            {f"{SHARE}/msg/Reading.msg"},
        ),
        (
            "find_package(pluginlib)\npluginlib_export_plugin_description_file(nav README.md)",
            {f"{SHARE}/README.md"},
        ),
        # Another package may export it.
        (
            (
                "find_package(hardware_interface REQUIRED)\nadd_library(a src/node.cpp)\n"
                "ament_target_dependencies(a rclcpp_lifecycle)"
            ),
            set[str](),
        ),
        (
            "find_package(rclcpp)\nadd_library(a src/node.cpp)\nament_target_dependencies(a rcutils)",
            set[str](),
        ),
    ],
)
def test_what_is_installed(text: str, installed: set[str]) -> None:
    """Paths below the prefix, besides that of package.xml."""
    found = read(text)
    assert not (found.stops or found.unknown)
    assert {*found.installed(), *found.programs} == {*installed, f"{SHARE}/package.xml"}


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "install(DIRECTORY lunch DESTINATION s)",
            "install() lists 'lunch', but there is no such folder",
        ),
        (
            "install(DIRECTORY README.md DESTINATION s)",
            "install() lists 'README.md', but it is a file: write install(FILES ...)",
        ),
        (
            "install(FILES urdf DESTINATION s)",
            "install() lists 'urdf', but it is a folder: write install(DIRECTORY ...)",
        ),
        ("install(FILES README.md)", "install() has no DESTINATION"),
        (
            "install(TARGETS node DESTINATION s)",
            "install() names the target 'node', which is not defined",
        ),
        (
            "add_executable(node src/nodes.cpp)",
            "add_executable() lists 'src/nodes.cpp', but there is no such file",
        ),
        (
            "target_link_libraries(node rclcpp)",
            "target_link_libraries() names the target 'node', which is not defined",
        ),
        (
            "add_library(a src/node.cpp)\nament_target_dependencies(a rclcpp)",
            "ament_target_dependencies() names the package 'rclcpp', without find_package(rclcpp)",
        ),
        (
            (
                "find_package(rclcpp)\nadd_library(a src/node.cpp)\n"
                "ament_target_dependencies(a std_msgs)"
            ),
            (
                "ament_target_dependencies() names the package 'std_msgs', without "
                "find_package(std_msgs)"
            ),
        ),
        (
            (
                "find_package(hardware_interface)\nadd_library(a src/node.cpp)\n"
                "ament_target_dependencies(a hardware_interfce)"
            ),
            (
                "ament_target_dependencies() names the package 'hardware_interfce', without "
                "find_package(hardware_interfce)"
            ),
        ),
        (
            (
                "find_package(rclcpp)\nfind_package(bot_interfaces)\nadd_library(a src/node.cpp)\n"
                "ament_target_dependencies(a bot_interfaces geometry_msgs rclcpp_action)"
            ),
            (
                "ament_target_dependencies() names the package 'rclcpp_action', without "
                "find_package(rclcpp_action)"
            ),
        ),
        (
            (
                "find_package(rclcpp)\nadd_library(a src/node.cpp)\n"
                "target_link_libraries(a rclcpp::rclcpp fmt::fmt rclcpp_action::rclcpp_action)"
            ),
            (
                "target_link_libraries() names the package 'rclcpp_action', without "
                "find_package(rclcpp_action)"
            ),
        ),
        ("find_package(rclcp REQUIRED)", "there is no package 'rclcp'"),
        (
            "rosidl_generate_interfaces(bot msg/Reading.msg)",
            (
                "CMake knows no command rosidl_generate_interfaces(), because nothing finds the package "
                "rosidl_default_generators"
            ),
        ),
        (
            "ament_python_install_package(urdf)",
            "ament_python_install_package() needs the folder 'urdf', which has no __init__.py",
        ),
        (
            'message(FATAL_ERROR "no ${PROJECT_NAME}")',
            "CMakeLists.txt stops with the message 'no bot'",
        ),
        ("project(bots)", "project() names the package 'bots', package.xml names it 'bot'"),
    ],
)
def test_what_stops_a_build(text: str, message: str) -> None:
    """CMake stops at it, and it is named."""
    assert [stop.message for stop in read(text).stops] == [message]


@pytest.mark.parametrize(
    ("found", "is_known"),
    [
        ("", False),
        ("find_package(ament_cmke)", False),
        ("find_package(Eigen3 REQUIRED)", False),
        ("find_package(ament_cmake_auto REQUIRED)", True),
        ("find_package(rclcpp REQUIRED)", True),  # finds ament_cmake_core
        ("find_package(${build_tool})", True),
    ],
)
def test_a_command_that_nothing_defines(found: str, is_known: bool) -> None:
    """ament_package() is of ament_cmake; what it would install is known all the same."""
    text = f"project(bot)\n{found}\ninstall(FILES README.md DESTINATION s)\nament_package()\n"
    tree = Submitted({**FILES}).submission.whole_tree
    build = read_cmake(text, "CMakeLists.txt", tree, "bot")
    message = (
        "CMake knows no command ament_package(), because nothing finds the package ament_cmake"
    )
    assert [stop.message for stop in build.stops] == ([] if is_known else [message])
    assert "s/README.md" in build.installed()


def test_a_byte_order_mark() -> None:
    """CMake ignores it."""
    tree = Submitted({**FILES}).submission.whole_tree
    build = read_cmake(f"\ufeff{START}ament_package()\n", "CMakeLists.txt", tree, "bot")
    assert (build.fault, build.stops) == (None, ())


@pytest.mark.parametrize(
    "text",
    [
        "include(cmake/own.cmake)",
        "install(FILES .clang-format DESTINATION s)",
        "some_command(urdf)",
        "if(DEFINED ENV{HOME} AND ${CMAKE_VERSION} VERSION_LESS 9)\n install(FILES README.md DESTINATION s)\nendif()",
        'install(CODE "message(x)")',
        "install(FILES ${rclcpp_FILES} DESTINATION s)\nfind_package(rclcpp)\ninstall(FILES ${rclcpp_FILES} DESTINATION s)",
        "while(A)\n install(FILES README.md DESTINATION s)\nendwhile()",
    ],
)
def test_what_is_not_known(text: str) -> None:
    """Nothing is said to be missing then."""
    found = read(text)
    assert found.unknown
    assert not found.stops


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("install(", "a parenthesis is not closed"),
        ('set(a "b)\n', "a quote is not closed"),
        ("if(A)\n", "if() has no endif()"),
        ("endif()\n", "endif() has no beginning"),
        ("= 1\n", "CMake expects a command such as install(...), not '='"),
    ],
)
def test_what_cmake_cannot_read(text: str, message: str) -> None:
    """A file that CMake cannot parse has a fault with its place."""
    fault = read(text, ending="").fault
    assert fault is not None
    assert (fault.message, fault.location.line) == (message, 4)


@pytest.mark.parametrize(
    ("text", "is_certain"), [("if(A)", True), ("if(A)\n" * 90 + "endif()\n" * 90, False)]
)
def test_programs_of_a_file_that_is_not_read(text: str, is_certain: bool) -> None:
    """They are not known; blocks that only this reader does not follow stop no build."""
    found = read(text)
    assert found.fault is not None
    has_program = found.has_program("node", "bot", found.known_programs())
    assert (found.fault.is_certain, has_program) == (is_certain, None)


@pytest.mark.parametrize(("count", "is_known"), [(40, True), (3000, False)])
def test_functions_that_call_each_other(count: int, is_known: bool) -> None:
    """Of a chain that is too long for this reader it is not known what it installs."""
    functions = [f"function(f{k})\nf{k + 1}()\nendfunction()\n" for k in range(count)]
    last = f"function(f{count})\ninstall(FILES package.xml DESTINATION share/bot)\nendfunction()\n"
    found = read("".join(functions) + last + "f0()\n")
    assert (not found.unknown) == is_known


def test_a_package_without_its_end() -> None:
    """ROS 2 finds a package by what ament_package() installs."""
    assert "ament_package()" in read("", ending="").stops[0].message


@pytest.mark.slow
def test_a_long_text_takes_little_time() -> None:
    """Comments and commands that do not end are read once; nothing grows without a bound."""
    doubled = "set(a x)\n" + "set(a ${a}${a};${a})\n" * 60
    with limited_work(3_000_000):
        for text in (
            "#[[\n" * 30_000,
            "#[[" * 30_000 + '"(' * 9_000,
            "a(" * 30_000,
            "\n" * 90_000,
            "if(A)\n" * 9_000,
            doubled,
        ):
            read(text)


_FIND = "find_package(ament_cmake_gtest REQUIRED)\n"
_NO_FILE = (
    "ament_add_gtest() lists 'src/nod.cpp', but there is no such file; did you mean 'src/node.cpp'?"
)
_NO_COMMAND = "CMake knows no command ament_add_gtest(), because nothing finds the package ament_cmake_gtest; write find_package(ament_cmake_gtest REQUIRED)"


@pytest.mark.parametrize(
    ("before", "tests", "said"),
    [
        ("", f"{_FIND}ament_add_gtest(t src/node.cpp TIMEOUT 60)", []),
        ("", f"{_FIND}ament_add_gtest(t src/nod.cpp)", [_NO_FILE]),
        ("", "ament_add_gtest(t src/node.cpp)", [_NO_COMMAND]),
        ("find_package(unseen REQUIRED)\n", "ament_add_gtest(t src/node.cpp)", []),
        (_FIND, "ament_add_gmock_executable(t src/node.cpp)", []),
        ("", "find_package(ament_cmake_ros REQUIRED)\nament_add_gtest(t src/node.cpp)", []),
        ("", f"{_FIND}set(name nod)\nament_add_gtest(t src/${{name}}.cpp $<x> ${{other}}.cpp)", []),
        ("set(name nod)\n", f"{_FIND}ament_add_gtest(t src/${{name}}.cpp)", [_NO_FILE]),
        ("set(BUILD_TESTING OFF)\n", "ament_add_gtest(t src/nod.cpp)", []),
        ("pkg_check_modules(unseen)\n", "ament_add_gtest(t src/node.cpp)", []),
    ],
)
def test_a_build_has_tests(before: str, tests: str, said: list[str]) -> None:
    """Their sources have to be there, and a package that has their command has to be found."""
    setup = read(f"{before}if(BUILD_TESTING)\n{tests}\nendif()")
    assert [stop.message + stop.hint for stop in setup.stops] == said


def test_a_test_outside_of_a_condition() -> None:
    """Its sources have to be there, and the package that has its command."""
    test = "ament_add_gtest(t src/nod.cpp SKIP_TEST)\nadd_custom_target(words src/nod.cpp)"
    setup = read(f"{_FIND}{test}")
    assert [stop.message + stop.hint for stop in setup.stops] == [_NO_FILE]
    setup = read("ament_add_gtest(t src/node.cpp)")
    assert [stop.message + stop.hint for stop in setup.stops] == [_NO_COMMAND]


@pytest.mark.parametrize("export", ["", "EXPORT parts "])
def test_a_generator_expression_of_an_exported_target(export: str) -> None:
    """CMake 3.25 (run) stops, because the exported folder is in the sources; else it takes it for text."""
    folder = "$<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include"
    setup = read(
        "add_library(parts src/node.cpp)\n"
        f"target_include_directories(parts PUBLIC {folder} $<INSTALL_INTERFACE:include>)\n"
        f"install(TARGETS parts {export}DESTINATION lib)"
    )
    message = f"target_include_directories() has a generator expression that is not closed: {folder} lacks >"
    if export:
        assert [stop.message for stop in setup.stops] == [
            f"{message}, so CMake cannot export 'parts'"
        ]
    else:
        assert setup.stops == ()
    assert [unclosed.message for unclosed in setup.unclosed] == ([] if export else [message])
