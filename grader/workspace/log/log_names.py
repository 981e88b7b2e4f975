"""The names of a workspace that a message of a log has: where they are defined."""

from collections.abc import Iterator
from functools import cached_property

from grader.base.patterns import on_use
from grader.workspace.index.all_names import read_names
from grader.workspace.index.written_names import WrittenName
from grader.workspace.log.known_messages import PlacedAnswer
from grader.workspace.log.log_findings import LogFindings
from grader.workspace.log.log_messages import LogMessage
from grader.workspace.opening.opened import OpenedWorkspace

# Words in quotes or brackets, and those that are no words of English.
_WORD = on_use(
    r"['\"`\[](?P<quoted>[\w./:-]{2,200}+)['\"`\]]|(?<![\w./])(?P<bare>\w{1,100}_\w{1,100}+)"
)
_COMMON = ("package", "program", "file")  # kinds whose names mean something only in quotes
_MAX_WORDS = 10
_MAX_PLACES = 2  # of a name: one with more is too common to say something


class LogNames:
    """The names that the files of a workspace define, for the messages of a log."""

    def __init__(self, opened: OpenedWorkspace) -> None:
        self._opened = opened

    @cached_property
    def _definitions(self) -> dict[str, list[WrittenName]]:
        definitions: dict[str, list[WrittenName]] = {}
        for name in read_names(self._opened.workspace).names:
            if name.role == "definition":
                definitions.setdefault(name.name.strip("/"), []).append(name)
        return definitions

    def named_in(self, message: LogMessage, findings: LogFindings) -> Iterator[PlacedAnswer]:
        """Yield the findings about a name in a message, and the place that defines it."""
        for match in list(_WORD.finditer(message.text))[:_MAX_WORDS]:
            word = match["quoted"] or match["bare"]
            yield from map(PlacedAnswer.of_problem, findings.naming(word))
            places = {}
            for name in self._definitions.get(word.strip("/"), ()):
                if match["quoted"] or name.kind not in _COMMON:
                    places[name.location] = name.kind
            if len(places) <= _MAX_PLACES:
                for location, kind in places.items():
                    yield PlacedAnswer(location, f"the {kind} {word!r} is defined here")
