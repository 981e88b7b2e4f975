"""RViz configuration files as RViz of ROS 2 reads them.

What is read are the fixed frame and the enabled displays.
"""

from collections.abc import Iterator
from contextlib import suppress

from grader.base.merge_conflicts import resolve_conflicts
from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.reuse import reuse
from grader.base.slips import fix_together
from grader.base.source import Location, Source
from grader.ros.config.yaml_nodes import YamlFault, YamlNode, read_yaml
from grader.ros.config.yaml_slips import yaml_slips
from grader.ros.installation import package_problems as kinds
from grader.ros.installation.places import is_of_one_machine

_MAX_DISPLAYS = 500


class Display(Named):
    """One display; `kind` is its class without the package: RobotModel. `node` has its settings."""

    package: str
    kind: str
    name: str
    group_enabled: bool
    node: YamlNode

    @property
    def enabled(self) -> bool:
        """Whether it is enabled, and its groups as well."""
        return self.group_enabled and self.is_enabled

    def is_on(self, setting: str) -> bool:
        """Return whether one of its own settings is on; a missing one is."""
        return _switched_on(self.node.get(setting), default=True)

    @property
    def is_enabled(self) -> bool:
        """Whether it is enabled itself, whatever its group is."""
        # rviz_common's Display::load sets Value first, and then Enabled.
        return _switched_on(
            self.node.get("Enabled"), default=_switched_on(self.node.get("Value"), default=False)
        )

    @property
    def hides_links(self) -> str:
        """Why the links of a RobotModel are not drawn although it is on; empty if they are."""
        alpha = self.node.get("Alpha")
        links = self.node.get("Links")
        with suppress(ValueError):
            if alpha and float(alpha.text or "1") <= 0:
                return "its Alpha is 0"
        tables = links.value.values() if links and isinstance(links.value, dict) else ()
        shown = [value for link in tables if (value := link.get("Value")) is not None]
        if shown and not any(_switched_on(switch, default=True) for switch in shown):
            return "all its links are off"
        return ""

    @property
    def file(self) -> str:
        """The path of the file that a RobotModel may read in place of a topic; empty without."""
        node = self.node.get("Description File")
        return (node.text or "" if node else "").strip()

    @property
    def reads_file_of_one_machine(self) -> bool:
        """Whether the path of its file exists on one machine only."""
        return is_of_one_machine(self.file)

    @property
    def location(self) -> Location:
        """The location of its class."""
        return (self.node.get("Class") or self.node).location


class RvizFile(Named):
    """The content of an RViz file.

    `fault` is set where it cannot be read: nothing else is known then.
    """

    source: Source
    fault: Problem | None
    fixed_frame: str | None
    frame_location: Location
    displays: tuple[Display, ...]
    unread: str = ""  # why the file was not read at all: too large, damaged
    conflict: Problem | None = None  # of git, without which it was read

    @property
    def problems(self) -> tuple[Problem, ...]:
        """The problems of the file, whatever it is graded on."""
        if self.fault:
            return (self.fault,)
        if self.unread:
            return ()
        listed = [self.conflict] if self.conflict else []
        for display in self.displays:
            if display.package == "rviz":
                kind = display.kind
                message = (
                    f"rviz/{kind} is a class of ROS 1; in ROS 2 it is rviz_default_plugins/{kind}"
                )
                listed.append(Problem(kinds.ROS1_CLASS, message, display.location))
        if not any(display.kind == "TF" and display.enabled for display in self.displays):
            start = Location(self.source.path, 1, 1)
            listed.append(Problem(kinds.NO_TF, "the file has no enabled TF display", start))
        return tuple(listed)


@reuse
def read_rviz(data: bytes, path: str) -> RvizFile:
    """Read an RViz file. It never raises."""
    resolved = resolve_conflicts(data)
    if resolved:
        problem = Problem(kinds.BAD_RVIZ, resolved.message, Location(path, resolved.line, 1))
        return read_rviz(resolved.data, path)._replace(conflict=problem)
    source = Source.decoded(path, data)
    start = Location(path, 1, 1)
    try:
        manager = read_yaml(data, path).get("Visualization Manager")
        message = "there is no 'Visualization Manager': this is not an RViz file"
        problem = Problem(kinds.BAD_RVIZ, message, start)
    except YamlFault as fault:
        manager = None
        message = f"not readable as YAML: {fault}"
        fixes = fix_together(lambda: yaml_slips(data, path))
        problem = Problem(kinds.BAD_RVIZ, message, fault.location, fixes=fixes)
    if not manager:
        return RvizFile(source, problem, None, start, ())
    frame = manager.get("Global Options", "Fixed Frame")
    displays = tuple(_displays(manager))
    location = frame.location if frame else manager.location
    return RvizFile(source, None, frame.text if frame else None, location, displays)


def _switched_on(node: YamlNode | None, *, default: bool) -> bool:
    """Return a setting as RViz reads it.

    Everything but false, 0 and the empty text is on (QVariant::toBool).
    """
    if not node or node.text is None:
        return default
    return node.text.lower() not in ("false", "0", "")


def _displays(root: YamlNode) -> Iterator[Display]:
    """Yield the displays of the root group and of the groups in it.

    In a disabled group they are disabled.
    """
    listed = root.get("Displays")
    is_on = _switched_on(root.get("Enabled"), default=_switched_on(root.get("Value"), default=True))
    pending = [(node, is_on) for node in listed.items] if listed else []
    for _ in range(_MAX_DISPLAYS):
        if not pending:
            return
        node, group_enabled = pending.pop(0)
        named = node.get("Class")
        title = node.get("Name")
        package, _, kind = (named.text or "" if named else "").rpartition("/")
        display = Display(package, kind, title.text or "" if title else "", group_enabled, node)
        yield display
        inner = node.get("Displays")
        if inner is not None and len(pending) < _MAX_DISPLAYS:
            pending += [(item, display.enabled) for item in inner.items]
