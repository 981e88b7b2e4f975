"""The public API of `ros`: what reads one file, one robot or one package.

The checks, hints and rubric tools, which take robots and packages apart, use more. All other
names may move at any time. What is at a path, and what runs together, is asked of
`grader.workspace.api`.

**Read.** `read_urdf` reads one URDF. Nothing is run or imported, and no text raises: a URDF that
ROS 2 rejects is a `Reading` with the verdict `rejected`. Files are read as the programs of ROS 2
read them, by default those of Jazzy: a URDF as urdfdom on TinyXML2, xacro as xacro, a package as
colcon, ament and launch.

**Ask.** A `Robot` has values, and a `Configuration` has poses. Lengths and sizes are metres, angles
are radians about fixed axes x, y, z (REP 103), masses are kilograms. A vector is three floats, and
a pose is a `Transform`: `T_a_b` maps points of frame b to frame a. What a file lacks raises
MissingElement, which names what exists; what cannot be determined statically raises NotDecided; a
shape whose size is not known raises UnknownShape.

**Show.** Every element and `Problem` has its place: path, line and column from 1. The `fixes` of a
problem are computed when they are iterated over.

A name is imported with its module when it is first asked for: most commands need few of them.

>>> from grader.ros.api import Configuration, read_urdf
>>> robot = read_urdf('<robot name="r"><link name="base"/></robot>').robot
>>> Configuration(robot).pose("base").translation
(0.0, 0.0, 0.0)
"""
# ruff: noqa: PLC0414  mypy takes a name that is imported `as` itself for one of this module

from typing import TYPE_CHECKING

from grader.base.late_names import late_names

if TYPE_CHECKING:
    from grader.ros.known.known_tables import releases_explanation as releases_explanation
    from grader.ros.known.parameter_texts import parameter_explanation as parameter_explanation
    from grader.ros.known.releases import Release as Release
    from grader.ros.known.releases import StatedReleases as StatedReleases
    from grader.ros.nodes.node_facts import EndpointKind as EndpointKind
    from grader.ros.nodes.node_facts import Qos as Qos
    from grader.ros.nodes.python.package_slips import package_slips as package_slips
    from grader.ros.package.mesh_loading import MeshLoader as MeshLoader
    from grader.ros.package.package import MANIFEST as MANIFEST
    from grader.ros.package.package import SETUP as SETUP
    from grader.ros.package.package import Package as Package
    from grader.ros.package.robot_file import Absent as Absent
    from grader.ros.package.robot_file import Read as Read
    from grader.ros.package.robot_file import Unreadable as Unreadable
    from grader.ros.package.robot_readings import RobotReadings as RobotReadings
    from grader.ros.package.robot_readings import read_edited as read_edited
    from grader.ros.package.robots import is_robot as is_robot
    from grader.ros.recording.cdr import Message as Message
    from grader.ros.recording.cdr import MessageDecoder as MessageDecoder
    from grader.ros.recording.database import write_database as write_database
    from grader.ros.recording.motion import read_track as read_track
    from grader.ros.recording.recorded import Channel as Channel
    from grader.ros.recording.recorded_robot import FrameComparison as FrameComparison
    from grader.ros.recording.recorded_robot import WheelTravel as WheelTravel
    from grader.ros.recording.recorded_robot import measure_travel as measure_travel
    from grader.ros.recording.recorded_robot import missing_position as missing_position
    from grader.ros.recording.recorded_robot import read_description as read_description
    from grader.ros.recording.recorded_topics import RecordedTopic as RecordedTopic
    from grader.ros.recording.recorded_topics import find_pose as find_pose
    from grader.ros.recording.recording import TRANSFORMS as TRANSFORMS
    from grader.ros.recording.recording import Recording as Recording
    from grader.ros.recording.recording_files import MAX_RECORDINGS as MAX_RECORDINGS
    from grader.ros.recording.recording_files import RecordingFiles as RecordingFiles
    from grader.ros.recording.recording_files import find_recordings as find_recordings
    from grader.ros.recording.recording_files import (
        read_longest_recording as read_longest_recording,
    )
    from grader.ros.recording.recording_files import read_recording as read_recording
    from grader.ros.urdf.driving import Drive as Drive
    from grader.ros.urdf.driving import describe_driving as describe_driving
    from grader.ros.urdf.driving import plan_drive as plan_drive
    from grader.ros.urdf.kinematics import Configuration as Configuration
    from grader.ros.urdf.model import Box as Box
    from grader.ros.urdf.model import Capsule as Capsule
    from grader.ros.urdf.model import Cylinder as Cylinder
    from grader.ros.urdf.model import Joint as Joint
    from grader.ros.urdf.model import Link as Link
    from grader.ros.urdf.model import Mesh as Mesh
    from grader.ros.urdf.model import Origin as Origin
    from grader.ros.urdf.model import Robot as Robot
    from grader.ros.urdf.model import Sphere as Sphere
    from grader.ros.urdf.model import Visual as Visual
    from grader.ros.urdf.normal_form import robot_hash as robot_hash
    from grader.ros.urdf.normal_form import written_form as written_form
    from grader.ros.urdf.reader import Reading as Reading
    from grader.ros.urdf.reader import read_urdf as read_urdf
    from grader.ros.urdf.shapes import Shape as Shape
    from grader.ros.urdf.shapes import UnknownShape as UnknownShape
    from grader.ros.urdf.wheel_travel import find_travel as find_travel
    from grader.ros.urdf.wheel_travel import turning_joint as turning_joint
    from grader.ros.xml.xml_problems import RECOVERED as RECOVERED
else:
    _NAMES = {
        "known.known_tables": "releases_explanation",
        "known.parameter_texts": "parameter_explanation",
        "known.releases": "Release StatedReleases",
        "nodes.node_facts": "EndpointKind Qos",
        "nodes.python.package_slips": "package_slips",
        "package.mesh_loading": "MeshLoader",
        "package.package": "MANIFEST SETUP Package",
        "package.robot_file": "Absent Read Unreadable",
        "package.robot_readings": "RobotReadings read_edited",
        "package.robots": "is_robot",
        "recording.cdr": "Message MessageDecoder",
        "recording.database": "write_database",
        "recording.motion": "read_track",
        "recording.recorded": "Channel",
        "recording.recorded_robot": "FrameComparison WheelTravel measure_travel missing_position "
        "read_description",
        "recording.recorded_topics": "RecordedTopic find_pose",
        "recording.recording": "TRANSFORMS Recording",
        "recording.recording_files": "MAX_RECORDINGS RecordingFiles find_recordings "
        "read_longest_recording read_recording",
        "urdf.driving": "Drive describe_driving plan_drive",
        "urdf.kinematics": "Configuration",
        "urdf.model": "Box Capsule Cylinder Joint Link Mesh Origin Robot Sphere Visual",
        "urdf.normal_form": "robot_hash written_form",
        "urdf.reader": "Reading read_urdf",
        "urdf.shapes": "Shape UnknownShape",
        "urdf.wheel_travel": "find_travel turning_joint",
        "xml.xml_problems": "RECOVERED",
    }
    __getattr__ = late_names(__name__, _NAMES)
