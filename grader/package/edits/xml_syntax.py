"""Syntax errors of the XML files of a package."""

from collections.abc import Iterator

from grader.edits import Proposal, edited
from grader.package.edits.task import proposal
from grader.package.xml_file import XmlFault, XmlFile
from grader.source import Source
from grader.xml.syntax import proposals


def repaired(source: Source, what: str) -> Iterator[Proposal]:
    """Yield edits after which a file is XML."""
    for found in proposals(source, is_urdf=False, is_strict=True):
        text = edited(source.text, source.path, found.edits) or ""
        try:
            XmlFile(text.encode("utf-8", "surrogateescape"), source)
        except XmlFault:
            continue
        yield proposal(list(found.edits), f"{found.cause} in {what}", f"{found.action} in {what}")
