"""Write the interfaces of well-known packages: `python -m tests.interfaces.make_known CHECKOUT...`.

The arguments are clones of the repositories in PACKAGES with the branches of their releases, which are read with git and
not checked out. The tables stand at the end of `grader/ros/known/packages/PACKAGE.toml`. What stands before them is kept.

With the package `rosbags` of PyPI installed, the messages of Kilted are those that it has.
"""

import importlib.util
import io
import posixpath
import subprocess
import sys
import tarfile
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, cast, get_args

from grader.ros.interfaces.interface_file import INTERFACE_ENDINGS, read_interface
from grader.ros.interfaces.interface_types import (
    FieldType,
    Interface,
    InterfaceKind,
    InterfaceSection,
)
from grader.ros.interfaces.known_interfaces import MORE_CONSTANTS
from grader.ros.known.releases import RELEASES, Release
from tests.known.tables import write_tables

# The repositories, with the packages that are taken from each.
PACKAGES = {
    "common_interfaces": (
        *(
            "actionlib_msgs",
            "diagnostic_msgs",
            "geometry_msgs",
            "nav_msgs",
            "sensor_msgs",
            "shape_msgs",
        ),
        *("std_msgs", "std_srvs", "stereo_msgs", "trajectory_msgs", "visualization_msgs"),
    ),
    "rcl_interfaces": (
        *(
            "action_msgs",
            "builtin_interfaces",
            "composition_interfaces",
            "lifecycle_msgs",
            "rcl_interfaces",
        ),
        *("rosgraph_msgs", "service_msgs", "statistics_msgs", "type_description_interfaces"),
    ),
    "example_interfaces": ("example_interfaces",),
    "control_msgs": ("control_msgs",),
    "ros_tutorials": ("turtlesim",),
    "geometry2": ("tf2_msgs",),
    "unique_identifier_msgs": ("unique_identifier_msgs",),
}
# What a changelog says of releases whose branches no stored copy has; all else is as in the release before.
CHANGES = Path(__file__).with_name("changelogs.toml")
# Branches of other names than their releases.
BRANCHES: Mapping[Release, tuple[str, ...]] = {
    "foxy": ("foxy", "foxy-devel"),
    "galactic": ("galactic", "galactic-devel"),
    "rolling": ("rolling", "master"),
}
Types = dict[str, Interface]  # by msg/Twist
Changes = dict[Release, dict[str, dict[str, str]]]  # the texts by release, package and msg/Twist


def main(checkouts: Iterable[str]) -> None:
    """Write the tables of the packages of these checkouts."""
    changes = cast("Changes", tomllib.loads(CHANGES.read_text("utf-8")))
    for checkout in checkouts:
        repository = name_of(checkout)
        read = [release for release in RELEASES if release not in changes]
        by_release = {release: types_of(checkout, repository, release) for release in read}
        for package in PACKAGES[repository]:
            found = {release: types.get(package, {}) for release, types in by_release.items()}
            kilted = rosbags_types(package)
            if kilted:
                services = {name: it for name, it in found["kilted"].items() if it.kind != "msg"}
                found["kilted"] = {**kilted, **services}
            for release, packages in changes.items():
                before = found[RELEASES[[*RELEASES].index(release) - 1]]
                found[release] = changed(before, package, packages.get(package, {}))
            in_order = {release: found[release] for release in RELEASES}
            write_tables(package, table_of(in_order, repository))


def changed(types: Types, package: str, changes: Mapping[str, str]) -> Types:
    """Return the interfaces of a package with those of a changelog, by msg/Twist; an empty text
    for one that is gone.
    """
    now = {**types}
    for name, text in changes.items():
        if text == MORE_CONSTANTS:
            section, *rest = now[name].sections
            more = section._replace(constants=section.constants | {text})
            now[name] = now[name]._replace(sections=(more, *rest))
        elif text:
            now[name] = read_interface(text.encode(), f"{package}/{name}.msg", package)
        else:
            now.pop(name, None)
    return now


def name_of(checkout: str) -> str:
    """Return the name of the repository of a checkout."""
    path = Path(checkout).resolve()
    for name in PACKAGES:
        if any(part == name or part.endswith(f"+{name}") for part in path.parts):
            return name
    raise SystemExit(f"{checkout} is no checkout of {', '.join(PACKAGES)}")


def git(checkout: str, *arguments: str) -> bytes:
    """Return what git prints."""
    return subprocess.run(
        ["git", "-C", checkout, *arguments], check=True, capture_output=True
    ).stdout


def types_of(checkout: str, repository: str, release: Release) -> dict[str, Types]:
    """Return the interfaces of a release by their packages; those of the next release that has a branch."""
    branches = {line.strip("* ") for line in git(checkout, "branch").decode().split("\n")}
    for later in RELEASES[RELEASES.index(release) :]:
        for branch in BRANCHES.get(later, (later,)):
            if branch in branches:
                return interfaces_in(git(checkout, "archive", branch), repository)
    raise SystemExit(f"{checkout} has no branch of {release}")


def interfaces_in(archive: bytes, repository: str) -> dict[str, Types]:
    """Return the interfaces in an archive by their packages."""
    found: dict[str, Types] = {}
    with tarfile.open(fileobj=io.BytesIO(archive)) as tar:
        for member in tar.getmembers():
            folder, name = posixpath.split(member.name)
            above, kind = posixpath.split(folder)
            package = posixpath.basename(above) or repository
            file = tar.extractfile(member)
            if (
                not name.endswith(INTERFACE_ENDINGS)
                or package not in PACKAGES[repository]
                or file is None
            ):
                continue
            interface = read_interface(file.read(), member.name, package)
            assert not interface.faults, interface.faults
            found.setdefault(package, {})[f"{kind}/{posixpath.splitext(name)[0]}"] = interface
    return found


def rosbags_types(package: str) -> Types:
    """Return the messages of a package in Kilted that rosbags has; none if it is not installed."""
    if importlib.util.find_spec("rosbags") is None:
        return {}
    typesys: Any = importlib.import_module("rosbags.typesys")
    found: Types = {}
    for full, (constants, fields) in typesys.get_typestore(
        typesys.Stores.ROS2_KILTED
    ).fielddefs.items():
        owner, _, name = full.split("/")
        if owner == package:
            text = "".join(f"{_written(package, kind)} {field}\n" for field, kind in fields)
            text += "".join(f"int8 {constant[0]}=0\n" for constant in constants)
            interface = read_interface(text.encode(), f"{package}/msg/{name}.msg", package)
            assert not interface.faults, interface.faults
            found[f"msg/{name}"] = interface
    return found


def _written(package: str, description: tuple[Any, Any]) -> str:
    """Return the type of a field as a .msg file has it, of what rosbags has."""
    kind, content = int(description[0]), description[1]
    if kind == 1:
        name = {"octet": "byte"}.get(content[0], content[0])
        return f"{name}<={content[1]}" if content[1] else str(name)
    if kind == 2:
        owner, _, name = content.split("/")
        return f"{owner}/{name}"
    size = content[1] or ""
    return f"{_written(package, content[0])}[{'<=' if kind == 4 and size else ''}{size}]"


def table_of(by_release: Mapping[Release, Types], repository: str) -> str:
    """Return the table of a package: each type in one text, or, where it changed, in one for each
    release from which on it is so.
    """
    lines = [
        f"# Of {repository}, branches of {RELEASES[0]} to {RELEASES[-1]}, by python -m tests.interfaces.make_known.",
        "# Fields, then | and constants; --- between sections. Of a type that changed, the first release of each form.",
    ]
    names = sorted({name for types in by_release.values() for name in types})
    for kind in get_args(InterfaceKind):
        of_kind = [name for name in names if name.startswith(f"{kind}/")]
        if of_kind:
            lines += ["", f"[{kind}]"]
        lines += [f"{name.partition('/')[2]} = {_value_of(by_release, name)}" for name in of_kind]
    return "\n".join(lines) + "\n"


def _value_of(by_release: Mapping[Release, Types], name: str) -> str:
    changes: dict[Release, str] = {}
    last = ""
    for release, types in by_release.items():
        text = _text_of(types[name]) if name in types else "absent"
        if text != last:
            changes[release] = last = text
    if len(changes) == 1:
        return f'"{last}"'
    return "{ " + ", ".join(f'{release} = "{text}"' for release, text in changes.items()) + " }"


def _text_of(interface: Interface) -> str:
    return " --- ".join(map(_text_of_section, interface.sections)).strip()


def _text_of_section(section: InterfaceSection) -> str:
    fields = "; ".join(
        f"{text_of_type(field.type)} {field.name}" for field in section.fields.values()
    )
    constants = " ".join(sorted(section.constants))
    return f"{fields} | {constants}".strip() if constants else fields


def text_of_type(kind: FieldType) -> str:
    """Return a type as a .msg file has it."""
    name = f"{kind.package}/{kind.name}" if kind.package else kind.name
    if kind.text_bound is not None:
        name = f"{name}<={kind.text_bound}"
    if not kind.is_list:
        return name
    return f"{name}[{'<=' if kind.is_bounded else ''}{kind.size or ''}]"


if __name__ == "__main__":
    main(sys.argv[1:])
