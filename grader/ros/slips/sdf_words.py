"""The words of SDFormat in <gazebo> that are written otherwise.

The children of a <plugin> are its own.
"""

from collections.abc import Collection

from grader.base.element_edits import renamed_attribute, renamed_tag
from grader.base.names import folded
from grader.base.slips import Slips, make_slip
from grader.ros.slips.nodes import find_place
from grader.ros.xacro.xacro_nodes import XacroNode, walk

# Elements of a sensor, from sdformat's sdf/1.9: sensor.sdf, camera.sdf, imu.sdf, lidar.sdf,
# noise.sdf.
_TEXT = """
sensor plugin pose topic update_rate always_on visualize enable_metrics camera depth_camera
lidar ray imu gps navsat contact force_torque magnetometer altimeter air_pressure scan
horizontal vertical samples resolution min_angle max_angle range min max noise type mean stddev
bias_mean bias_stddev precision horizontal_fov image width height format clip near far save
path distortion k1 k2 k3 p1 p2 center lens intrinsics fx fy cx cy s angular_velocity
linear_acceleration orientation_reference_frame localization x y z enable_orientation collision
frame measure_direction optical_frame_id gz_frame_id ignition_frame_id camera_info_topic
trigger_topic triggered visibility_mask
"""
_WORDS = frozenset(_TEXT.split())
_BY_LETTERS = {folded(word): word for word in _WORDS}


def gazebo_slips(root: XacroNode, named: Collection[str]) -> Slips:
    """Yield the tags in <gazebo> that differ from those of a sensor in their case or a separator.

    Also yield the attribute of <gazebo> that has the name of a link; `named` are all names in the
    files.
    """
    for gazebo in walk(root):
        if gazebo.tag != "gazebo":
            continue
        yield from _reference_slips(gazebo, named)
        waiting = list(reversed(gazebo.elements))
        while waiting:
            node = waiting.pop()
            meant = _BY_LETTERS.get(folded(node.tag))
            is_of_sensor = node not in gazebo.elements or meant == "sensor"
            if meant not in (None, node.tag) and is_of_sensor and node.tag not in _WORDS:
                source, start = find_place(node)
                edits = renamed_tag(source, start, meant or "")
                reaction = f"Gazebo does not know <{node.tag}>"
                assumption = f"<{node.tag}> is read as <{meant}>"
                yield make_slip(edits, reaction, assumption)
            if meant == "sensor":
                yield from _attribute_slips(node)
            if (meant or node.tag) != "plugin":
                waiting += reversed(node.elements)


def _reference_slips(gazebo: XacroNode, named: Collection[str]) -> Slips:
    """Yield the one attribute of <gazebo> that has the name of a link."""
    given = gazebo.attributes
    if len(given) != 1 or "reference" in given:
        return
    [(name, value)] = given.items()
    if value in named or "$" in value:
        source, start = find_place(gazebo)
        edits = renamed_attribute(source, start, name, "reference")
        reaction = f"Gazebo does not know the attribute {name} of <gazebo>"
        assumption = f"the attribute {name} of <gazebo> is read as reference"
        yield make_slip(edits, reaction, assumption)


def _attribute_slips(sensor: XacroNode) -> Slips:
    """Yield the attributes of a sensor that differ from its own in their case."""
    for name in sensor.attributes:
        meant = name.lower()
        if meant != name and meant in ("name", "type") and meant not in sensor.attributes:
            source, start = find_place(sensor)
            edits = renamed_attribute(source, start, name, meant)
            reaction = f"Gazebo does not know the attribute {name} of <{sensor.tag}>"
            assumption = f"the attribute {name} of <{sensor.tag}> is read as {meant}"
            yield make_slip(edits, reaction, assumption)
