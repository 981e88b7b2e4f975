"""Designs of robots with two driven wheels: correct ones of many sizes and styles, and faults that a person makes."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import pi, radians, tan
from random import Random
from typing import Any

WHEELS = ["left_wheel", "right_wheel"]
Change = Callable[["Design", Random], "Design"]


@dataclass(frozen=True, slots=True)
class Side:
    """One wheel: metres and radians; `lift`, `ahead` and `eccentric` are faults, or harmless."""

    radius: float
    width: float
    sense: int = 1  # -1 is a joint's axis to the other side
    lift: float = 0.0
    ahead: float = 0.0
    toe: float = 0.0
    eccentric: float = 0.0
    joint_type: str = "continuous"


@dataclass(frozen=True, slots=True)
class Design:
    """A robot with a box, two wheels and casters; heights are from the ground if all is correct."""

    left: Side
    right: Side
    track: float
    axle: float  # x of the axle
    box: tuple[float, float, float]
    clearance: float
    casters: tuple[float, ...]  # their x
    base_height: float  # of the frame base_link
    caster_radius: float
    caster_lift: float = 0.0
    mass: float | None = 5.0  # without, no link has one
    mass_at: tuple[float, float, float] | None = None  # in base_link
    flipped: bool = False  # the frames of the wheels
    collides: bool = True
    footprint: bool = True
    mounted: bool = False  # the casters are below mounts
    lidar: bool = True
    pose: Sequence[float] = field(default=(0.0, 0.0, 0.0))  # rpy of base_link in base_footprint

    @property
    def supports(self) -> list[str]:
        """Return the links on which it rests."""
        return [*WHEELS, *(f"caster_{number}" for number in range(len(self.casters)))]

    @property
    def urdf(self) -> str:
        """Return it as a URDF."""
        parts: list[str] = []
        if self.footprint:
            parts.append('<link name="base_footprint"/>')
            parts.append(
                joint(
                    "base",
                    "fixed",
                    "base_footprint",
                    "base_link",
                    (0, 0, self.base_height),
                    self.pose,
                )
            )
        length, breadth, height = self.box
        middle = self.clearance + height / 2 - self.base_height
        inertias = (
            (breadth**2 + height**2) / 12,
            (length**2 + height**2) / 12,
            (length**2 + breadth**2) / 12,
        )
        at = self.mass_at or (0.0, 0.0, middle)
        box = f'<box size="{length} {breadth} {height}"/>'
        inside = self.shape(box, (0, 0, middle)) + self.inertial(1.0, inertias, at)
        parts.append(f'<link name="base_link">{inside}</link>')
        for name, side, y in (("left", self.left, 0.5), ("right", self.right, -0.5)):
            parts += self.wheel(f"{name}_wheel", side, y * self.track)
        for number, x in enumerate(self.casters):
            parts += self.caster(f"caster_{number}", x)
        if self.lidar:
            top = self.clearance + height + 0.02 - self.base_height
            shown = self.shape('<cylinder radius="0.03" length="0.04"/>', (0, 0, 0))
            parts.append(f'<link name="lidar">{shown}</link>')
            parts.append(joint("lidar", "fixed", "base_link", "lidar", (0, 0, top)))
        return f'<robot name="rover">{"".join(parts)}</robot>'

    def wheel(self, name: str, side: Side, y: float) -> list[str]:
        """Return the link and the joint of a wheel."""
        turned = -1 if self.flipped else 1
        inertia = 0.5 * side.radius**2
        cylinder = f'<cylinder radius="{side.radius}" length="{side.width}"/>'
        inside = self.shape(cylinder, (side.eccentric, 0, 0))
        inside += self.inertial(0.1, (inertia, inertia, inertia), (0, 0, 0))
        at = (self.axle + side.ahead, y, side.radius + side.lift - self.base_height)
        rpy = (-turned * pi / 2, 0, side.toe)
        axis = f'<axis xyz="0 0 {turned * side.sense}"/>'
        if side.joint_type == "fixed":
            axis = ""
        return [
            f'<link name="{name}">{inside}</link>',
            joint(name, side.joint_type, "base_link", name, at, rpy, axis),
        ]

    def caster(self, name: str, x: float) -> list[str]:
        """Return the links and the joints of a caster."""
        radius = self.caster_radius
        inside = self.shape(f'<sphere radius="{radius}"/>', (0, 0, 0))
        inside += self.inertial(0.02, (1e-4, 1e-4, 1e-4), (0, 0, 0))
        link = f'<link name="{name}">{inside}</link>'
        at = (x, 0, radius + self.caster_lift - self.base_height)
        if not self.mounted:
            return [link, joint(name, "fixed", "base_link", name, at)]
        mount = f"{name}_mount"
        above = (x, 0, at[2] + 0.05)
        return [
            f'<link name="{mount}"/>',
            joint(mount, "fixed", "base_link", mount, above, (0, 0, 1)),
            link,
            joint(name, "fixed", mount, name, (0, 0, -0.05), (0, 0, -1)),
        ]

    def shape(self, geometry: str, xyz: Sequence[float]) -> str:
        """Return a visual, with a collision that is equal if the design has collisions."""
        inside = f'<origin xyz="{numbers(xyz)}"/><geometry>{geometry}</geometry>'
        text = f"<visual>{inside}</visual>"
        if self.collides:
            text += f"<collision>{inside}</collision>"
        return text

    def inertial(self, share: float, inertias: Sequence[float], xyz: Sequence[float]) -> str:
        """Return an <inertial>, if the design has masses; inertias are those of 1 kg."""
        if self.mass is None:
            return ""
        mass = share * self.mass
        xx, yy, zz = (mass * inertia for inertia in inertias)
        tensor = f'<inertia ixx="{xx}" ixy="0" ixz="0" iyy="{yy}" iyz="0" izz="{zz}"/>'
        return f'<inertial><origin xyz="{numbers(xyz)}"/><mass value="{mass}"/>{tensor}</inertial>'


def joint(
    name: str,
    kind: str,
    parent: str,
    child: str,
    xyz: Sequence[float],
    rpy: Sequence[float] = (0.0, 0.0, 0.0),
    more: str = "",
) -> str:
    """Return a joint."""
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    origin = f'<origin xyz="{numbers(xyz)}" rpy="{numbers(rpy)}"/>'
    return f'<joint name="{name}_joint" type="{kind}">{ends}{origin}{more}</joint>'


def numbers(values: Sequence[float]) -> str:
    """Return numbers of an attribute."""
    return " ".join(f"{float(value):.12g}" for value in values)


def correct(random: Random) -> Design:
    """Return a design that stands level and drives straight ahead."""
    radius = random.uniform(0.03, 0.15)
    length = random.uniform(3.0, 6.0) * radius
    clearance = random.uniform(0.3, 1.0) * radius
    casters: tuple[float, ...]
    has_two = random.random() < 0.25
    if has_two:
        axle, casters = 0.0, (0.4 * length, -0.4 * length)
    else:
        end = random.choice((-1, 1))
        axle = end * random.uniform(0.15, 0.35) * length
        casters = (-end * random.uniform(0.3, 0.45) * length,)
    side = Side(radius, random.uniform(0.2, 0.6) * radius)
    harmless = replace(
        side,
        width=side.width * random.uniform(0.8, 1.2),
        ahead=random.choice((0.0, random.uniform(-0.1, 0.1) * length)),
    )
    return Design(
        left=harmless,
        right=side,
        track=random.uniform(2.0, 5.0) * radius,
        axle=axle,
        box=(length, random.uniform(1.2, 3.0) * radius, random.uniform(0.5, 1.5) * radius),
        clearance=clearance,
        casters=casters,
        base_height=random.choice((radius, 0.0, clearance)),
        caster_radius=clearance / 2,
        mass=random.choice((None, random.uniform(0.5, 20.0))),
        flipped=random.random() < 0.5,
        collides=random.random() < 0.5,
        footprint=random.random() < 0.5,
        mounted=random.random() < 0.3,
        lidar=random.random() < 0.5,
    )


def _one_side(change: Callable[[Design, Side, Random], Side]) -> Change:
    """Return the change of a design in which one of the wheels is changed."""

    def changed(design: Design, random: Random) -> Design:
        if random.random() < 0.5:
            return replace(design, left=change(design, design.left, random))
        return replace(design, right=change(design, design.right, random))

    return changed


def _both_sides(**values: Any) -> Change:
    return lambda design, _: replace(
        design, left=replace(design.left, **values), right=replace(design.right, **values)
    )


def _one_caster(design: Design) -> Design:
    """Return a design with a single caster, on which it stands."""
    if len(design.casters) == 1:
        return design
    length = design.box[0]
    return replace(design, casters=(0.4 * length,), axle=-0.25 * length)


def _lifted_caster(design: Design, random: Random) -> Design:
    design = _one_caster(design)
    slope = tan(radians(random.uniform(1.5, 6.0)))
    lift = slope * abs(design.casters[0] - design.axle)
    # Higher than that, the box would be on the ground before the caster.
    lift = random.choice((-1, 1)) * min(lift, 0.6 * design.clearance)
    if abs(lift) < tan(radians(1.3)) * abs(design.casters[0] - design.axle):
        lift = -tan(radians(1.5)) * abs(design.casters[0] - design.axle)
    return replace(design, caster_lift=lift)


def _caster_on_the_other_side(design: Design, _: Random) -> Design:
    design = _one_caster(design)
    side = 1 if design.axle > 0 else -1
    return replace(design, casters=(side * 0.48 * design.box[0],))


def _mass_beyond(design: Design, _: Random) -> Design:
    design = _one_caster(design)
    side = 1 if design.axle > 0 else -1
    at = (side * 0.6 * design.box[0], 0.0, design.left.radius - design.base_height)
    return replace(design, mass=5.0, mass_at=at)


def _mass_high_up(design: Design, _: Random) -> Design:
    return replace(design, mass=5.0, mass_at=(0.0, 0.0, 40.0 * design.box[0]))


def _dragging(design: Design, random: Random) -> Design:
    wheel = min(design.left.radius, design.right.radius)
    lift = random.uniform(0.1, 0.3) * wheel
    design = replace(
        design, left=replace(design.left, lift=lift), right=replace(design.right, lift=lift)
    )
    return replace(design, clearance=0.0, casters=())


# What a person does wrong, and the check that finds it.
FAULTS: dict[str, tuple[str, Change]] = {
    "caster at another height": ("stands_level", _lifted_caster),
    "caster on the other side": ("stands_level", _caster_on_the_other_side),
    "mass beyond the wheels": ("stands_level", _mass_beyond),
    "base drags": ("stands_level", _dragging),
    "one wheel higher": (
        "stands_level",
        _one_side(
            lambda design, side, random: replace(
                side, lift=tan(radians(random.uniform(1.5, 4.0))) * design.track
            )
        ),
    ),
    "one wheel reversed": (
        "drives_straight",
        _one_side(lambda _, side, __: replace(side, sense=-1)),
    ),
    "both wheels reversed": ("drives_straight", _both_sides(sense=-1)),
    "one wheel smaller": (
        "drives_straight",
        _one_side(
            lambda _, side, random: replace(side, radius=side.radius * random.uniform(0.8, 0.95))
        ),
    ),
    "one wheel points aside": (
        "drives_straight",
        _one_side(
            lambda _, side, random: replace(
                side, toe=random.choice((-1, 1)) * radians(random.uniform(6.0, 30.0))
            )
        ),
    ),
    "both wheels point aside": ("drives_straight", _both_sides(toe=radians(20.0))),
    "wheels point to each other": (
        "drives_straight",
        lambda design, _: replace(
            design,
            left=replace(design.left, toe=radians(-8.0)),
            right=replace(design.right, toe=radians(8.0)),
        ),
    ),
    "eccentric wheel": (
        "drives_straight",
        _one_side(
            lambda _, side, random: replace(
                side, eccentric=max(0.0015, side.radius * random.uniform(0.05, 0.2))
            )
        ),
    ),
    "wheel fixed": (
        "drives_straight",
        _one_side(lambda _, side, __: replace(side, joint_type="fixed")),
    ),
    "both wheels turn it to the right": ("turns_in_place", _both_sides(sense=-1)),
    "one wheel drives against the other": (
        "turns_in_place",
        _one_side(lambda _, side, __: replace(side, sense=-1)),
    ),
    "mass high up": ("does_not_tip", _mass_high_up),
}


def faulty(random: Random, name: str) -> Design:
    """Return a correct design with one fault."""
    return FAULTS[name][1](correct(random), random)
