"""Checks of the meshes of a link: which file, where a build puts it, its scale and its pose. No
mesh is loaded.

`_MeshFile` is what the name of a mesh means to ROS 2, and whether a build of the submission puts
the file there.
"""

import posixpath
import re
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from typing import NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.names import closest
from grader.base.problems import Problem
from grader.base.source import LazyLocation
from grader.base.text import quoted
from grader.files.tree import File
from grader.lab.checks.check import About
from grader.lab.checks.mesh_content import content_fault
from grader.lab.checks.outcome import (
    SLACK,
    Outcome,
    failed,
    in_degrees,
    location_of,
    measured_point,
    passed,
    pending,
    place,
)
from grader.lab.checks.toml_types import NonNegative
from grader.lab.checks.visuals import file_name, shape_name, visual_pose, visuals
from grader.lab.submission.submission import Submission
from grader.ros.build.package_problems import MESH_PATH
from grader.ros.build.places import is_of_one_machine
from grader.ros.package.installed_files import Lookup, look_up, similar_file
from grader.ros.package.package import Package
from grader.ros.package.robot_file import Read
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Mesh, Visual
from grader.ros.urdf.shapes import turn_between
from grader.ros.urdf.transforms import Vector, rotation_from_rpy

ABOUT = {"shows_mesh": About(("mesh", "visual"), picture="outline")}

_ANGLE = 1.0  # degrees that a mesh may be turned
_SCHEME = re.compile(
    r"([A-Za-z][A-Za-z0-9+.-]+):(//)?(.*)", re.DOTALL
)  # one letter is a disk of Windows
_ABSOLUTE = re.compile(r"[/~\\]|[A-Za-z]:")
_ONE_MACHINE = "exists on one machine only; use package://"
_BACKSLASH = "has a \\ in its path; separate folders by /"

_MAX_WARNED = 20  # meshes of one file

_BEST_FIRST = ("passed", "pending", "failed")


class _MeshFile(NamedTuple):
    """The file name of a <mesh>: the package that it names and the path in it, and why ROS 2 does
    not find such a name.

    `doubt` says why it cannot be determined whether it does. `written` is the name as the student
    wrote it.
    """

    written: str
    path: str
    package: str = ""
    fault: str = ""
    doubt: str = ""

    @property
    def steps(self) -> tuple[str, ...]:
        """The package, the folders and the name."""
        whole = posixpath.normpath(f"{self.package}/{self.path}".replace("\\", "/"))
        return tuple(step for step in whole.split("/") if step)

    def ends_in(self, other: "_MeshFile", *, any_case: bool = False) -> bool:
        """Return whether the path ends in all the steps of another one."""
        steps, end = self.steps, other.steps
        if any_case:
            steps, end = (tuple(map(str.casefold, path)) for path in (steps, end))
        return steps[-len(end) :] == end != ()


class _ShownMesh(NamedTuple):
    """A visual that shows a mesh, and what the name of its file means."""

    link: str
    visual: Visual
    mesh: Mesh
    file: _MeshFile


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
        message, at = (
            f"{link!r} shows {shape_name(shown[0].geometry)}; it should show a mesh",
            shown[0].geometry.location,
        )
        raise MissingElement("mesh", link, message=message, location=place(at))
    named = [it for it in meshes if it.file.ends_in(mesh_file(file))]
    if not named:
        return _another_file(meshes, file)
    wanted = _Pose(relative_to or link, scale, xyz, rpy, tolerance)
    outcomes = [_examine_mesh(robot, submission, it, wanted) for it in named]
    best = min(outcomes, key=lambda outcome: _BEST_FIRST.index(outcome.status))
    if best.status == "failed":
        return best
    return _broken_collision(robot, submission, link) or best


def _broken_collision(robot: Configuration, submission: Submission, link: str) -> Outcome | None:
    """Return the failure of a link with a collision mesh whose file is certainly broken."""
    is_expanded = isinstance(submission.urdf, Read) and submission.urdf.is_expanded
    for shape in (it.geometry for it in robot.link(link).collisions):
        if isinstance(shape, Mesh):
            mesh = mesh_file(shape.filename, is_expanded=is_expanded)
            with suppress(NotDecided):
                file = _file_of(mesh, submission)
                fault = content_fault(file, mesh.path) if file is not None else ""
                if fault:
                    message = f"the collision mesh {file_name(mesh.written)} of {link!r} {fault}"
                    return failed(message, place(shape.location, "filename"))
    return None


def _another_file(meshes: Sequence[_ShownMesh], file: str) -> Outcome:
    """Return the failure of a link that shows other meshes only."""
    wanted = mesh_file(file)
    alike = [it for it in meshes if it.file.ends_in(wanted, any_case=True)]
    it = (alike or meshes)[0]
    reason = "; upper and lower case differ" if alike else ""
    message = f"{it.link!r} shows the mesh {file_name(it.file.written)}"
    return failed(
        f"{message}; its path should end in {quoted(file)}{reason}",
        place(it.mesh.location, "filename"),
    )


def _examine_mesh(
    robot: Configuration, submission: Submission, it: _ShownMesh, wanted: _Pose
) -> Outcome:
    """Return the outcome for one mesh of the right name."""
    name, fault, doubt, cause = (
        file_name(it.file.written),
        it.file.fault,
        it.file.doubt,
        it.file.doubt,
    )
    try:
        fault = fault or _why_not_found(it.file, submission)
    except NotDecided as reason:
        doubt, cause = str(reason), reason.cause
    if fault:
        wrong = [(f"the mesh of {it.link!r} {fault}", place(it.mesh.location, "filename"))]
    else:
        wrong = []
    wrong += _pose_differences(robot, it, wanted)
    if wrong:
        problem = _problem_text(it.link, it.file, fault) if fault else ""
        return failed(
            "; ".join(text for text, _ in wrong),
            wrong[0][1],
            detail=f" (mesh {name})",
            problem=problem,
        )
    if doubt:
        text = (
            f"whether ROS 2 finds the mesh {name} of {it.link!r} cannot be determined: {doubt}; "
            "needs manual grading"
        )
        return pending(text, cause)
    return passed(f"{it.link!r} shows the mesh {name}")


def _pose_differences(
    robot: Configuration, it: _ShownMesh, wanted: _Pose
) -> Iterator[tuple[str, LazyLocation | None]]:
    """Yield what is wrong with the scale and the pose of a mesh, and where."""
    scale = it.mesh.scale
    if wanted.scale is not None and not all(
        map(_is_scaled, scale, wanted.scale, [wanted.tolerance] * 3)
    ):
        yield (
            f"its scale is {_scale_text(scale)}; it should be {_scale_text(wanted.scale)}",
            place(it.mesh.location, "scale"),
        )
    if wanted.xyz is None and wanted.rpy is None:
        return
    pose = visual_pose(robot, it.link, it.visual, wanted.frame)
    origin = it.visual.origin.location
    if wanted.xyz is not None:
        what = f"the mesh of {it.link!r}"
        placed = measured_point(what, pose.translation, wanted.xyz, wanted.tolerance, wanted.frame)
        if placed.status == "failed":
            yield placed.message, place(origin, "xyz") or place(it.visual.location)
    if wanted.rpy is not None:
        angle = turn_between(pose.rotation, rotation_from_rpy(wanted.rpy))
        if not angle <= _ANGLE + SLACK:
            yield (
                f"its orientation is {in_degrees(angle)} off",
                place(origin, "rpy") or place(it.visual.location),
            )


def _is_scaled(actual: float, expected: float, tolerance: float) -> bool:
    return abs(actual - expected) <= (tolerance + SLACK) * abs(expected)


def _scale_text(scale: Vector) -> str:
    return " ".join(f"{value:.6g}" for value in scale)


def mesh_file(filename: str, *, is_expanded: bool = False) -> _MeshFile:
    """Return what the file name of a <mesh> means; `is_expanded` says whether xacro has been
    expanded in it.
    """
    found = _SCHEME.fullmatch(filename)
    scheme, slashes, rest = found.groups() if found is not None else ("", "", filename)
    fault = _BACKSLASH if "\\" in filename else ""
    shared = _path_from_xacro(rest) if is_expanded and scheme in ("", "file") else None
    if shared is not None:
        written = f"{scheme}{'://' if scheme else ''}$(find {shared[0]})/{shared[1]}"
        return _MeshFile(
            written, shared[1], shared[0], fault if scheme else "needs file:// before $(find ...)"
        )
    if scheme == "package" and slashes:
        package, _, path = rest.partition("/")
        return _MeshFile(filename, path, package, fault)
    doubt = ""
    if not scheme:
        is_absolute = _ABSOLUTE.match(filename) is not None
        fault = f"is at an absolute path, which {_ONE_MACHINE}" if is_absolute else fault
    elif scheme == "file":
        fault = f"is at a file:// path, which {_ONE_MACHINE}"
    elif scheme.lower() in ("package", "file") or not slashes:
        fault = f"begins with {scheme}:{slashes or ''}; use package://"
    else:
        fault, doubt = "", f"it is at a {scheme}:// path, which not every program finds"
    return _MeshFile(filename, rest, "", fault, doubt)


def mesh_problems(submission: Submission, urdf: Read) -> Iterator[Problem]:
    """Yield a warning for each mesh that RViz certainly does not find on another machine, or after
    a build.

    A file of a package that was not submitted may be installed, and so may a file:// path outside
    of home folders.
    """
    links = urdf.loaded.robot.links if urdf.loaded.robot is not None else ()
    shapes = [(link, visual.geometry) for link in links for visual in link.visuals]
    shapes += [(link, collision.geometry) for link in links for collision in link.collisions]
    found = {shape.filename: (link, shape) for link, shape in shapes if isinstance(shape, Mesh)}
    for name, (link, mesh) in islice(found.items(), _MAX_WARNED):
        file = mesh_file(name, is_expanded=urdf.is_expanded)
        at = location_of(place(mesh.location, "filename"))
        fault = _sure_fault(file, submission)
        if fault and at is not None and "$" not in name:
            yield Problem(MESH_PATH, _problem_text(link.name, file, fault), at)


def _problem_text(link: str, file: _MeshFile, fault: str) -> str:
    return f"the mesh {file_name(file.written)} of {quoted(link)} {fault}"


def _sure_fault(file: _MeshFile, submission: Submission) -> str:
    """Return why RViz does not find a mesh, if that is certain."""
    if file.written.startswith("file://") and not file.package and not is_of_one_machine(file.path):
        return ""
    if not (file.package or file.fault or file.doubt):
        return "is at a relative path, which RViz does not find; use package://"
    if file.fault or not any(package.name == file.package for package in submission.packages):
        return file.fault
    try:
        return _why_not_found(file, submission)
    except NotDecided:
        return ""


def _why_not_found(mesh: _MeshFile, submission: Submission) -> str:
    """Return why ROS 2 does not find a package's file after a build; empty if it does, or no
    package was submitted.

    Raises NotDecided where that cannot be determined statically.
    """
    if not submission.packages:
        return ""
    if not mesh.package:
        if not mesh.doubt:
            raise NotDecided(
                "RViz finds no relative path; other programs may", "a mesh is at a relative path"
            )
        return ""
    package = submission.packages[0].find(mesh.package)
    path = posixpath.normpath(mesh.path)
    if package is None:
        return _without_package(mesh.package, path, submission)
    if path.startswith("../") or path in ("..", "."):
        return "is outside of its package"
    return _fault_in_package(package, f"share/{mesh.package}/{path}", submission)


def _fault_in_package(package: Package, target: str, submission: Submission) -> str:
    """Return what is wrong with the file that a build installs at a path, or why it installs none
    there.
    """
    found, name = look_up(package, target), posixpath.basename(target)
    file = package.tree.files.get(found.path) if found.state == "installed" else None
    if file is not None:
        return content_fault(file, target)
    if found.state == "unknown" or any(
        posixpath.basename(path) == name for path in package.tree.files
    ):
        return _why_not_installed(package, target, found)
    if submission.tree.unopened:
        raise NotDecided(
            f"{name} may be in an archive that could not be opened",
            "an archive could not be opened",
        )
    similar = similar_file(package, name)
    return (
        "is not in the package "
        f"{package.name!r}{f'; there is {quoted(similar)}' if similar else ''}"
    )


def _file_of(mesh: _MeshFile, submission: Submission) -> File | None:
    """Return the file of a submitted package that a mesh names."""
    package = submission.packages[0].find(mesh.package) if submission.packages else None
    if package is None:
        return None
    path = posixpath.normpath(mesh.path)
    found = look_up(package, f"share/{mesh.package}/{path}")
    return package.tree.files.get(found.path if found.state == "installed" else path)


def _path_from_xacro(path: str) -> tuple[str, str] | None:
    """Return the package and the path in it where $(find ...) has given a path."""
    from grader.ros.xacro.texts import INSTALLED  # late: most URDFs are no xacro

    found = re.fullmatch(rf"/*{INSTALLED}/([^/]+)/share/\1/+(.*)", path, re.DOTALL)
    if found is not None:
        return (found[1], found[2])
    return None


def _without_package(name: str, path: str, submission: Submission) -> str:
    """Return that no submitted package has a name; raise NotDecided if one may be in an archive
    that is closed.
    """
    if submission.tree.unopened:
        reason = "an archive could not be opened"
        raise NotDecided(
            f"the package {quoted(name)} may be in an archive that could not be opened", reason
        )
    holding = [package.name for package in submission.packages if path in package.tree.files]
    meant = closest(name, [package.name for package in submission.packages]) or next(
        iter(holding), None
    )
    if meant is not None:
        hint = f"; the submission has {quoted(meant)}"
    else:
        hint = ", which is not part of the submission"
    return f"names the package {quoted(name)}{hint}"


def _why_not_installed(package: Package, target: str, found: Lookup) -> str:
    """Return why a build does not install a file of a package at a path, by what it has instead."""
    setup = package.installation
    if found.state == "unknown":
        raise NotDecided(found.text, found.text)
    if found.state == "elsewhere":
        return f"is looked for at {target}, but {found.text}"
    if setup is None or found.state == "no build":
        return f"is not installed: {found.text}"
    return f"is not installed: add {found.path} to {setup.entries}, for {posixpath.dirname(target)}"
