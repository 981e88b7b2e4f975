"""Compares the grader's expansion of a document with xacro's: the tree of elements, and the robot that ROS 2 reads."""

import posixpath
import re
from importlib import import_module
from typing import Any, NamedTuple

from lxml import etree

from grader.base.errors import InputError
from grader.ros.python.budget import READING, Budget
from grader.ros.urdf.reader import read_urdf
from grader.ros.xacro.xacro_problems import WRITTEN_TO_STDERR
from grader.ros.xml.xml_problems import MISPLACED_DECLARATION
from tests.xacro import oracle
from tests.xacro.documents.document import PACKAGES, Document

Tree = tuple[str, dict[str, str], list[Any]]


class _Workspace(NamedTuple):
    files: dict[str, str | bytes]
    budget: Budget
    paths: list[str]
    asked: list[str]
    is_part: bool = False
    called: str = "submission"

    def read(self, path: str) -> bytes:
        self.asked.append(path)
        content = self.files.get(posixpath.normpath(path))
        if content is None:
            raise InputError(f"{path} does not exist")
        return content if isinstance(content, bytes) else content.encode()

    def package(self, name: str) -> str | None:
        return PACKAGES.get(name)

    def installed(self, package: str, inside: str) -> None:
        """Return no file: no build installs one."""

    def ask(self, name: str) -> None:
        """Note nothing."""


def expand(document: Document, asked: list[str] | None = None, limit: int = READING) -> Any:
    """Return the grader's expansion of a document; `asked` receives the paths of the files that it reads, `limit` are parts."""
    expansion: Any = import_module("grader.ros.xacro.expansion")
    files = {document.path: document.text, **document.files}

    workspace = _Workspace(files, Budget(limit), sorted(files), [] if asked is None else asked)
    return expansion.expand(
        workspace.read(document.path), document.path, workspace, document.arguments
    )


def difference(document: Document, expected: oracle.Accepted | oracle.Refused) -> str | None:
    """Return how the grader's expansion of a document differs from what is expected, xacro's; None if they agree.

    What xacro accepts is never refused; what it refuses is, unless that depends on what is outside of the submission. Every
    other document is determined. A processing instruction is xacro's to keep and ROS 2's to reject.
    """
    found = expand(document)
    rejected = [problem for problem in found.problems if problem.kind.effect == "rejects"]
    refusals = [
        problem.message for problem in rejected if problem.kind is not MISPLACED_DECLARATION
    ]
    reasons = [undetermined.reason for undetermined in found.undetermined]
    if isinstance(expected, oracle.Accepted) and refusals:
        return f"xacro accepts it, the grader refuses it: {refusals[0]}"
    if document.undetermined == "always" and not reasons:
        return "it depends on what is outside of the submission, which the grader does not say"
    if document.undetermined != "never" and reasons:
        return None
    if isinstance(expected, oracle.Refused):
        return None if refusals else f"xacro refuses it, the grader does not: {expected.message}"
    if reasons:
        return f"xacro accepts it, the grader cannot determine it: {reasons[0]}"
    warned = [problem.message for problem in found.warnings if problem.kind in WRITTEN_TO_STDERR]
    if bool(warned) != expected.has_warned:
        return f"xacro writes to stderr: {expected.has_warned}, the grader says: {warned}"
    text = etree.tostring(found.root, encoding="utf-8", with_tail=False)
    for name, folder in PACKAGES.items():
        text = text.replace(
            f"/install/{name}/share/{name}".encode(), f"/{folder}".rstrip("/").encode()
        )
    place = _difference_of_trees(
        tree(etree.fromstring(expected.text)), tree(etree.fromstring(text)), ""
    )
    if place is not None or not rejected:
        return place or _difference_of_robots(expected.text.encode(), text)
    verdict = read_urdf(expected.text.encode()).verdict
    return (
        None
        if verdict == "rejected"
        else f"the grader refuses it, but what xacro makes of it is {verdict}"
    )


def _difference_of_robots(expected: bytes, found: bytes) -> str | None:
    readings = [read_urdf(data) for data in (expected, found)]
    robots = [
        (reading.verdict, repr(reading.robot)) for reading in readings
    ]  # their representation shows every number
    return None if robots[0] == robots[1] else f"the robots differ: {robots[0]} and {robots[1]}"


def tree(element: etree._Element) -> Tree:
    """Return an element as plain values: tag, attributes, and its elements with the text before, between and after them.

    Comments and processing instructions are ignored. White space counts as one space; in an attribute, as a space each, which
    is what a parser reads of the line breaks that xacro writes.
    """
    content: list[Any] = [element.text or ""]
    for child in element:
        if isinstance(child.tag, str):
            content += [tree(child), ""]
        content[-1] += child.tail or ""
    return (
        _name(element, str(element.tag)),
        {
            _name(element, str(name)): re.sub(r"\s", " ", str(value))
            for name, value in element.items()
        },
        [" ".join(part.split()) if isinstance(part, str) else part for part in content],
    )


def _name(element: etree._Element, name: str) -> str:
    """Return a name with its prefix instead of its namespace; the grader's elements have the prefix as their namespace."""
    uri, brace, local = name.removeprefix("{").rpartition("}")
    prefix = (
        next((prefix for prefix, other in element.nsmap.items() if other == uri), None)
        if brace
        else None
    )
    prefix = uri if prefix is not None and re.fullmatch(r"ns\d+", prefix) else prefix
    return f"{prefix}:{local}" if prefix else local


def _difference_of_trees(expected: Tree, found: Tree, place: str) -> str | None:
    """Return the first difference of two trees in document order, with the path of the element."""
    place = f"{place}/{expected[0]}"
    if expected[:2] != found[:2]:
        return f"{place}: expected {expected[0]} {expected[1]}, found {found[0]} {found[1]}"
    for one, other in zip(expected[2], found[2], strict=False):
        if isinstance(one, str):
            if one != other:
                return f"{place}: expected the text {one!r}, found {other!r}"
        elif (inner := _difference_of_trees(one, other, place)) is not None:
            return inner
    counts = len(expected[2]) // 2, len(found[2]) // 2
    return (
        None
        if counts[0] == counts[1]
        else f"{place}: expected {counts[0]} elements, found {counts[1]}"
    )
