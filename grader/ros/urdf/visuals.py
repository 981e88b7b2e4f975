"""The visuals of a link that have a size, and where a file says where links and axes are."""

from grader.base.errors import MissingElement
from grader.base.source import LazyLocation, place
from grader.base.transforms import unit
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Joint, Visual
from grader.ros.urdf.shapes import PlacedShape


def visuals(robot: Configuration, link: str) -> tuple[Visual, ...]:
    """Return the visuals of a link that have a size; raise MissingElement if there is none."""
    shown_link = robot.link(link)
    shown = tuple(visual for visual in shown_link.visuals if not visual.geometry.is_empty)
    if not shown:
        message = f"link {link!r} has no visual with a size"
        raise MissingElement("visual", link, message=message, location=place(shown_link.location))
    return shown


def placed(robot: Configuration, link: str, visual: Visual, relative_to: str) -> PlacedShape:
    """Return the shape of a visual in the frame of another link.

    Raises MissingElement where its pose is not defined.
    """
    pose = visual.origin.placed_in(robot.pose(link, relative_to=relative_to))
    return PlacedShape(visual.geometry, pose)


def origin_place(robot: Configuration, link: str) -> LazyLocation | None:
    """Return the place of the origin that puts a link into its parent's frame."""
    joint = robot.parent_joints.get(link)
    if not joint:
        return place(robot.link(link).location)
    return place(joint.origin.location if joint.origin else None, "xyz") or place(joint.location)


def axis_place(joint: Joint) -> LazyLocation | None:
    """Return the place that gives an axis its direction.

    This is the joint's rpy if the axis is z of a rotated frame.
    """
    is_z = (
        joint.axis_location is not None
        and joint.axis is not None
        and unit(joint.axis) == (0.0, 0.0, 1.0)
    )
    if is_z and joint.origin and any(joint.origin.rpy):
        return place(joint.origin.location, "rpy")
    return place(joint.axis_location, "xyz") or joint.location
