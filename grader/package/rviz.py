"""RViz configuration files: the fixed frame and the displays that are on, as RViz of ROS 2 reads them."""

from collections.abc import Iterator
from dataclasses import dataclass

from grader.package import catalogue
from grader.package.yaml_nodes import Node, YamlFault, read_yaml
from grader.problems import Problem
from grader.source import Location, Source

_MOST_DISPLAYS = 500
_PLUGINS = "rviz_default_plugins"


@dataclass(frozen=True, slots=True)
class Display:
    """One display; `kind` is its class without the package: RobotModel. `node` holds its settings."""

    package: str
    kind: str
    name: str
    enabled: bool
    node: Node

    def is_on(self, setting: str) -> bool:
        """Whether one of its own settings is on; what is not there is."""
        return switched_on(self.node.get(setting), default=True)

    @property
    def is_enabled(self) -> bool:
        """Whether it is on by itself, whatever group it is in; Enabled counts more than Value."""
        return _is_enabled(self.node)

    @property
    def location(self) -> Location:
        """Where it is said which class the display has."""
        named = self.node.get("Class")
        return named.location if named is not None else self.node.location


@dataclass(frozen=True, slots=True)
class RvizFile:
    """What an RViz file sets up. `fault` is set where it cannot be read: nothing else is known then."""

    path: str
    source: Source
    fault: Problem | None
    fixed_frame: str | None
    frame_location: Location
    displays: tuple[Display, ...]
    unread: str = ""  # why the file could not be read at all: too large, damaged

    @property
    def problems(self) -> tuple[Problem, ...]:
        """What is worth saying of the file, whatever it is graded on."""
        if self.fault is not None:
            return (self.fault,)
        if self.unread:
            return ()
        found = [
            Problem(
                catalogue.ROS1_CLASS,
                f"{display.package}/{display.kind} is a class of ROS 1; in ROS 2 it is {_PLUGINS}/{display.kind}",
                display.location,
            )
            for display in self.displays
            if display.package == "rviz"
        ]
        if not any(display.kind == "TF" and display.enabled for display in self.displays):
            found.append(Problem(catalogue.NO_TF, "no TF display is on in this file", Location(self.path, 1, 1)))
        return tuple(found)


def read_rviz(data: bytes, path: str) -> RvizFile:
    """Read an RViz file; never raises."""
    source = Source(path, data.decode("utf-8", "replace"))
    start = Location(path, 1, 1)
    try:
        root = read_yaml(data, path)
    except YamlFault as fault:
        problem = Problem(catalogue.BAD_RVIZ, f"not readable as YAML: {fault}", fault.location)
        return RvizFile(path, source, problem, None, start, ())
    manager = root.get("Visualization Manager")
    if manager is None:
        problem = Problem(catalogue.BAD_RVIZ, "there is no 'Visualization Manager' in it: this is no RViz file", start)
        return RvizFile(path, source, problem, None, start, ())
    frame = manager.get("Global Options", "Fixed Frame")
    displays = tuple(_displays(manager.get("Displays")))
    return RvizFile(
        path, source, None, frame.text if frame else None, frame.location if frame else manager.location, displays
    )


def switched_on(node: Node | None, *, default: bool) -> bool:
    """A setting as RViz reads it: everything is on but false, 0 and nothing (QVariant::toBool)."""
    if node is None or node.text is None:
        return default
    return node.text.lower() not in ("false", "0", "")


def _is_enabled(display: Node) -> bool:
    return switched_on(display.get("Enabled"), default=switched_on(display.get("Value"), default=False))


def _displays(listed: Node | None) -> Iterator[Display]:
    """The displays of a list and of the groups in it; what is in a group that is off is off."""
    waiting = [(node, True) for node in listed.items] if listed is not None else []
    for _ in range(_MOST_DISPLAYS):
        if not waiting:
            return
        node, shown = waiting.pop(0)
        named, title = node.get("Class"), node.get("Name")
        package, _, kind = (named.text or "" if named else "").rpartition("/")
        enabled = shown and _is_enabled(node)
        yield Display(package, kind, title.text or "" if title else "", enabled, node)
        inner = node.get("Displays")
        if inner is not None and len(waiting) < _MOST_DISPLAYS:
            waiting += [(each, enabled) for each in inner.items]
