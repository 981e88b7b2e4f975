"""What holds of every output: visible text, in which no CI system finds a command."""

from grader.report.formats import Format
from tests.report.workflow_commands import commands

ANNOTATIONS = {"error", "warning", "notice"}
PROPERTIES = {"file", "line", "endLine", "col", "endColumn", "title"}


def is_harmless(text: str, kind: Format | None = None) -> None:
    """Assert that a text is visible UTF-8 without commands of CI systems, except annotations in GitHub's own format."""
    text.encode()
    assert kind is Format.MARKDOWN or "##vso[" not in text.lower()  # of Azure Pipelines
    unseen = {character for character in text if not character.isprintable()} - {"\n"}
    assert unseen <= (
        {"\u2060"} if kind is Format.MARKDOWN else set()
    )  # it keeps mentions from being found
    found = commands(text) if kind is not Format.MARKDOWN else []
    assert kind is Format.GITHUB or not found
    assert {command.name for command in found} <= ANNOTATIONS
    for command in found:
        keys = [key for key, _ in command.properties]
        assert set(keys) <= PROPERTIES
        assert len(set(keys)) == len(keys)
