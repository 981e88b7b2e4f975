"""Checks of the meshes of a link: which file, where a build puts it, its scale and its pose.

No mesh is loaded.
"""

from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.quantities import SLACK, in_degrees
from grader.base.source import LazyLocation, place
from grader.base.text import quoted, quoted_end
from grader.base.toml_types import NonNegative
from grader.base.transforms import Vector, rotation_from_rpy, turn_between
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, measured_point, passed, pending
from grader.lab.checks.visuals import shape_name
from grader.lab.submission.submission import Submission
from grader.ros.package.mesh_files import MeshFile, mesh_file
from grader.ros.package.robot_file import Read
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Mesh, Visual
from grader.ros.urdf.visuals import placed, visuals

ABOUT = {"shows_mesh": About(("mesh", "visual"), picture="outline")}

_ANGLE = 1.0  # degrees that a mesh may be turned


class _ShownMesh(NamedTuple):
    """A visual that shows a mesh, and what the name of its file means."""

    link: str
    visual: Visual
    mesh: Mesh
    file: MeshFile


class _Pose(NamedTuple):
    """The scale and the pose that a mesh should have in a frame; None where any will do."""

    frame: str
    scale: Vector | None
    xyz: Vector | None
    rpy: Vector | None
    tolerance: float


def shows_mesh(
    robot: Configuration,
    submission: Submission,
    *,
    link: str,
    file: str,
    scale: Vector | None = None,
    xyz: Vector | None = None,
    rpy: Vector | None = None,
    tolerance: NonNegative = 0.002,
    relative_to: str = "",
) -> Outcome:
    """A link shows a mesh file, which ROS 2 finds on every machine.

    Any visual of the link may be the mesh. Absolute and `file://` paths fail. The file of a
    `package://` path must be in the submission where a build of its package installs it, if a
    package was submitted; then a relative path needs manual grading. `file://$(find my_robot)` in
    xacro means the same as `package://my_robot`. A file that is empty or not of the format of its
    ending fails, also one of a collision mesh of the link.

    Args:
        link: The link that is examined.
        file: The end of the mesh's path: complete folder names and the file name; case-sensitive.
        scale: The scale along x, y and z.
        xyz: Where the origin of the mesh is, in metres.
        rpy: The rotation of the mesh, in radians about fixed axes, within 1 degree.
        tolerance: How far each coordinate may be off, in metres, and each scale, as a share of
            itself.
        relative_to: The link in whose frame the pose is, by default the link itself.
    """
    shown = visuals(robot, link)
    is_expanded = isinstance(submission.urdf, Read) and submission.urdf.is_expanded
    meshes = [
        _ShownMesh(
            link,
            visual,
            visual.geometry,
            mesh_file(visual.geometry.filename, is_expanded=is_expanded),
        )
        for visual in shown
        if isinstance(visual.geometry, Mesh)
    ]
    if not meshes:
        message = f"{link!r} shows {shape_name(shown[0].geometry)}; it should show a mesh"
        at = shown[0].geometry.location
        raise MissingElement("mesh", link, message=message, location=place(at))
    named = [mesh for mesh in meshes if mesh.file.ends_in(mesh_file(file))]
    if not named:
        return _another_file(meshes, file)
    wanted = _Pose(relative_to or link, scale, xyz, rpy, tolerance)
    outcomes = [_examine_mesh(robot, submission, mesh, wanted) for mesh in named]
    best = min(outcomes, key=lambda outcome: ("passed", "pending", "failed").index(outcome.status))
    if best.status == "failed":
        return best
    return _broken_collision(robot, submission, link) or best


def _broken_collision(robot: Configuration, submission: Submission, link: str) -> Outcome | None:
    """Return the failure of a link with a collision mesh whose file is certainly broken."""
    is_expanded = isinstance(submission.urdf, Read) and submission.urdf.is_expanded
    for shape in (collision.geometry for collision in robot.link(link).collisions):
        if isinstance(shape, Mesh):
            mesh = mesh_file(shape.filename, is_expanded=is_expanded)
            with suppress(NotDecided):
                fault = mesh.content_fault(submission.packages)
                if fault:
                    message = f"the collision mesh {quoted_end(mesh.written)} of {link!r} {fault}"
                    return failed(message, place(shape.location, "filename"))
    return None


def _another_file(meshes: Sequence[_ShownMesh], file: str) -> Outcome:
    """Return the failure of a link that shows other meshes only."""
    wanted = mesh_file(file)
    alike = [mesh for mesh in meshes if mesh.file.ends_in(wanted, any_case=True)]
    nearest = (alike or meshes)[0]
    reason = "; upper and lower case differ" if alike else ""
    message = f"{nearest.link!r} shows the mesh {quoted_end(nearest.file.written)}"
    return failed(
        f"{message}; its path should end in {quoted(file)}{reason}",
        place(nearest.mesh.location, "filename"),
    )


def _examine_mesh(
    robot: Configuration, submission: Submission, shown: _ShownMesh, wanted: _Pose
) -> Outcome:
    """Return the outcome for one mesh of the right name."""
    name = quoted_end(shown.file.written)
    fault = shown.file.fault
    doubt = shown.file.doubt
    cause = shown.file.doubt
    try:
        fault = fault or shown.file.why_not_found(submission.packages, submission.tree)
    except NotDecided as reason:
        doubt = str(reason)
        cause = reason.cause
    if fault:
        wrong = [(f"the mesh of {shown.link!r} {fault}", place(shown.mesh.location, "filename"))]
    else:
        wrong = []
    wrong += _pose_differences(robot, shown, wanted)
    if wrong:
        problem = shown.file.problem_text(shown.link, fault) if fault else ""
        return failed(
            "; ".join(text for text, _ in wrong),
            wrong[0][1],
            detail=f" (mesh {name})",
            problem=problem,
        )
    if doubt:
        text = (
            f"whether ROS 2 finds the mesh {name} of {shown.link!r} cannot be determined: {doubt}; "
            "needs manual grading"
        )
        return pending(text, cause)
    return passed(f"{shown.link!r} shows the mesh {name}")


def _pose_differences(
    robot: Configuration, shown: _ShownMesh, wanted: _Pose
) -> Iterator[tuple[str, LazyLocation | None]]:
    """Yield what is wrong with the scale and the pose of a mesh, and where."""
    scale = shown.mesh.scale
    if wanted.scale is not None and not all(
        map(_is_scaled, scale, wanted.scale, [wanted.tolerance] * 3)
    ):
        yield (
            f"its scale is {_scale_text(scale)}; it should be {_scale_text(wanted.scale)}",
            place(shown.mesh.location, "scale"),
        )
    if wanted.xyz is None and wanted.rpy is None:
        return
    pose = placed(robot, shown.link, shown.visual, wanted.frame).pose
    origin = shown.visual.origin.location
    if wanted.xyz is not None:
        what = f"the mesh of {shown.link!r}"
        outcome = measured_point(what, pose.translation, wanted.xyz, wanted.tolerance, wanted.frame)
        if outcome.status == "failed":
            yield outcome.message, place(origin, "xyz") or place(shown.visual.location)
    if wanted.rpy is not None:
        angle = turn_between(pose.rotation, rotation_from_rpy(wanted.rpy))
        if not angle <= _ANGLE + SLACK:
            yield (
                f"its orientation is {in_degrees(angle)} off",
                place(origin, "rpy") or place(shown.visual.location),
            )


def _is_scaled(actual: float, expected: float, tolerance: float) -> bool:
    return abs(actual - expected) <= (tolerance + SLACK) * abs(expected)


def _scale_text(scale: Vector) -> str:
    return " ".join(f"{value:.6g}" for value in scale)
