"""What a page of `grader view` has besides that of a report or an inspection.

The list of robots, the arguments of xacro, what breaks the file, and the triangles of meshes.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

from grader.report.drawing.mesh_data import MeshStore
from grader.report.drawing.picture import Picture
from grader.report.locations import SourceLine
from grader.ros.api import Mesh

if TYPE_CHECKING:
    from grader.report.drawing.playback import Playback
    from grader.ros.api import MeshLoader

SCRIPT = "playback.js view.js"
STYLES = "view.css"
GRAPH_SCRIPT = "graph_view.js"
SOURCES = "img-src data:; connect-src 'self'"


class RobotLink(NamedTuple):
    """A robot, or a launch file, in the list of a page."""

    address: str
    path: str
    is_shown: bool  # on this page


class GraphViewing(NamedTuple):
    """What a page of a graph has in `grader view`."""

    number: int  # of the version that is shown
    address: str  # of the page
    robots: Sequence[RobotLink]
    launches: Sequence[RobotLink]


class ArgumentField(NamedTuple):
    """An argument of xacro that can be tried on a page."""

    name: str
    default: str  # as it is written
    value: str | None  # None if it is known only at run time


class LogCard(NamedTuple):
    """What is said of a message of a log on a page; `is_explained` if the files explain it."""

    text: str
    is_explained: bool
    source: Sequence[SourceLine] = ()


class ProblemCard(NamedTuple):
    """A problem on a page."""

    severity: str
    text: str
    source: Sequence[SourceLine] = ()


@dataclass(frozen=True, slots=True)
class Viewing:
    """What a page of `grader view` has besides the page of a report or an inspection."""

    number: int  # of the version that is shown
    address: str  # of the page
    robots: Sequence[RobotLink]
    arguments: Sequence[ArgumentField]
    notes: Sequence[str]
    is_broken: bool  # whether ROS 2 does not load the robot as the files are now
    # What is wrong with the files now, if the page shows an earlier version.
    broken: Sequence[ProblemCard]
    store: MeshStore
    meshes: "MeshLoader | None"  # of the robot
    log: Sequence[LogCard] | None = None  # what is said of a log; None without one
    graph: str = ""  # the address of the page of the graph; empty without launch files
    playback: "Playback | None" = None  # the recording that moves the robot

    @property
    def data(self) -> dict[str, Any]:
        """What the script of the page reads."""
        return {
            "number": self.number,
            "address": self.address,
            "isBroken": self.is_broken,
            "isStale": bool(self.broken),
        }

    def with_meshes(self, picture: Picture) -> tuple[Picture, Mapping[Mesh, str]]:
        """Return a picture that says how meshes are shown, and addresses of triangles.

        Meshes may be shown as boxes, or with fewer triangles. The addresses are those of
        the triangles of the others.
        """
        scene = picture.scene
        if not self.meshes or not scene.boxed:
            return picture, {}
        addresses, sentences = self.store.pack(scene, self.meshes)
        boxed: dict[str, None] = {}
        for body in scene.bodies:
            if body.mesh and body.mesh not in addresses:
                boxed[body.link] = None
        missing = (*scene.missing, *sentences)
        scene = replace(scene, missing=missing, boxed=tuple(boxed))
        return replace(picture, scene=scene), addresses
