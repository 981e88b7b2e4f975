"""Messages of a log that a row knows, and the places of a workspace that answer them."""

from collections.abc import Mapping
from typing import NamedTuple

from grader.base.problems import Problem
from grader.base.source import Location
from grader.ros.known.output_rows import OutputRow
from grader.workspace.log.log_messages import LogMessage


class PlacedAnswer(NamedTuple):
    """What explains a message at a place of the workspace."""

    location: Location
    text: str
    code: str = ""  # of the finding there
    is_certain: bool = True

    @classmethod
    def of_problem(cls, problem: Problem) -> "PlacedAnswer":
        """Return what a finding says."""
        is_certain = problem.severity == "error"
        return cls(problem.location, problem.message, problem.code, is_certain)


class KnownMessage(NamedTuple):
    """A message of a log that a row knows, with the names in it."""

    message: LogMessage
    row: OutputRow
    groups: Mapping[str, str]

    def placed(self, location: Location) -> PlacedAnswer:
        """Return what the row says of a place, with the names of the message."""
        return PlacedAnswer(location, self.row.otherwise.format_map(self.groups))
