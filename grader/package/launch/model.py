"""What a launch file comes to: the nodes that it starts, and the files that it names."""

from dataclasses import dataclass
from typing import Literal

from grader.source import Location, Source

Purpose = Literal["urdf", "rviz", "include"]


@dataclass(frozen=True, slots=True)
class StartedNode:
    """A program that is started: `when` is True, False where a condition keeps it off, None where only a run would tell."""

    package: str
    executable: str
    when: bool | None
    location: Location


@dataclass(frozen=True, slots=True)
class Reference:
    """A file that the launch file names. `path` is as written, with a stand-in in front where only a machine knows the rest.

    Where it is None, `reason` says why it cannot be told (`sure` is False) or what is wrong with it.
    """

    purpose: Purpose
    path: str | None
    location: Location
    reason: str = ""
    sure: bool = True
    by: str = ""  # the program that reads it, where one does: xacro, cat or open


@dataclass(frozen=True, slots=True)
class Fault:
    """Something that stops the launch, or keeps a node from what it needs."""

    message: str
    location: Location


@dataclass(frozen=True, slots=True)
class Launch:
    """What is known of a launch file, those that it includes taken in.

    `syntax` is set where the file itself cannot be read; `unknown` says what could not be told, each with its place.
    """

    path: str
    source: Source
    syntax: Fault | None = None
    nodes: tuple[StartedNode, ...] = ()
    references: tuple[Reference, ...] = ()
    faults: tuple[Fault, ...] = ()
    unknown: tuple[Fault, ...] = ()
    forgotten: tuple[StartedNode, ...] = ()  # made in the file, but not part of what it launches
    unread: str = ""  # why the file could not be read at all: too large, damaged

    def named(self, *purposes: Purpose) -> tuple[Reference, ...]:
        """The files that are named for a purpose."""
        return tuple(each for each in self.references if each.purpose in purposes)
