"""Stand-ins for folders that depend on the machine, and the names of launch files."""

import posixpath
import re
from pathlib import PurePosixPath
from typing import Literal

from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.source import Location, Source

# Paths below these are compared as strings.
PREFIX = "/<prefix>"  # the folder that a build installs to
ROS = "/opt/ros/"  # the folder that ROS 2 is installed to
WORKING_FOLDER = "/<current folder>"
HOME = "/<home>"
SHARE = f"{PREFIX}/share"
BY_UTF8 = ("cat", "open")  # what reads a file as text in UTF-8, and stops at any other
BY_MOVEIT = "moveit"  # reads its configuration
ENDINGS = (
    ".launch.py",
    ".launch.xml",
    ".launch.yaml",
    ".launch.yml",
    "_launch.py",
    "_launch.xml",
    "_launch.yaml",
)


_TEMPLATES = (".template", ".in", ".j2", ".jinja", ".jinja2", ".tmpl", ".tpl", ".em")


def is_template(path: str) -> bool:
    """Return whether a program fills a file in: its ending or one of its folders says so."""
    folders = path.split("/")[:-1]
    return path.endswith(_TEMPLATES) or "templates" in folders or "template" in folders


def is_launch_file(path: str) -> bool:
    """Return whether a file is a launch file.

    It is by its name, or because it is in a folder named launch.
    """
    if is_template(path):
        return False
    if path.endswith(ENDINGS):
        return True
    folder, _, name = path.rpartition("/")
    if last_part(folder) != "launch" or name == "__init__.py":
        return False
    suffix = PurePosixPath(name).suffix
    return suffix in ("", ".launch", ".py", ".xml", ".yaml", ".yml") or (
        suffix == ".txt" and ".launch." in name
    )


LaunchKind = Literal["launch", "ROS 1", "other"]
_IS_YAML_LAUNCH = on_use(r"^[\"']?launch[\"']?\s*:", re.MULTILINE)
# What launch files of ROS 1 have, and those of ROS 2 never.
_ROS1 = on_use(r"<node\b(?![^<>]*\bexec=)[^<>]*\btype=|<rosparam\b")
# What those of ROS 1 have, and some of ROS 2 by mistake, and what those of ROS 2 alone have.
_SUBSTITUTION_OF_ROS1 = on_use(r"\$\((?:find|arg|optenv) ")
_ROS2 = on_use(r"<(?:node|executable)\b[^<>]*\b(?:exec|cmd)=|\$\((?:find-pkg-share|var) ")


def launch_kind(path: str, text: str) -> LaunchKind:
    """Return whether a file that may be a launch file is one, by its text.

    Of what a folder named launch holds, some files are read by others.
    """
    is_named = path.endswith(ENDINGS)
    if path.endswith(".py"):
        is_launch = is_named or "launch_description" in text or "LaunchDescription" in text
    elif path.endswith((".yaml", ".yml")):
        is_launch = is_named or _IS_YAML_LAUNCH.search(text) is not None
    else:
        if "<launch" in text and _is_of_ros1(text):
            return "ROS 1"
        is_launch = is_named or "<launch" in text
    return "launch" if is_launch else "other"


def _is_of_ros1(text: str) -> bool:
    if _ROS1.search(text):
        return True
    return _SUBSTITUTION_OF_ROS1.search(text) is not None and not _ROS2.search(text)


def is_launch_named(path: str, name: str) -> bool:
    """Return whether a launch file has this name, in any of the three languages.

    These are the languages that ros2 launch reads.
    """
    file_name = last_part(path)
    return file_name == name or (
        launch_stem(file_name) == launch_stem(name) and file_name.endswith(ENDINGS[:4])
    )


def launch_stem(name: str) -> str:
    """Return the name of a launch file without its endings."""
    base = last_part(name)
    if ".launch" in base:
        return base.split(".launch")[0]
    return base.rpartition("_launch.")[0] or base


def one_machine_only(path: str) -> str:
    """Return the message about a path that is hard-coded for one machine."""
    return f"the path {path.replace(HOME, '~')} exists on one machine only"


def where_written(source: Source, path: str) -> Location | None:
    """Return where a file has a path in quotes, or its beginning; None if it does not."""
    while path.count("/") > 1:
        for quote in "\"'":
            start = source.text.find(f"{quote}{path}")
            if start >= 0:
                return source.at(start + 1)
        path = path.rpartition("/")[0]
    return None


def is_of_one_machine(path: str) -> bool:
    """Return whether a path leads into a user's home folder, or to a disk of one machine."""
    return path.startswith(HOME) or bool(
        re.match(r".:[\\/]|/(home|Users|root|mnt|media)/.", path, re.DOTALL)
    )


def share_parts(path: str) -> tuple[str, str]:
    """Return the package in whose share folder a path is, and the path in it.

    The texts are empty for another path.
    """
    inside = posixpath.normpath(path)
    owner, _, rest = inside.removeprefix(f"{SHARE}/").partition("/")
    if inside.startswith(f"{SHARE}/"):
        return (owner, rest)
    return ("", "")
