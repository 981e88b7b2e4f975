"""What programs of packages that are not submitted open: rows of files in `ends`.

They are for drawing a graph. Rules read only the types of subscriptions here; what else they
compare is in `packages`. The file of one package is read when it is needed.
"""

import os
from collections.abc import Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, Literal

import tomli

from grader.base.grouping import Strings, StringsByName
from grader.base.records import Named
from grader.ros.known.releases import RELEASES, Release, is_between
from grader.ros.known.typed_rows import read_row

FOLDER = Path(__file__).with_name("ends")
_ENDING = ".toml"
_EndKind = Literal[
    "publisher", "subscription", "service", "client", "action server", "action client"
]


class VaryingEnd(Named):
    """An end that parameters or releases decide.

    `parameter` is what names it, in place of `name`; with a star it stands for any number of
    parameters, each of which names one end. `type_parameter` is the one beside it that has the
    type, or its end: interface_type beside drive.topic_name is drive.interface_type. With
    `is_below`, the name is below that of its table: arm/follow beside arm.action_ns.
    """

    kind: _EndKind
    type: str = ""
    name: str = ""
    parameter: str = ""
    type_parameter: str = ""
    is_below: bool = False
    only: Mapping[str, Any] = {}  # it is opened only if these parameters are given these values
    unless: Mapping[str, Any] = {}  # it is not opened if one of these is given this value
    since: Release = RELEASES[0]
    until: Release = RELEASES[-1]

    def is_in(self, release: Release) -> bool:
        """Return whether a release has it."""
        return is_between(release, self.since, self.until)


OnlyMore = Literal["", "subscriptions", "publishers"]


class OpenedEnds(Named):
    """What a program, a component or a controller opens: names with types.

    A type is written `geometry_msgs.msg.Twist`. `/tf`, `/rosout` and the services of parameters are
    not among them.
    """

    source: str = ""
    like: str = ""  # what else of the package opens this; it may read and serve more
    name: str = ""  # of the node where its launch file gives none
    publishers: Mapping[str, str] = {}
    subscriptions: Mapping[str, str] = {}
    services: Mapping[str, str] = {}
    clients: Mapping[str, str] = {}
    action_servers: Mapping[str, str] = {}
    action_clients: Mapping[str, str] = {}
    varying: tuple[VaryingEnd, ...] = ()
    opens_more: str = ""  # why it may open more
    opens_only: OnlyMore = ""  # what all of this is; empty where it may be anything
    holds: Strings = ()  # nodes in its process, each with a row; called NAME/NAME
    is_manual: bool = False  # whether a person starts it in a terminal of its own
    is_process: bool = False  # whether it is no node, or ends by itself

    @property
    def fixed(self) -> Iterator[tuple[_EndKind, str, str]]:
        """The kind, name and type of each end that nothing decides."""
        tables: dict[_EndKind, StringsByName] = {
            "publisher": self.publishers,
            "subscription": self.subscriptions,
            "service": self.services,
            "client": self.clients,
            "action server": self.action_servers,
            "action client": self.action_clients,
        }
        for kind, table in tables.items():
            for name, message in table.items():
                yield kind, name, message


class IncludedNode(Named):
    """A node that an installed launch file starts under its default arguments."""

    node: str  # package/program
    name: str = ""  # that it is given
    remappings: Mapping[str, str] = {}
    arguments: Mapping[str, str] = {}  # the launch argument with the new name of a remapping
    parameters: Strings = ()  # launch arguments that name its parameter files
    since: Release = RELEASES[0]
    until: Release = RELEASES[-1]

    def is_in(self, release: Release) -> bool:
        """Return whether a release starts it."""
        return is_between(release, self.since, self.until)


class _EndsOfPackage(Named):
    """The file of a package."""

    source: str = ""  # of programs that name none
    program: Mapping[str, OpenedEnds] = {}  # also classes of components and controllers
    launch: Mapping[str, tuple[IncludedNode, ...]] = {}  # the nodes that a launch file starts
    launch_parameters: Strings = ()  # launch arguments that name the files of all of them


@cache
def packages_with_ends() -> Strings:
    """Return the packages with a file."""
    names = os.listdir(FOLDER)  # noqa: PTH208  # Path.iterdir takes four times as long
    return tuple(sorted(name.removesuffix(_ENDING) for name in names if name.endswith(_ENDING)))


@cache
def _ends_of_package(package: str) -> _EndsOfPackage:
    text = (FOLDER / f"{package}{_ENDING}").read_text("utf-8")
    return read_row(_EndsOfPackage, tomli.loads(text))


def opened_ends(package: str, program: str) -> OpenedEnds | None:
    """Return what a program, a component or a controller opens; None if that is not known."""
    if package not in packages_with_ends():
        return None
    rows = _ends_of_package(package).program
    row = rows.get(program)
    if not row or not row.like:
        return row
    other = rows[row.like]
    return other._replace(
        name=row.name,
        services={**other.services, **row.services},
        subscriptions={**other.subscriptions, **row.subscriptions},
    )


def program_of_component(package: str, plugin: str) -> str:
    """Return the program that starts the class of a component; the class if none is known."""
    rows = _ends_of_package(package).program if package in packages_with_ends() else {}
    return (rows[plugin].like if plugin in rows else "") or plugin


def nodes_of_launch_file(package: str, file: str, release: Release) -> list[IncludedNode]:
    """Return the nodes that an installed launch file starts; none where that is not known."""
    if package not in packages_with_ends():
        return []
    of_package = _ends_of_package(package)
    nodes = []
    for node in of_package.launch.get(file, ()):
        if node.is_in(release):
            parameters = node.parameters or of_package.launch_parameters
            nodes.append(node._replace(parameters=parameters))
    return nodes


def launch_file_is_known(package: str, file: str) -> bool:
    """Return whether it is known what an installed launch file opens, also if that is nothing."""
    return package in packages_with_ends() and file in _ends_of_package(package).launch


@cache
def manual_programs() -> tuple[tuple[str, OpenedEnds], ...]:
    """Return the programs that a person starts in a terminal, as `package/program`."""
    programs = []
    for package in packages_with_ends():
        for name in _ends_of_package(package).program:
            row = opened_ends(package, name)
            if row and row.is_manual:
                programs.append((f"{package}/{name}", row))
    return tuple(programs)
