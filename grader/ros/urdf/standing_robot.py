"""A robot that stands on level ground: on which links, what its base is, and where it drives."""

from collections.abc import Sequence
from itertools import combinations_with_replacement
from math import inf

from grader.base.errors import MissingElement, NotDecided
from grader.base.text import enumerated, quoted
from grader.base.transforms import Z_AXIS, Vector, dot, minus
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint, Link
from grader.ros.urdf.resting import (
    MAX_SHAPES,
    Rest,
    find_rest,
    level_directions,
    list_fall,
    lowest_points,
    make_body,
    solid_shapes,
)
from grader.ros.urdf.rolling import Course, DrivenWheel, mean

_GRAVITY = 9.81  # m/s^2
_ROUNDING = 1e-9  # metres


class StandingRobot:
    """A robot that stands on level ground: how it rests, and where its wheels drive it.

    It is made of the links that are meant, which are supports or wheels, and of the base, by
    default the nearest link above all of them that has a shape. What is fixed to one of these links
    counts as that link. Raises NotDecided, MissingElement or UnknownShape where it cannot be
    determined how it stands. With `is_level`, its base is level and these links touch the ground,
    however it stands.
    """

    def __init__(
        self,
        robot: Configuration,
        named: Sequence[str],
        base: str = "",
        *,
        is_level: bool = False,
    ) -> None:
        self.robot = robot
        self.named = named
        for link in named:
            robot.link(link)
        shaped = [link.name for link in robot.robot.links if _has_shape(link)]
        if len(shaped) > MAX_SHAPES:
            raise NotDecided(f"the robot has more than {MAX_SHAPES} shapes", "it has many shapes")
        self._owners = {link: self._find_owner(link) for link in shaped}
        for link in named:
            if link not in self._owners.values():
                message = f"link {quoted(link)} has no visual or collision with a size"
                at = robot.link(link).location
                raise MissingElement("visual", link, message=message, location=at)
        self.base = base or self._find_base()
        robot.link(self.base)
        for link in named:
            robot.pose(link, relative_to=self.base)
        self.body = make_body(robot, self.base)
        self.rest: Rest = find_rest(self.body)
        if is_level:
            self.rest = self.rest.leveled(self.named)

    def _find_base(self) -> str:
        """Return the nearest link with a shape above all links that are named."""
        shared = self._list_upward(self.named[0])
        for link in self.named[1:]:
            upward = self._list_upward(link)
            shared = [name for name in shared if name in upward]
        for name in shared:
            if _has_shape(self.robot.link(name)) and [name] != list(self.named):
                return name
        names = enumerated([quoted(name) for name in self.named])
        raise NotDecided(
            f"no link with a shape is above {names}, so it is not known which one is the base",
            "it is not known which link is the base",
        )

    def _list_upward(self, link: str) -> list[str]:
        return [link, *(joint.parent for joint in reversed(self.robot.chain(link)))]

    def _find_owner(self, link: str) -> str:
        """Return the link that is named and that another one is fixed to, else that one itself."""
        name = link
        for joint in reversed(self.robot.chain(link)):
            if name in self.named:
                return name
            if joint.type != "fixed":
                return link
            name = joint.parent
        return name if name in self.named else link

    def height(self, link: str) -> float:
        """Return the height of the lowest point of a named link above the ground.

        What is fixed to the link belongs to it.
        """
        heights = self.rest.heights
        return min(heights[name] for name in heights if self._owners[name] == link)

    def find_odd_height(self) -> tuple[str, float]:
        """Return the named link whose lowest point is farthest from the level of the others.

        The base is level. Also return how far above it is, in metres.
        """
        bottoms: dict[str, float] = {}
        for name, shape in self.body.shapes:
            owner = self._owners[name]
            if owner in self.named:
                bottoms[owner] = min(shape.extent(Z_AXIS)[0], bottoms.get(owner, inf))
        usual = sorted(bottoms.values())[len(bottoms) // 2]
        odd = max(bottoms, key=lambda link: abs(bottoms[link] - usual))
        return odd, bottoms[odd] - usual

    @property
    def touching(self) -> list[str]:
        """The links on which the robot rests, as they are named."""
        return list(dict.fromkeys(self._owners[link] for link in self.rest.contacts))

    def list_fall(self) -> list[tuple[Vector, float]]:
        """Return how it comes to rest that is set down with its base level.

        It may tip over. The result is where up is on the way, each with the height of the centre of
        mass above the ground.
        """
        return list_fall(self.body)

    def _find_span_below_mass(self) -> tuple[float, float] | None:
        """Return how far the area between contacts reaches from below the centre of mass.

        It reaches backward and forward; the contacts are those of links. Returns None if it is not
        below the centre of mass.
        """
        forward, left = level_directions(self.rest.up)
        corners = []
        for link, points in self.rest.contacts.items():
            if self._owners[link] not in self.named:
                continue
            for point in points:
                away = minus(point, self.rest.mass_centre)
                corners.append((dot(away, forward), dot(away, left)))
        crossings = []
        for (x, y), (other_x, other_y) in combinations_with_replacement(corners, 2):
            if abs(y) <= _ROUNDING:
                crossings.append(x)
            elif y * other_y < 0.0:
                crossings.append(x + (other_x - x) * y / (y - other_y))
        if not crossings or min(crossings) > _ROUNDING or max(crossings) < -_ROUNDING:
            return None
        return (-min(crossings), max(crossings))

    def wheels(self, rollers: Sequence[float] | None = None) -> list[DrivenWheel]:
        """Return the wheels that the named links are.

        `rollers` has the angle in degrees to the rollers of each, of omni and mecanum wheels.
        """
        robot = self.robot
        up = self.rest.up
        wheels = []
        for number, link in enumerate(self.named):
            joint = self._find_turning_joint(link)
            T_base_joint = robot.pose(joint.child, relative_to=self.base)
            shapes = []
            for name, shape in self.body.shapes:
                if joint.name in [above.name for above in robot.chain(name)]:
                    shapes.append(shape)
            axis = T_base_joint.rotate(robot.axis(joint))
            contact = mean(lowest_points(shapes, up))
            roller = None if rollers is None else rollers[number]
            wheel = DrivenWheel(
                link, joint, axis, T_base_joint.translation, tuple(shapes), contact, roller
            )
            wheels.append(wheel)
        return wheels

    def _find_turning_joint(self, link: str) -> Joint:
        base = quoted(self.base)
        types = "one should be continuous or revolute"
        message = f"no joint between {base} and {quoted(link)} turns; {types}"
        return self.robot.joint_between(self.base, link, ("continuous", "revolute"), message)

    def drive(
        self, wheels: Sequence[DrivenWheel], rates: Sequence[float], forward: Vector
    ) -> Course:
        """Return how the robot moves while its wheels turn at these rates (rad/s).

        The motion is compared to a direction in the frame of the base.
        """
        return Course.of(self.rest.up, wheels, rates, forward)

    def tipping_accelerations(self) -> tuple[float, float] | None:
        """Return the accelerations in m/s^2 from which on the robot tips over.

        They are forward and backward, and the robot rests on the named links. Returns None if its
        centre of mass is not over them.
        """
        span = self._find_span_below_mass()
        if span is None:
            return None
        height = self.rest.mass_height
        if not height > 0.0:
            return (inf, inf)
        return (_GRAVITY * span[0] / height, _GRAVITY * span[1] / height)


def _has_shape(link: Link) -> bool:
    return bool(solid_shapes(link.collisions) or solid_shapes(link.visuals))
