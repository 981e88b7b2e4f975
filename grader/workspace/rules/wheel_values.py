"""Numbers of wheels: radii, tracks and wheelbases, against the robot's wheels.

The numbers are what controllers and plugins of Gazebo are told.

The rows of controllers, in the files of their packages, and of gazebo.toml say which parameter is
which number.
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import chain
from math import hypot

from grader.base.errors import MissingElement, NotDecided
from grader.base.names import closest, last_part
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.source import Location
from grader.base.text import enumerated, quoted
from grader.base.transforms import Y_AXIS, Vector, add_up, dot, minus, unit
from grader.ros.config.yaml_nodes import YamlNode
from grader.ros.known.gazebo_rows import NO_SYSTEM, gazebo
from grader.ros.known.package_rows import WheelRow
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint, Robot
from grader.ros.urdf.numbers import finite_number
from grader.ros.urdf.rolling import mean
from grader.ros.urdf.wheel_sizes import WheelSize, measure_wheel
from grader.ros.xml.elements import first_text
from grader.ros.xml.parsing import Element
from grader.workspace.graph.gazebo_topics import name_system
from grader.workspace.graph.started_controllers import (
    defined_controllers,
    parameters_of_controllers,
)
from grader.workspace.model.known_robots import KnownRobot
from grader.workspace.model.under_arguments import may_vary
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Compared,
    Facts,
    Mismatch,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    OTHER_VALUE,
    WRONG_VALUE,
    Rule,
)

_Span = tuple[float, float, str]  # a length, how far it may be off, and what it is

_ENTRY = on_use(r"(.*)\.(\d+)$")  # a parameter with a list, and the number of an entry
_TOLERANCE, _ROUNDING = 0.02, 0.002  # of a number; metres
_LEVEL = 0.3  # the sine of the angle to the ground up to which an axle lies
_SIDEWAYS = 0.9  # the cosine of the angle to the y axis up to which wheels drive forward or back
_SIDED = ("track", "pivots", "half sum")  # whose first groups are left and right wheels
_ROLLING = ("track", "half sum", "radius", "diameter")  # of joints that turn wheels
_PLACING = ("origin", "axis", "cylinder", "sphere")  # elements that place and size wheels
_BASE = "base_frame_id"
_MAX_TURN = 100.0  # radians between limits, of which a wheel of 0.1 m rolls 10 m
_MAX_WHEELS = 20  # that one parameter is about; each takes as long as the robot has joints


class _Word(Named):
    """The text of a parameter, or an entry of its list, and its place."""

    text: str
    location: Location


_Parameters = Callable[[str], Sequence[_Word]]


class _Source(Named):
    """What tells a robot of its wheels: the rows of its parameters, and what they are given."""

    name: str
    rows: Mapping[str, WheelRow]
    parameters: _Parameters
    robots: Sequence[KnownRobot]

    def joints(self, keys: Sequence[str]) -> list[_Word]:
        """Return the joints that some parameters name."""
        words: list[_Word] = []
        for key in keys:
            entry = _ENTRY.fullmatch(key)
            if not entry:
                words += self.parameters(key)
            else:
                number = int(entry[2])
                words += self.parameters(entry[1])[number : number + 1]
        return words


class _Wheels(Named):
    """The wheels of the groups of a parameter, in the frame of the robot's base."""

    base: str
    groups: tuple[tuple[WheelSize, ...], ...]

    def middle_of_group(self, group: int) -> Vector:
        """Return the mean of the middles of the wheels of a group."""
        return mean(wheel.middle for wheel in self.groups[group])

    @property
    def all(self) -> list[WheelSize]:
        """The wheels of all groups, each joint once."""
        return list({wheel.joint.name: wheel for wheel in chain(*self.groups)}.values())

    @property
    def axle(self) -> Vector:
        """The direction of the axles, to the left of the base where it can be told."""
        for wheel in self.all:
            x, y, z = wheel.axis
            if abs(z) < _LEVEL:
                side = 1.0 if y >= 0.0 else -1.0
                return (side * x, side * y, 0.0)
        return (0.0, 1.0, 0.0)

    @property
    def names(self) -> str:
        """The joints, for a message."""
        return _joints(self.all)


def wheel_value_facts(workspace: Workspace) -> Facts:
    """Yield the numbers of wheels that are not those of the robot.

    They are warnings where there may be other robots. Nothing is said where xacro may place or size
    the wheels in another way, or where the numbers are those of one of several robots.
    """
    sources = [*_controllers(workspace), *_plugins(workspace)]
    if not sources or may_vary(workspace, *_PLACING):
        return
    for source in sources:
        yield Compared("values")
        is_open = workspace.robots.may_be_others
        for fault in _faults_under_all(source):
            yield fault._replace(is_certain=fault.is_certain and not is_open)


_WHEEL_LIMIT = Rule(
    "wheel-limit",
    "values",
    OTHER_VALUE,
    "A wheel that is driven in Gazebo turns without limits.",
    why=(
        "The wheel stops when it reaches the limit of its joint. The robot drives a short "
        "distance, then stands still or turns aside."
    ),
    wrong="""
<joint name="right_joint" type="revolute">
  <limit lower="-1.57" upper="1.57" effort="5" velocity="10"/>
""",
    right="""
<joint name="right_joint" type="continuous">
  <limit effort="5" velocity="10"/>
""",
    frame="limited/rover.urdf",
)


def _faults_under_all(source: _Source) -> Sequence[Mismatch]:
    """Return the faults under the first robot; none where the numbers are those of another one."""
    first: Sequence[Mismatch] = ()
    for robot in source.robots:
        faults = list(_find_faults(source, Configuration(robot.robot)))
        if robot.root.find("gazebo/plugin") is None:  # nothing else stops a joint
            faults = [fault for fault in faults if fault.rule is not _WHEEL_LIMIT]
        if not faults:
            return ()
        first = first or faults
    return first


def _controllers(workspace: Workspace) -> Iterator[_Source]:
    sections = parameters_of_controllers(workspace)
    for controller in defined_controllers(workspace):
        rows = controller.row.wheels
        section = sections.get(controller.name)
        if not rows or not section:
            continue
        source = _Source(controller.name, rows, _reader_of_yaml(section), ())
        keys = {key for row in rows.values() for key in chain(*row.of)}
        named = [joint.text for joint in source.joints(sorted(keys))]
        robots = _robots_with_joints(workspace, named)
        if named and robots:
            yield source._replace(robots=robots)


def _robots_with_joints(workspace: Workspace, names: Sequence[str]) -> list[KnownRobot]:
    """Return the robots that have all of some joints; the only one if names are misspelt."""
    robots = workspace.robots.known
    having = [each for each in robots if all(map(each.robot.has_joint, names))]
    if having or len(robots) != 1:
        return having
    [robot] = robots
    meant = [_meant(robot.robot, name) for name in names]
    return [robot] if all(map(robot.robot.has_joint, meant)) else []


def _meant(robot: Robot, name: str) -> str:
    """Return the joint that a name means; that it is misspelt is another mistake."""
    if robot.has_joint(name):
        return name
    return closest(name, (joint.known.name for joint in robot.joints), is_clear=True) or name


def _reader_of_yaml(section: YamlNode) -> _Parameters:
    def read(key: str) -> list[_Word]:
        node = section.get(*key.split("."))
        if not node:
            return []
        return [
            _Word(scalar.text, scalar.location) for scalar in (node.items or [node]) if scalar.text
        ]

    return read


def _plugins(workspace: Workspace) -> Iterator[_Source]:
    for robot in workspace.robots.known:
        for plugin in robot.root.iter("plugin"):
            name = name_system(plugin)
            rows = gazebo().system.get(name, NO_SYSTEM).wheels
            if not rows:
                name = last_part(plugin.get("filename", ""))
                library = gazebo().library.get(name)
                rows = library.wheels if library else {}
            if rows:
                yield _Source(name, rows, _reader_of_plugin(robot, plugin), [robot])


def _reader_of_plugin(robot: KnownRobot, plugin: Element) -> _Parameters:
    def read(key: str) -> list[_Word]:
        return [_Word(first_text(child), robot.place(child)) for child in plugin.iterchildren(key)]

    return read


def _find_faults(source: _Source, robot: Configuration) -> Mismatches:
    """Yield the numbers, sides and directions that are not those of a robot."""
    compared: set[str] = set()  # the joints whose sides and directions were compared
    rows = sorted(source.rows.items(), key=lambda row: row[1].number not in _SIDED)
    for key, row in rows:
        kind = row.number
        groups = [source.joints(keys) for keys in row.of]
        wheels = _measured(source, robot, groups)
        if not wheels:
            continue
        faults = []
        names = {wheel.joint.name for wheel in wheels.all}
        if compared.isdisjoint(names):
            compared |= names
            placed = _PlacedWheels(wheels, kind, _places_of_joints(wheels, groups))
            faults = [*_other_sides(placed), *_other_axes(placed)]
            yield from faults
            yield from _limited_wheels(placed)
        is_of_sides = bool(faults) and kind in _SIDED  # a number of these wheels means nothing
        if not is_of_sides and not _is_corrected(source, row):
            for number in source.parameters(key):
                yield from _faults_of_number(_WheelNumber(key, kind, number), wheels)


def _is_corrected(source: _Source, row: WheelRow) -> bool:
    """Return whether a factor corrects the number of a row."""
    for name in row.unless:
        for word in source.parameters(name):
            if finite_number(word.text) != 1.0:
                return True
    return False


def _measured(
    source: _Source, robot: Configuration, groups: Sequence[Sequence[_Word]]
) -> _Wheels | None:
    """Return the wheels of groups of joints, in the frame of the robot's base.

    The result is None where a group is empty, or a wheel cannot be measured.
    """
    named = [word.text for group in groups for word in group]
    if not all(groups) or len(named) > _MAX_WHEELS:
        return None
    try:
        base = robot.find_root(_joint(robot, named[0]).child)
        for frame in source.parameters(_BASE):
            if robot.robot.has_link(frame.text):
                base = frame.text
        measured = []
        for group in groups:
            joints = [_joint(robot, word.text) for word in group]
            measured.append(tuple(measure_wheel(robot, joint, base) for joint in joints))
    except (MissingElement, NotDecided):
        return None
    return _Wheels(base, tuple(measured))


def _joint(robot: Configuration, name: str) -> Joint:
    return robot.joint(_meant(robot.robot, name))


class _PlacedWheels(Named):
    """Wheels whose sides and directions are compared, with where their joints are named."""

    wheels: _Wheels
    kind: str  # of the number that they have
    places: Mapping[str, Location]

    @property
    def backward(self) -> Sequence[WheelSize]:
        """The wheels that drive backward with a positive speed."""
        return [wheel for wheel in self.wheels.all if wheel.axis[1] < -_SIDEWAYS]

    @property
    def are_all_exchanged(self) -> bool:
        """Whether the left wheels are on the right and the reverse, and all turn backward.

        The robot then drives backward.
        """
        if self.kind not in _ROLLING or self.kind not in _SIDED:
            return False
        return len(_exchanged(self.wheels)) == len(self.backward) == len(self.wheels.all)

    def fault(
        self, rule: Rule, wheels: Sequence[WheelSize], message: str, *, is_certain: bool = False
    ) -> Mismatch:
        """Return what is wrong with some of the wheels, where the first is named."""
        at = self.places[wheels[0].joint.name]
        return Mismatch(rule, message, at, _place(wheels[0]), is_certain)


def _places_of_joints(wheels: _Wheels, groups: list[list[_Word]]) -> Mapping[str, Location]:
    places = {}
    for wheel, word in zip(chain(*wheels.groups), chain(*groups), strict=True):
        places[wheel.joint.name] = word.location
    return places


WHEEL_SIDE = Rule(
    "wheel-side",
    "values",
    WRONG_VALUE,
    "The left and right wheels of a controller or a Gazebo plugin are on their sides.",
    why=(
        "A command to turn left turns the robot right. The odometry reports the opposite of the"
        " motion, so maps and localization are wrong."
    ),
    wrong="""
<left_joint>right_joint</left_joint>
<right_joint>left_joint</right_joint>
<wheel_separation>0.3</wheel_separation>
""",
    right="""
<left_joint>left_joint</left_joint>
<right_joint>right_joint</right_joint>
<wheel_separation>0.3</wheel_separation>
""",
    frame="wheels/rover.urdf",
)


def _other_sides(placed: _PlacedWheels) -> Mismatches:
    """Yield that left wheels are on the right, and the reverse.

    It is certain unless they turn backward too, as where the front of the robot is its -x.
    """
    wheels = placed.wheels
    base = quoted(placed.wheels.base)
    exchanged = _exchanged(wheels) if placed.kind in _SIDED else []
    if placed.are_all_exchanged:
        message = (
            f"the wheels of {wheels.names} drive the robot toward -x of {base}: left and right "
            "are exchanged, and their axes point to the right"
        )
        yield placed.fault(WHEEL_SIDE, exchanged, message)
    elif exchanged and abs(_toward_left(wheels)[1]) > _SIDEWAYS:
        sides = [f"{quoted(each.joint.name)} is at y {each.middle[1]:.4g} m" for each in exchanged]
        message = f"left and right wheels are exchanged: {', '.join(sides)} in {base}"
        yield placed.fault(WHEEL_SIDE, exchanged, message, is_certain=True)


_WHEEL_AXIS = Rule(
    "wheel-axis",
    "values",
    OTHER_VALUE,
    "A positive speed of a wheel drives forward.",
    why=(
        "The wheel rotates backward at a forward command. The robot drives backward or rotates "
        "in place, while the odometry says otherwise."
    ),
    wrong='<axis xyz="0 -1 0"/>',
    right='<axis xyz="0 1 0"/>',
    frame="turned/rover.urdf",
    at="urdf/rover.urdf",
)


def _other_axes(placed: _PlacedWheels) -> Mismatches:
    """Yield wheels that turn about an axis across their axle, and wheels that turn backward.

    Nothing is said where left and right are exchanged as well, which is said of the sides.
    """
    wheels = placed.wheels
    base = quoted(placed.wheels.base)
    if placed.kind not in _ROLLING or placed.are_all_exchanged:
        return
    across = []
    if placed.kind in _SIDED:
        toward_left = _toward_left(wheels)
        across = [each for each in wheels.all if abs(dot(each.axis, toward_left)) < _LEVEL]
    if across:
        x, y, z = across[0].axis
        message = (
            f"{_joints(across)} should turn about the axle from right to left, not about "
            f"{x:.3g} {y:.3g} {z:.3g} in {base}"
        )
        yield placed.fault(_WHEEL_AXIS, across, message)
    if placed.backward:
        message = (
            f"a positive speed of {_joints(placed.backward)} drives toward -x of {base}: the axis "
            "should point to the left"
        )
        yield placed.fault(_WHEEL_AXIS, placed.backward, message)


def _limited_wheels(placed: _PlacedWheels) -> Mismatches:
    """Yield the wheels that stop after some turns, as those of a simulated robot do.

    Limits that are meant to be none are wider. A number that is of neither side may be of joints
    that steer.
    """
    if placed.kind not in _ROLLING or placed.kind not in _SIDED:
        return
    for wheel in placed.wheels.all:
        joint = wheel.joint
        limit = wheel.joint.limit
        if joint.type != "revolute" or not limit or limit.upper - limit.lower > _MAX_TURN:
            continue
        message = (
            f"{quoted(joint.name)} turns from {limit.lower:.4g} to {limit.upper:.4g} rad, where "
            "the wheel stops: write type='continuous'"
        )
        at = limit.location or joint.location
        if at:
            wrong = warning(_WHEEL_LIMIT, message, at.resolve(), placed.places[joint.name])
            yield wrong.offering("revolute", "continuous", wrong.related)


def _toward_left(wheels: _Wheels) -> Vector:
    """Return the direction from the right wheels to the left ones, or y where there is none."""
    left = wheels.middle_of_group(0)
    right = wheels.middle_of_group(1)
    return unit((left[0] - right[0], left[1] - right[1], 0.0)) or Y_AXIS


def _exchanged(wheels: _Wheels) -> list[WheelSize]:
    """Return the left wheels that are right of the middle between the wheels, and the reverse."""
    middle = mean(wheel.middle for wheel in wheels.all)[1]
    left, right = wheels.groups[:2]
    exchanged = [wheel for wheel in left if wheel.middle[1] < middle]
    return exchanged + [wheel for wheel in right if wheel.middle[1] > middle]


def _joints(wheels: Sequence[WheelSize]) -> str:
    return enumerated([quoted(wheel.joint.name) for wheel in wheels])


def _place(wheel: WheelSize) -> Location | None:
    location = wheel.joint.location
    return location.resolve() if location else None


class _WheelNumber(Named):
    """A number that a source has for wheels."""

    key: str
    kind: str
    word: _Word


def _faults_of_number(number: _WheelNumber, wheels: _Wheels) -> Mismatches:
    """Yield that a number is not what the wheels of the robot have."""
    value = finite_number(number.word.text)
    is_size = number.kind in ("radius", "diameter")
    if value is not None and is_size:
        yield from _other_sizes(number, value, wheels)
    elif value is not None:
        yield from _other_distance(number, value, wheels)


_WHEEL_DISTANCE = Rule(
    "wheel-distance",
    "values",
    WRONG_VALUE,
    "The track and wheelbase of a controller or a Gazebo plugin are those of the robot.",
    why=(
        "The robot turns more or less than commanded. The angle of the odometry is wrong after "
        "each turn, so maps are distorted."
    ),
    wrong="""
<left_joint>left_joint</left_joint>
<right_joint>right_joint</right_joint>
<wheel_separation>0.6</wheel_separation>
""",
    right="""
<left_joint>left_joint</left_joint>
<right_joint>right_joint</right_joint>
<wheel_separation>0.3</wheel_separation>
""",
    frame="wheels/rover.urdf",
)


def _other_distance(number: _WheelNumber, value: float, wheels: _Wheels) -> Mismatches:
    """Yield that the wheels of the robot are not as far apart as a number says.

    The distance differs by more than their width and 2 %.

    It is certain for a negative number, and for twice or half the track of two wheels. The track of
    more than two wheels, which slip sideways, may be wider.
    """
    key = number.key
    at = number.word.location
    if value < 0.0:
        yield Mismatch(_WHEEL_DISTANCE, _negative(key, value), at)
        return
    measured, slack, what = _SPANS[number.kind](wheels)
    low = measured - slack
    high = measured + slack
    is_track = number.kind == "track"
    if len(wheels.all) > 2 and is_track:
        high = max(high, value)
    rounding = _ROUNDING + _TOLERANCE * measured
    if low - rounding <= value <= high + rounding:
        return
    message = f"{key} is {value:g} m; {what} {measured:.4g} m"
    if slack:
        message += f" ({low:.4g} to {high:.4g} m with the width of the wheels)"
    is_certain = is_track and _is_other_half(value, measured, wheels)
    yield Mismatch(_WHEEL_DISTANCE, message, at, _place(wheels.all[0]), is_certain)


def _negative(key: str, value: float) -> str:
    return f"{key} is {value:g}: a length is not negative"


def _is_other_half(value: float, measured: float, wheels: _Wheels) -> bool:
    """Return whether a number is twice or half the track of two wheels of known width.

    It surely is a mistake.
    """
    if len(wheels.all) != 2 or any(wheel.half_width is None for wheel in wheels.all):
        return False
    return _is_near(value, 2.0 * measured) or _is_near(value, measured / 2.0)


def _is_near(value: float, other: float) -> bool:
    return abs(value - other) <= _TOLERANCE * other


def _wheels_of_other_size(wheels: _Wheels, value: float, factor: float) -> list[WheelSize]:
    """Return the wheels without a radius that a factor turns into a value; one if none has it."""
    sized = [wheel for wheel in wheels.all if wheel.radii]
    fitting = []
    for wheel in sized:
        if any(_is_near(value, factor * radius) for radius in wheel.radii):
            fitting.append(wheel)
    others = [wheel for wheel in sized if wheel not in fitting]
    return others if fitting else others[:1]


_WHEEL_SIZE = Rule(
    "wheel-size",
    "values",
    WRONG_VALUE,
    "The wheel radius of a controller or a Gazebo plugin is that of the robot.",
    why=(
        "The robot drives faster or slower than commanded, and the distance of the odometry is "
        "wrong by the same factor."
    ),
    wrong="""
<left_joint>left_joint</left_joint>
<right_joint>right_joint</right_joint>
<wheel_radius>0.1</wheel_radius>
""",
    right="""
<left_joint>left_joint</left_joint>
<right_joint>right_joint</right_joint>
<wheel_radius>0.05</wheel_radius>
""",
    frame="wheels/rover.urdf",
)


def _other_sizes(number: _WheelNumber, value: float, wheels: _Wheels) -> Mismatches:
    """Yield that no wheel has a radius, and that wheels of one radius have several.

    A negative radius certainly is a mistake.
    """
    key = number.key
    kind = number.kind
    at = number.word.location
    if value < 0.0:
        yield Mismatch(_WHEEL_SIZE, _negative(key, value), at)
        return
    factor = 2.0 if kind == "diameter" else 1.0
    for wheel in _wheels_of_other_size(wheels, value, factor):
        name = quoted(wheel.joint.name)
        size = factor * wheel.radii[0]
        message = f"{key} is {value:g} m; the wheel of {name} has the {kind} {size:.4g} m"
        yield warning(_WHEEL_SIZE, message, at, _place(wheel))


def _measure_track(wheels: _Wheels) -> _Span:
    """Return the distance of the left wheels from the right ones along the axles.

    With it, return by how much the width of wheels changes it, and what it is.
    """
    left = wheels.middle_of_group(0)
    right = wheels.middle_of_group(1)
    widths = [wheel.half_width for wheel in wheels.all]
    slack = 2.0 * max([width for width in widths if width is not None], default=0.0)
    distance = abs(dot(minus(left, right), wheels.axle))
    if None in widths:
        slack = max(slack, distance / 4.0)  # the middle of a mesh may be beside its joint
    return distance, slack, f"the wheels of {wheels.names} are apart by"


def _measure_wheelbase(wheels: _Wheels) -> _Span:
    """Return the distance of the front wheels from the rear ones across the axles."""
    front = wheels.middle_of_group(0)
    rear = wheels.middle_of_group(1)
    x, y, _ = wheels.axle
    distance = abs(dot(minus(front, rear), (y, -x, 0.0)))
    return distance, 0.0, f"the axles of {wheels.names} are apart by"


def _measure_half_sum(wheels: _Wheels) -> _Span:
    """Return half the track and half the wheelbase together."""
    track, slack, _ = _measure_track(wheels._replace(groups=wheels.groups[:2]))
    wheelbase, _, _ = _measure_wheelbase(wheels._replace(groups=wheels.groups[2:]))
    what = "half the track and half the wheelbase of the robot together are"
    return (track + wheelbase) / 2.0, slack / 2.0, what


def _measure_ring(wheels: _Wheels) -> _Span:
    """Return the mean distance of wheels from the middle between them."""
    middle = mean(wheel.middle for wheel in wheels.all)
    away = [minus(wheel.middle, middle) for wheel in wheels.all]
    distance = add_up(hypot(x, y) for x, y, _ in away) / len(away)
    widths = [wheel.half_width or 0.0 for wheel in wheels.all]
    return distance, max(widths), f"the wheels of {wheels.names} are from their middle by"


_SPANS = {
    "track": _measure_track,
    "pivots": _measure_track,
    "wheelbase": _measure_wheelbase,
    "half sum": _measure_half_sum,
    "ring": _measure_ring,
}
