"""Harnesses of robot descriptions: URDF, TinyXML2's XML, its repairs, xacro and its expressions."""

from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from itertools import islice
from typing import Any
from zlib import crc32

from lxml import etree

from grader.base.element_edits import edited
from grader.base.errors import MissingElement, NotDecided
from grader.base.source import Source
from grader.report.formats import Format, InspectFormat, render_inspection
from grader.report.inspection import InspectedRobot, Inspection, main_root
from grader.report.screen import Screen
from grader.ros.python.budget import Budget, OutOfBudget
from grader.ros.python.expressions import evaluate
from grader.ros.python.values import EvaluationFails, Undetermined
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.reader import Reading, read_urdf
from grader.ros.xacro.functions import GLOBALS, namespace, read_yaml_values
from grader.ros.xacro.rewriting import ExpandedEdits
from grader.ros.xml.repair import repair
from grader.ros.xml.tinyxml2 import scan
from tests.fuzz.harness import check_location, check_message, decoded, files_of
from tests.report.harmless import is_harmless
from tests.xacro.comparing import expand
from tests.xacro.documents.document import PATH, Document
from tests.xml.test_tinyxml2 import assert_alike_if_plain, assert_sound

_NAMES: Mapping[str, Any] = {
    **GLOBALS,
    "a": 1,
    "b": 2.5,
    "c": "text",
    "d": [1, 2.5, "x"],
    "e": {"k": 1, "l": {"m": "n"}},
    "f": True,
    "g": -3,
}
_WORK = 100_000  # parts of the budget that one input may use
_MAX_WAYS = 6
_SCREEN = Screen(width=80)


def urdf(data: bytes) -> None:
    """Any bytes are read; problems have places in the file, and poses are numbers or say why there is none."""
    reading = read_urdf(data, "a.urdf")
    check_reading(reading)
    if reading.robot is not None:
        robot = Configuration(reading.robot)
        for link in reading.robot.links:
            with suppress(MissingElement, NotDecided):
                assert all(
                    abs(turned) <= 1.001 for turned in robot.pose(link.name).rotate((0.6, 0.8, 0.0))
                )


def check_reading(reading: Reading) -> None:
    """Assert what holds of every URDF that was read: a verdict that its problems explain, each with its place."""
    effects = {problem.kind.effect for problem in reading.problems}
    assert (reading.verdict == "rejected") == bool(effects & {"rejects", "undetermined"})
    assert (reading.verdict == "degraded") == (reading.verdict != "rejected" and "drops" in effects)
    for problem in reading.problems:
        check_message(problem.message)
        check_location(problem.location, {reading.source.path: reading.source.text})


def inspection(data: bytes) -> None:
    """What is read of any bytes is shown in each format, and as text."""
    reading = read_urdf(data, "a.urdf")
    robot = Configuration(reading.robot) if reading.robot is not None else None
    inspected = InspectedRobot("a.urdf", reading, robot, main_root(robot) if robot else None)
    shown = Inspection("a.urdf", (inspected,))
    for kind in InspectFormat:
        is_harmless(
            render_inspection(shown, kind, _SCREEN),
            Format.GITHUB if kind is InspectFormat.GITHUB else None,
        )


def tinyxml2(data: bytes) -> None:
    """Any bytes are translated into XML with its offsets, or refused; plain ones mean the same to lxml."""
    text = decoded(data)
    assert_sound(scan(text), text)
    assert_alike_if_plain(data)


def syntax(data: bytes) -> None:
    """The changes with which a broken text is what is read of it fit the text, and none touches another one."""
    source = Source("a.urdf", decoded(data))
    repaired = repair(source.text)
    edits = tuple(source.edit(*change) for change in repaired.changes)
    assert edited(source.text, source.path, edits) is not None


def xacro(data: bytes) -> None:
    """A document with its files is expanded; places are in the files, and rewritings fit them."""
    files = files_of(data) or {PATH: data}
    texts = {path: decoded(content) for path, content in files.items()}
    document = Document(texts.setdefault(PATH, ""), files)
    found = expand(document, limit=_WORK)
    for problem in found.document.problems:
        check_message(problem.message)
        check_location(problem.location, texts)
    if found.root is None or found.undetermined:
        return
    etree.tostring(found.root)
    for index, element in islice(enumerate(found.root.iter()), crc32(data) % 7, _MAX_WAYS):
        for name in islice(element.keys(), 2):
            ways = ExpandedEdits(found.source).rewrites(
                name, {index: (element.get(name), "0.5 0.25")}
            )
            for way in islice(ways, _MAX_WAYS):
                for path in {edit.path for edit in way}:
                    assert (
                        edited(texts[path], path, [edit for edit in way if edit.path == path])
                        is not None
                    ), way
    for correction in islice(ExpandedEdits(found.source).corrections(("base_link",)), _MAX_WAYS):
        for path in {edit.path for edit in correction.edits}:
            assert (
                edited(texts[path], path, [edit for edit in correction.edits if edit.path == path])
                is not None
            )


def expressions(data: bytes) -> None:
    """An expression has a plain value of bounded size, or the reason why it has none."""
    budget = Budget(_WORK)
    with refusals():
        value = evaluate(data.decode("utf-8", "replace"), namespace("", _NAMES).find, budget)
        budget.measure(value)


@contextmanager
def refusals() -> Iterator[None]:
    """Accept the refusals of expressions, which have messages."""
    try:
        yield
    except (EvaluationFails, Undetermined, OutOfBudget) as error:
        check_message(str(error))


def yaml_values(data: bytes) -> None:
    """The values that xacro loads from YAML are plain and of bounded size."""
    budget = Budget(_WORK)
    with refusals():
        budget.measure(read_yaml_values(data, namespace("", _NAMES).find, budget))
