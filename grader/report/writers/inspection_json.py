"""An inspection as JSON, schema grader/inspect/v2."""

from dataclasses import replace
from functools import cache

from grader.base.extents import ended
from grader.base.transforms import Transform
from grader.report.inspection import EFFECTS, InspectedRobot, Inspection, main_root
from grader.report.json_data import (
    COUNT,
    NUMBER,
    TEXT,
    TOTAL,
    JsonObject,
    Many,
    Maybe,
    Schema,
    array,
    each,
    mapping,
    nullable,
    schema_key,
    to_json,
)
from grader.report.writers.problem_json import LOCATION, PROBLEM, problems_with_ends


def _poses(robot: InspectedRobot) -> dict[str, list[list[float]] | None]:
    """Return the poses of links as rows of numbers, rounded to 1e-12.

    Machines differ beyond that.
    """
    rows: dict[str, list[list[float]] | None] = {}
    for link, pose in robot.poses():
        rows[link] = None
        if isinstance(pose, Transform):
            rows[link] = [list(map(_rounded, row)) for row in pose.matrix]
    return rows


def _rounded(value: float) -> float:
    return round(value, 12) + 0.0  # -0.0 is 0.0


def _vector(items: Schema, length: int) -> Schema:
    return {**array(items), "minItems": length, "maxItems": length}


_JOINT = JsonObject({**each(TEXT, "name type parent child"), "axis": nullable(_vector(NUMBER, 3))})
_MODEL = JsonObject(
    {
        "name": (TEXT, "robot.name"),
        "root": (nullable(TEXT), main_root),
        "links": (array(TEXT), lambda robot: [link.name for link in robot.robot.links]),
        "joints": (Many(_JOINT), "robot.joints"),
    }
)
_ROBOT = JsonObject(
    {
        "path": TEXT,
        "verdict": {"enum": list(EFFECTS)},
        "problems": Many(PROBLEM),
        "robot": (Maybe(_MODEL), "configuration"),
        "relative_to": nullable(TEXT),
        "poses": (mapping(nullable(_vector(_vector(NUMBER, 4), 4))), _poses),
    }
)
_UNREAD_FILE = JsonObject(
    {"path": (TEXT, lambda file: file[0]), "calls": (COUNT, lambda file: file[1])}
)
_EXTENT = JsonObject(
    {
        **each(
            TOTAL,
            "packages robots launch_files nodes all_nodes unread_packages unread_robots cpp_files "
            "computed_names expressions",
        ),
        "calls": (TOTAL, "calls.known"),
        "all_calls": (TOTAL, "calls.total"),
        "unread_files": (Many(_UNREAD_FILE), "calls.unread_files"),
    }
)
_LOG_ANSWER = JsonObject(
    {
        "line": COUNT,
        **each(TEXT, "text message relation"),
        "output": (nullable(TEXT), lambda answer: answer.output or None),
        "code": (nullable(TEXT), lambda answer: answer.code or None),
        "location": Maybe(LOCATION),
    }
)
_TOPIC = JsonObject(
    {
        "name": TEXT,
        "types": (array(TEXT), lambda topic: list(topic.types)),
        "messages": (TOTAL, "count"),
        "rate": nullable(NUMBER),
        "recorder_rate": (nullable(NUMBER), lambda topic: topic.recorder_rate or topic.rate),
    }
)
_RECORDING = JsonObject({"path": TEXT, **each(array(TEXT), "facts faults"), "topics": Many(_TOPIC)})
INSPECTION = JsonObject(
    {
        **schema_key("grader/inspect/v2"),
        "path": TEXT,
        "robots": Many(_ROBOT),
        "problems": (Many(PROBLEM), "package_problems"),
        "read": (Maybe(_EXTENT), "extent"),
        "distro": (array(TEXT), lambda robot: robot.extent.stated.releases if robot.extent else ()),
        "distro_from": (
            array(TEXT),
            lambda robot: robot.extent.stated.places if robot.extent else (),
        ),
        "log": (Many(_LOG_ANSWER), lambda inspection: inspection.log or ()),
        "recordings": Many(_RECORDING),
    },
    ("log", "recordings"),
)


def inspection_json(inspection: Inspection) -> str:
    """Return the inspection as JSON. An undefined pose is null."""
    return to_json(INSPECTION.data(_with_ends(inspection)))


def _with_ends(inspection: Inspection) -> Inspection:
    """Return an inspection whose locations have their ends."""
    source_of = cache(inspection.source)  # reads each file once
    robots = []
    for robot in inspection.robots:
        problems = problems_with_ends(robot.reading.problems, source_of)
        hidden = frozenset(problems_with_ends(robot.hidden, source_of))
        reading = robot.reading._replace(problems=problems)
        robots.append(replace(robot, reading=reading, hidden=hidden))
    of_packages = problems_with_ends(inspection.package_problems, source_of)
    log = []
    for answer in inspection.log or ():
        at = answer.location
        log.append(answer if not at else answer._replace(location=ended(at, source_of)))
    return replace(
        inspection, robots=tuple(robots), package_problems=of_packages, log=tuple(log) or None
    )
