"""RViz configuration files: the fixed frame and the enabled displays, as RViz of ROS 2 reads them."""

from collections.abc import Iterator
from dataclasses import dataclass

from grader.package import catalogue
from grader.package.yaml_nodes import Node, YamlFault, read_yaml
from grader.problems import Problem
from grader.source import Location, Source

_MAX_DISPLAYS = 500
_PLUGINS = "rviz_default_plugins"
_NOT_RVIZ = "there is no 'Visualization Manager': this is not an RViz file"


@dataclass(frozen=True, slots=True)
class Display:
    """One display; `kind` is its class without the package: RobotModel. `node` has its settings."""

    package: str
    kind: str
    name: str
    enabled: bool
    node: Node

    def is_on(self, setting: str) -> bool:
        """Return whether one of its own settings is on; a missing one is."""
        return switched_on(self.node.get(setting), default=True)

    @property
    def is_enabled(self) -> bool:
        """Return whether the display itself is enabled, regardless of its group; Enabled overrides Value."""
        return _is_enabled(self.node)

    @property
    def location(self) -> Location:
        """The location of its class."""
        return (self.node.get("Class") or self.node).location


@dataclass(frozen=True, slots=True)
class RvizFile:
    """The content of an RViz file. `fault` is set where it cannot be read: nothing else is known then."""

    path: str
    source: Source
    fault: Problem | None
    fixed_frame: str | None
    frame_location: Location
    displays: tuple[Display, ...]
    unread: str = ""  # why the file was not read at all: too large, damaged

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The problems of the file, whatever it is graded on."""
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
            found.append(Problem(catalogue.NO_TF, "the file has no enabled TF display", Location(self.path, 1, 1)))
        return tuple(found)


def read_rviz(data: bytes, path: str) -> RvizFile:
    """Read an RViz file. Never raises."""
    source = Source(path, data.decode("utf-8", "replace"))
    start = Location(path, 1, 1)
    try:
        manager = read_yaml(data, path).get("Visualization Manager")
        problem = Problem(catalogue.BAD_RVIZ, _NOT_RVIZ, start)
    except YamlFault as fault:
        manager = None
        problem = Problem(catalogue.BAD_RVIZ, f"not readable as YAML: {fault}", fault.location)
    if manager is None:
        return RvizFile(path, source, problem, None, start, ())
    frame = manager.get("Global Options", "Fixed Frame")
    displays = tuple(_displays(manager.get("Displays")))
    return RvizFile(
        path, source, None, frame.text if frame else None, frame.location if frame else manager.location, displays
    )


def switched_on(node: Node | None, *, default: bool) -> bool:
    """Return a setting as RViz reads it: everything but false, 0 and the empty text is on (QVariant::toBool)."""
    if node is None or node.text is None:
        return default
    return node.text.lower() not in ("false", "0", "")


def _is_enabled(display: Node) -> bool:
    return switched_on(display.get("Enabled"), default=switched_on(display.get("Value"), default=False))


def _displays(listed: Node | None) -> Iterator[Display]:
    """Yield the displays of a list and of its groups; in a disabled group they are disabled."""
    pending = [(node, True) for node in listed.items] if listed is not None else []
    for _ in range(_MAX_DISPLAYS):
        if not pending:
            return
        node, group_enabled = pending.pop(0)
        named, title = node.get("Class"), node.get("Name")
        package, _, kind = (named.text or "" if named else "").rpartition("/")
        enabled = group_enabled and _is_enabled(node)
        yield Display(package, kind, title.text or "" if title else "", enabled, node)
        inner = node.get("Displays")
        if inner is not None and len(pending) < _MAX_DISPLAYS:
            pending += [(display, enabled) for display in inner.items]
