"""Search the edits that make failed criteria pass, the costliest first, and prove them.

From small to large: a `Set` is a value of one element, a `Piece` what one mistake needs, with its words, and a
`Proposal` one way to write a piece into the files, as edits of their texts. A `State` is the submission with some
edits; `StateEdits` are the pieces that may help it, tried by a `QuickGrading` without any text, of which `EditChoice`
takes the best. What `Trials` prove by grading again becomes a `FoundHint`, and in a report a `Hint`. `Fix` are all of
them together, as files.
"""

from collections.abc import Callable, Mapping
from contextlib import suppress
from decimal import Decimal
from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from grader.edits import Proposal
from grader.grading.hints.choice import EditChoice
from grader.grading.hints.trials import NoTrialsLeft, Results, State, Trials, as_one, costs_of, gains_of, join
from grader.grading.missing_work import robot_of
from grader.robot.edits.draft import Draft
from grader.robot.reader import Reading
from grader.source import Edits
from grader.submission.editing import creates
from grader.submission.urdf import Read, known_links

if TYPE_CHECKING:
    from grader.package.package import Package

_UNION = Proposal((), "", "")  # of edits that are proposed already


class FoundHint(NamedTuple):
    """A proven edit of the submission as it is, and the points of the criteria that pass with it.

    `after` are earlier edits that it includes, because it needs them.
    """

    proposal: Proposal
    edits: Edits
    gains: Mapping[str, Decimal]
    after: "tuple[FoundHint, ...]" = ()


class HintSearch:
    """The search for one submission; `found` are proven edits, `final` the submission with those that fit together."""

    def __init__(
        self, trials: Trials, reference: Draft | None, package: "Callable[[], Package | None]" = lambda: None
    ) -> None:
        """`reference` and `package` are the robot and the package of the rubric's reference solution."""
        self.trials = trials
        self._criteria = {criterion.id: criterion for criterion in trials.rubric.criteria}
        self._choice = EditChoice(trials, reference, package)
        self._reference = reference
        robot, rubric = robot_of(trials.start.submission.urdf), trials.rubric
        # One with as many links may be the lab's, with other names; one with some of its links may be unfinished.
        is_small = robot is not None and not robot.incomplete and 2 * len(robot.links) < len(rubric.links)
        self._is_another_robot = robot is not None and is_small and not known_links(robot, rubric.links)
        self.causes = self._choice.causes
        self.certainties = self._choice.certainties
        self.found: list[FoundHint] = []
        self.final = trials.start
        self.is_complete = True  # whether all was searched that may help
        self._given_up: set[tuple[Edits, str, bool]] = set()

    def run(self) -> "HintSearch":
        """Search until nothing more is found, or the budget is spent."""
        self.is_complete = False
        with suppress(NoTrialsLeft):
            for phase in (self._load, self._convention, self._rounds, self._combine) if self.trials.left else ():
                with self.trials.isolated():
                    phase()
            self.is_complete = bool(self.trials.left)
        return self

    def _convention(self) -> None:
        """Correct a convention of the whole robot first: one hint instead of one for each consequence."""
        best = None if self._is_another_robot else self._choice.convention(self.final)
        after = self.trials.apply(self.final, best.edits) if best is not None else None
        name = next(iter(gains_of(self.final.results, after.results))) if after is not None else ""
        if best is not None and after is not None and self._prove(self.final, best, name):
            self.final = after._replace(edits=join(self.trials.start.submission, self.final.edits, best.edits))

    def _rounds(self) -> None:
        for is_solving in (False, True):  # what the reference has comes first
            while self._round(self.final, is_solving=is_solving):
                pass

    def _round(self, state: State, *, is_solving: bool) -> bool:
        """Find edits of a state for as many of its failed criteria as possible; return whether there were any."""
        wanted = self._by_cost(state.results)
        if self._is_another_robot:  # no edit of a mistake makes it the lab's
            wanted = [name for name in wanted if self._criteria[name].check.subject != "robot"]
        taken: Edits = ()
        current = state
        for name in wanted:
            if current.results[name].outcome.status == "passed" or (state.edits, name, is_solving) in self._given_up:
                continue
            best = self._choice.best(state, self._criteria[name], is_solving=is_solving)
            if best is None or not self._prove(state, best, name):
                self._given_up.add((state.edits, name, is_solving))
                continue
            after = self.trials.apply(state, (*taken, *best.edits), current.results)
            if after is not None and not after.lost:
                taken, current = after.edits, after
                self.final = current._replace(edits=join(self.trials.start.submission, state.edits, taken))
        return bool(taken)

    def _load(self) -> None:
        """Repair a URDF that ROS 2 rejects, or drops content of: the rest of the search goes on from there."""
        urdf = self.final.submission.urdf
        if isinstance(urdf, Read) and urdf.loaded.verdict == "clean" and not _has_remains(urdf.loaded):
            return
        from grader.grading.hints.loading import repair  # late: most robots load

        repairs, self.final = repair(self.trials, self._reference)
        is_each = len(repairs) > 1 and [self._add(it, it.edits) for it in repairs if it.edits] == [True] * len(repairs)
        known = {name for found in self.found for name in found.gains}
        if set(gains_of(self.trials.start.results, self.final.results)) - known:
            whole, after = (_UNION, tuple(self.found)) if is_each else (as_one(repairs, self.final.edits), ())
            self._add(whole, self.final.edits, after=after)

    def _by_cost(self, results: Results) -> list[str]:
        """Return the failed criteria, those with which most points are lost first."""
        costs = costs_of(results)
        return sorted(costs, key=lambda name: (-costs[name], self._criteria[name].position))

    def _prove(self, state: State, proposal: Proposal, name: str) -> bool:
        """Add a proven edit of the submission as it is: alone, else together with one or all of those before it."""
        submission = self.trials.start.submission
        all_edits = join(submission, state.edits, proposal.edits) if state.edits else proposal.edits
        alone = tuple(edit for edit in all_edits if edit not in state.edits)
        is_apart = len(alone) + len(state.edits) == len(all_edits)
        after_one = ((join(submission, it.edits, ()) + alone, (it,)) for it in tuple(self.found) if is_apart)
        return (
            (is_apart and self._add(proposal, alone, name))
            or any(self._add(proposal, edits, name, it) for edits, it in after_one)
            or self._add(proposal, all_edits, name, tuple(self.found))
        )

    def _add(self, proposal: Proposal, edits: Edits, name: str = "", after: tuple[FoundHint, ...] = ()) -> bool:
        """Add edits if they, graded from scratch, gain the points of a criterion; return whether they do."""
        start = self.trials.start
        state = self.trials.apply(start, edits, whole=True)
        if state is None or state.lost:
            return False
        gains = gains_of(start.results, state.results)
        edits = tuple(edit for edit in edits if edit.old != edit.new or edit.renamed or creates(start.submission, edit))
        is_proven = bool(gains) and name in (*gains, "")
        if is_proven:
            self.found.append(FoundHint(proposal, edits, gains, after))
        return is_proven

    def _combine(self) -> None:
        """Find which of the proven edits make a criterion pass together that no single one does."""
        start = self.trials.start
        for name in self._by_cost(start.results):
            if any(name in found.gains for found in self.found) or self.final.results[name].outcome.status != "passed":
                continue
            for first, second in combinations(self.found, 2):
                edits = tuple(dict.fromkeys((*first.edits, *second.edits)))
                if not first.after and not second.after and self._add(_UNION, edits, name, (first, second)):
                    break
            else:
                self._add(_UNION, self.final.edits, name, tuple(self.found))


def _has_remains(reading: Reading) -> bool:
    """Return whether a file that ROS 2 loads has problems, or text between its tags."""
    texts = (
        (text for element in reading.root.iter() for text in (element.text, element.tail))
        if reading.root is not None
        else ()
    )
    return bool(reading.problems) or any(text and not text.isspace() for text in texts)
