"""The model of a launch file: the nodes that it starts, and the files that it names."""

from dataclasses import dataclass
from typing import Literal

from grader.source import Location, Source

Purpose = Literal["urdf", "rviz", "include"]


@dataclass(frozen=True, slots=True)
class StartedNode:
    """A program that is started. `when` is True, False where a condition prevents it, None where this is known at run time."""

    package: str
    executable: str
    when: bool | None
    location: Location


@dataclass(frozen=True, slots=True)
class Reference:
    """A file that the launch file names. `path` begins with a stand-in where a folder depends on the machine.

    Where it is None, `reason` says why it is unknown (`sure` is False) or what is wrong with it.
    """

    purpose: Purpose
    path: str | None
    location: Location
    reason: str = ""
    sure: bool = True
    by: str = ""  # the program that reads it, if there is one: xacro, cat or open


@dataclass(frozen=True, slots=True)
class LaunchFault:
    """An error that stops the launch or a node, or something unknown, with its location."""

    message: str
    location: Location


@dataclass(frozen=True, slots=True)
class Launch:
    """The result of a launch file and of those that it includes.

    `syntax` is set where the file itself cannot be read; `unknown` has what cannot be determined.
    """

    path: str
    source: Source
    syntax: LaunchFault | None = None
    nodes: tuple[StartedNode, ...] = ()
    references: tuple[Reference, ...] = ()
    faults: tuple[LaunchFault, ...] = ()
    unknown: tuple[LaunchFault, ...] = ()
    forgotten: tuple[StartedNode, ...] = ()  # created in the file, but not part of its LaunchDescription
    unread: str = ""  # why the file was not read at all: too large, damaged

    def named(self, *purposes: Purpose) -> tuple[Reference, ...]:
        """Return the files that are named for one of these purposes."""
        return tuple(reference for reference in self.references if reference.purpose in purposes)
