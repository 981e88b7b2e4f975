"""Random CMakeLists.txt files as packages have them, with mistakes, for a package with the files below."""

from collections.abc import Mapping
from random import Random

MANIFEST = """<?xml version="1.0"?>
<package format="3"><name>bot</name><version>0.0.0</version><description>A robot.</description>
<maintainer email="a@example.org">A</maintainer><license>MIT</license>
<export><build_type>ament_cmake</build_type></export></package>
"""
FILES: Mapping[str, str] = {
    "package.xml": MANIFEST,
    **dict.fromkeys(
        (
            "launch/view.launch.py",
            "launch/parts/arm.launch.py",
            "urdf/bot.urdf",
            "urdf/bot.urdf.xacro",
            "urdf/parts/a.xacro",
            "rviz/bot.rviz",
            "meshes/base.stl",
            "meshes/visual/arm.dae",
            "config/a.yaml",
            "config/b.yaml",
            "scripts/run.py",
            "src/node.cpp",
            "src/other.cpp",
            "msg/Reading.msg",
            "srv/Reset.srv",
            "bot/__init__.py",
            "bot/tool.py",
            "README.md",
        ),
        "",
    ),
}
FOLDERS = (
    "launch",
    "urdf",
    "rviz",
    "meshes",
    "config",
    "urdf/parts",
    "launch/",
    "urdf/",
    "./config",
    "meshes/visual",
    "${PROJECT_SOURCE_DIR}/urdf",
    "${CMAKE_CURRENT_SOURCE_DIR}/launch/",
)
WRONG = ("missing", "config/a.yaml", "lunch")
SINGLE = (
    "urdf/bot.urdf",
    "config/a.yaml",
    "scripts/run.py",
    "README.md",
    "launch/view.launch.py",
    '"rviz/bot.rviz"',
    "${FILES}",
    "${PROJECT_NAME}/tool.py",
)
WRONG_FILES = ("missing.txt", "rviz", "urdf/bot.urfd")
TARGETS = (
    "share/${PROJECT_NAME}",
    "share/${PROJECT_NAME}/",
    "share/${PROJECT_NAME}/config",
    "lib/${PROJECT_NAME}",
    "share/bot",
    "${SHARE}",
    "${CMAKE_INSTALL_PREFIX}/share/${PROJECT_NAME}",
    "share/${PROJET_NAME}",
)
CONDITIONS = (
    "BUILD_TESTING",
    "NOT BUILD_TESTING",
    "TRUE",
    "0",
    "SOME_FLAG",
    "NOT SOME_FLAG",
    "EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/urdf",
    '"${PROJECT_NAME}" STREQUAL "bot"',
    "PROJECT_NAME STREQUAL other OR TRUE",
    "(A AND B) OR NOT (C)",
    "WIN32",
    "CMAKE_COMPILER_IS_GNUCXX OR CMAKE_CXX_COMPILER_ID MATCHES Clang",
    "DEFINED SHARE",
    "2 GREATER 1",
)
PATTERNS = (
    'PATTERN "*.xacro" EXCLUDE',
    'FILES_MATCHING PATTERN "*.py"',
    'FILES_MATCHING PATTERN "*.urdf" PATTERN "*.xacro"',
    'PATTERN "parts" EXCLUDE',
    'PATTERN "parts/*" EXCLUDE',
    "USE_SOURCE_PERMISSIONS",
    "OPTIONAL",
    'PATTERN "a.*" EXCLUDE',
    'PATTERN "bot.urdf" PERMISSIONS OWNER_READ',
)


def _install(random: Random) -> str:
    kind = random.choice(("DIRECTORY", "DIRECTORY", "FILES", "PROGRAMS", "TARGETS"))
    target = random.choice(TARGETS)
    if kind == "DIRECTORY":
        folders = " ".join(
            _with_mistake(random, random.sample(FOLDERS, random.randint(1, 3)), WRONG)
        )
        return f"install(DIRECTORY {folders} DESTINATION {target}{_one(random, PATTERNS)})"
    if kind == "TARGETS":
        where = random.choice(
            (
                "DESTINATION lib/${PROJECT_NAME}",
                "RUNTIME DESTINATION lib/${PROJECT_NAME} LIBRARY DESTINATION lib",
                "EXPORT all",
                "",
            )
        )
        return f"install(TARGETS {random.choice(('node', 'node', 'node', 'other'))} {where})"
    files = " ".join(
        _with_mistake(random, random.sample(SINGLE, random.randint(1, 2)), WRONG_FILES)
    )
    return f"install({kind}\n  {files}  # files\n  DESTINATION {target}{_one(random, ('OPTIONAL',) if ' ' in files else ('RENAME x.txt', 'OPTIONAL'))})"


def _with_mistake(random: Random, names: list[str], wrong: tuple[str, ...]) -> list[str]:
    """Return names, rarely with a wrong one."""
    return [*names, random.choice(wrong)] if random.random() < 0.08 else names


def _one(random: Random, choices: tuple[str, ...]) -> str:
    return f" {random.choice(choices)}" if random.random() < 0.4 else ""


def _statement(random: Random, depth: int = 0) -> str:
    """Return a statement; blocks have others in them."""
    inner = (
        "\n  ".join(_statement(random, depth + 1) for _ in range(random.randint(1, 2)))
        if depth < 2
        else ""
    )
    other = _statement(random, depth + 1) if depth < 2 else ""
    blocks = (
        f"if({random.choice(CONDITIONS)})\n  {inner}\nendif()",
        f"if({random.choice(CONDITIONS)})\n  {inner}\nelseif({random.choice(CONDITIONS)})\n  {other}\nelse()\n  {other}\nendif()",
        (
            f"foreach(folder launch {random.choice(('config', 'rviz/', 'meshes'))})\n"
            f"  install(DIRECTORY ${{folder}} DESTINATION {random.choice(TARGETS)})\nendforeach()"
        ),
        f"foreach(item IN LISTS ITEMS_OF FILES)\n  {inner}\nendforeach()",
        (
            "function(put folder)\n  install(DIRECTORY ${folder} DESTINATION share/${PROJECT_NAME} ${ARGN})\nendfunction()\n"
            f"put({random.choice(('urdf', 'config OPTIONAL', 'rviz'))})"
        ),
        f"macro(set_it)\n  set({random.choice(('FILES', 'SHARE', 'SOME_FLAG'))} ${{ARGV}})\nendmacro()\nset_it(urdf/bot.urdf)",
        "Install(DIRECTORY #[[ a\ncomment ]] urdf DESTINATION share/${PROJECT_NAME})",
    )
    plain = (
        "set(FILES urdf/bot.urdf config/a.yaml)",
        'set(FILES "rviz/bot.rviz;README.md")',
        "list(APPEND FILES config/b.yaml)",
        f"set(SHARE {random.choice(('share/${PROJECT_NAME}', 'share/other', 'share/${PROJECT_NAME}/${SOME_FLAG}'))})",
        "set(SOME_FLAG ON)",
        'option(SOME_FLAG "a flag" OFF)',
        f"file(GLOB FILES {random.choice(('urdf/*', 'config/*.yaml', 'launch/*.py', 'none/*', '${PROJECT_SOURCE_DIR}/config/[ab].yaml'))})",
        "file(GLOB_RECURSE FILES RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} urdf/*.xacro)",
        f"add_executable(other {random.choice(('src/node.cpp', 'src/other.cpp'))})",
        "target_include_directories(node PUBLIC include)",
        f"ament_target_dependencies({'node'} {random.choice(('rclcpp', 'rclcpp', 'std_msgs'))})",
        "find_package(std_msgs REQUIRED)",
        "ament_python_install_package(${PROJECT_NAME})",
        f'rosidl_generate_interfaces(${{PROJECT_NAME}} "msg/{random.choice(("Reading", "Reading", "Readings"))}.msg" "srv/Reset.srv" DEPENDENCIES std_msgs)',
        "unset(FILES)",
        'message(STATUS "share: ${SHARE}")',
    )
    roll = random.random()
    if depth < 2 and roll < 0.3:
        return random.choice(blocks)
    return _install(random) if roll < 0.65 else random.choice(plain)


def cmake_lists(seed: int) -> str:
    """Return a file, which is the same for the same seed."""
    random = Random(seed)
    name = "bot" if random.random() < 0.95 else "bots"
    lines = [
        "cmake_minimum_required(VERSION 3.8)",
        f"project({name})",
        "find_package(ament_cmake REQUIRED)",
        "find_package(rclcpp REQUIRED)",
        "find_package(rosidl_default_generators REQUIRED)",
    ]
    lines += ["add_executable(node src/node.cpp)"] if random.random() < 0.9 else []
    lines += [_statement(random) for _ in range(random.randint(1, 7))]
    lines += ["ament_package()"] if random.random() < 0.95 else []
    return "\n".join(lines) + "\n"
