"""The launch file that checks look at, and what keeps it from being read or started."""

from typing import TYPE_CHECKING

from grader.errors import MissingElement, NotDecided
from grader.package.package import Package

if TYPE_CHECKING:
    from grader.package.launch.model import Launch


def path_of(package: Package, name: str) -> str:
    """Return the path of a launch file. Raises MissingElement."""
    path = package.launch_file(name)
    if path is None:
        raise package.missing("launch")
    return path


def launch_of(package: Package, name: str) -> "Launch":
    """Return a launch file, evaluated. Raises MissingElement, and NotDecided for one that is not read."""
    path = path_of(package, name)
    launch = package.launch(path)
    if launch.unread:
        raise NotDecided(launch.unread, "the launch file cannot be read")
    if launch.syntax is not None:
        raise MissingElement("launch file", path, message=launch.syntax.message, location=launch.syntax.location)
    return launch


def fault_that_stops(package: Package, name: str, launch: "Launch") -> MissingElement:
    """Return the fault of a launch file that starts nothing because of it."""
    path, first = path_of(package, name), launch.faults[0]
    return MissingElement("launch file", path, message=_faults(launch), location=first.location, problem=first.message)


def _faults(launch: "Launch") -> str:
    messages = list(dict.fromkeys(fault.message for fault in launch.faults))
    return f"{messages[0]} (and {len(messages) - 1} more)" if len(messages) > 1 else messages[0]
