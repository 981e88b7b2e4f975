"""What criteria measure with other values in the elements of a robot: a quick look, without a change of the text."""

from collections.abc import Collection, Iterable
from dataclasses import replace

from grader.grading.deciding import decide
from grader.grading.hints.trials import State, Trials
from grader.grading.report import Result
from grader.robot.edits.draft import Draft, Set
from grader.robot.reader import read_robot
from grader.source import Location, Source
from grader.submission.urdf import Read
from grader.xml.parsing import XmlDocument


class _Nowhere(Source):
    """The text of no file: elements that are changed have no place."""

    def tag(self, index: int, attribute: str | None = None) -> Location:
        del index, attribute
        return Location(self.path, 1, 1)

    def element(self, tag: int) -> tuple[Source, int]:
        del tag
        return self, 0


class Model:
    """The robot of a state. Each question is charged to the trials."""

    def __init__(self, trials: Trials, state: State, draft: Draft) -> None:
        self._trials, self._state, self._draft = trials, state, draft
        self._source = _Nowhere("", "")
        self._cost = 1 + len(draft.robot.links) // 40

    def results(self, sets: Iterable[Set], wanted: Collection[str]) -> dict[str, Result]:
        """Return the results of criteria with other values. Raises NoTrialsLeft."""
        self._trials.spend(self._cost)
        submission = self._state.submission
        urdf = submission.urdf
        assert isinstance(urdf, Read)
        with self._draft.supposing(sets):
            unresolved = urdf.reading.unresolved
            document = XmlDocument(self._draft.root, self._source, [], 0, unresolved, is_expanded=urdf.is_expanded)
            reading = read_robot(document)
            changed = replace(submission, urdf=urdf._replace(reading=reading))
            return {result.criterion.id: result for result in decide(self._trials.rubric, changed, wanted)}
