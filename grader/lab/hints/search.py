"""Search the edits that make failed criteria pass.

Each is graded alone, and with those that were found before it.

A `Piece` is what one mistake needs, with its words; a `Proposal` is one way to write it into the
files; what grading proves becomes a `FoundHint`, and in a report a `Hint`. All of them together are
the `FixedFiles`.
"""

from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from decimal import Decimal
from functools import partial
from typing import TYPE_CHECKING

from grader.base.errors import InputError, NotDecided
from grader.base.patterns import on_use
from grader.base.records import Named
from grader.base.slips import Slip
from grader.base.source import Certainty, Edits
from grader.base.text import enumerated
from grader.files.limits import ROBOT_ENDINGS
from grader.files.reading import URDF_LIMIT
from grader.lab.grading.deciding import decide
from grader.lab.grading.not_known import judge_known
from grader.lab.grading.report import Report, Result
from grader.lab.hints.edits import FoundHint, Proposal
from grader.lab.hints.generators import STAGES, Situation, Stage, leaves_others, missing_hints
from grader.lab.hints.robot_difference import REFERENCE, STRUCTURE
from grader.lab.hints.robot_draft import Draft, read_end
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.edited import content, edited_files, with_files, with_urdf
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read

if TYPE_CHECKING:
    from grader.ros.package.package import Package


_Results = Mapping[str, Result]

_MAX_GRADINGS = 170  # of one submission that is as short as most
_HARMFUL = ("rejects", "drops", "undetermined")
_RESERVE = 20  # gradings for proofs
_AROUND = " ,\r\n"  # of a text that is added
_MAX_REACTIONS = 3
_WORD = on_use(r"\w+")
_MAX_PARTS = 5  # edits of a hint of which each is tried without
_MAX_WITHOUT = 30  # gradings that say which of the hints another one needs
_Gains = dict[str, Decimal]  # points by criterion
_EditGroups = Sequence[Edits]


class _NoTrialsLeft(Exception):
    """The budget for one submission is spent."""


class Trials:
    """Grades edited submissions.

    The budget counts gradings, so that it is the same on every machine.
    """

    def __init__(self, rubric: Rubric, submission: Submission, results: _Results) -> None:
        parts = {part.id for part in rubric.parts if part.needs != "files"}
        self.rubric = rubric
        self.submission = submission
        self.results = {
            name: result for name, result in results.items() if result.criterion.part in parts
        }
        self._edited = dict[tuple[Edits, bool], Submission | None]()
        self._is_of_reference = dict[str, bool]()  # by path
        self.left = _MAX_GRADINGS
        self.faults: list[str] = []  # the types of exceptions

    @contextmanager
    def isolated(self) -> Iterator[None]:
        """Record a fault of the grader in one generator or one step.

        It must not cost the hints of the others.
        """
        try:
            yield
        except _NoTrialsLeft:
            raise
        except Exception as error:  # noqa: BLE001
            self.faults.append(type(error).__name__)

    def graded(
        self, edits: Edits, wanted: Collection[str] | _Results, *, whole: bool = False
    ) -> _Results:
        """Return the results of criteria with edits.

        It is None where these do not fit, or ROS 2 would reject or drop more.

        With the results that criteria had, there are none where one is worse now.
        `whole` reads the submission from scratch. Raises NoTrialsLeft.
        """
        self.left -= 1 + self.submission.cost
        if self.left < 0:
            raise _NoTrialsLeft
        edited = self.edited(edits, whole=whole)
        if not edited or _has_new_problems(self.submission, edited):
            return {}
        if _has_new_build_errors(self.submission, edited):
            return {}
        results = {}
        decided = decide(self.rubric, edited, wanted)
        for result in judge_known(self.rubric, edited, decided, wanted):
            name = result.criterion.id
            if isinstance(wanted, Mapping) and is_worse(wanted[name], result):
                return {}  # at once: a shape in another one takes long to measure
            results[name] = result
        return results

    def is_of_reference(self, path: str) -> bool:
        """Return whether a file of the robot is the same in the reference.

        The mistake then is in another one.
        """
        if not path.endswith(ROBOT_ENDINGS):
            return False
        if path not in self._is_of_reference:
            self._is_of_reference[path] = False
            data = content(self.submission, path)
            solution = self.rubric.solution
            if data and solution and self.submission.package:
                with suppress(InputError):
                    for file in solution.submission.whole_tree.files.values():
                        if file.size == len(data) and file.read(URDF_LIMIT) == data:
                            self._is_of_reference[path] = True
                            break
        return self._is_of_reference[path]

    def edited(self, edits: Edits, *, whole: bool = False) -> Submission | None:
        """Return the submission with edits; None where they do not fit.

        What was tried is proven next: it is kept.
        """
        key = edits, whole
        if key not in self._edited:
            self._edited[key] = self._newly_edited(edits, whole=whole)
        return self._edited[key]

    def _newly_edited(self, edits: Edits, *, whole: bool) -> Submission | None:
        files = edited_files(self.submission, edits)
        if files is None:
            return None
        is_read = isinstance(self.submission.urdf, Read) and None not in files.values()
        # A launch file that could not decode it now may, and so load another robot.
        is_decoded = all(edit.old.isascii() for edit in edits)
        is_of_robot = all(_is_of_robot(path, self.submission) for path in files)
        if is_read and is_decoded and is_of_robot and not whole:
            return with_urdf(self.submission, files)
        try:
            return with_files(self.submission, files)
        except InputError:
            return None


def _has_new_problems(before: Submission, after: Submission) -> bool:
    """Return whether ROS 2 loads the URDF with a new kind of problem.

    It did not have it before: no edit may make it worse.
    """
    if not isinstance(before.urdf, Read) or not isinstance(after.urdf, Read):
        return False
    if _repeated(after.urdf) - _repeated(before.urdf):
        return True  # a macro that is called twice makes two links of one name
    if before.urdf.loaded.verdict == "rejected":
        return False
    harmful = (
        known_problem.kind
        for known_problem in before.urdf.loaded.problems
        if known_problem.kind.effect in _HARMFUL
    )
    known = set(harmful)
    for problem in after.urdf.loaded.problems:
        if problem.kind.effect in _HARMFUL and problem.kind not in known:
            return True
    return False


def _has_new_build_errors(before: Submission, after: Submission) -> bool:
    """Return whether a build of the package stops for another reason than before.

    It may also fail in both: an edit of a name must not leave the folder of its module.
    """
    if before.package is None or after.package is None:
        return False
    was = before.package.installation
    now = after.package.installation
    if was is None or now is None:
        return False
    if was.fault or was.faults or not was.is_called:
        return False  # what is wrong after that line shows only now
    known = {(stop.path, stop.reason) for stop in was.stops}
    return any((stop.path, stop.reason) not in known for stop in now.stops)


def _count_connections(submission: Submission | None) -> Counter[tuple[str, str]]:
    """Return how many connections of each kind the launch files of each folder make.

    An edit may rename a file.
    """
    from grader.workspace.api import connections_in, launch_graph  # late: few edits need them

    counts: Counter[tuple[str, str]] = Counter()
    with suppress(NotDecided):
        assert submission
        for launch in submission.workspace.launches.outermost:
            path = launch.source.path
            graph = launch_graph(submission.workspace, path)
            folder = path.rpartition("/")[0]
            counts.update((folder, connection.kind) for connection in connections_in(graph))
    return counts


def _repeated(urdf: Read) -> set[tuple[str, str]]:
    """Return the names that several links have, and the links that several joints move."""
    draft = Draft.of(urdf.loaded)
    if not draft:
        return set()
    names = Counter(("link", link.get("name") or "") for link in draft.links())
    names.update(("joint", read_end(joint, "child")) for joint in draft.joints())
    return {key for key, count in names.items() if count > 1}


def _is_of_robot(path: str, submission: Submission) -> bool:
    """Return whether a file is the URDF or one that its xacro reads.

    It is not one that the package's checks read.
    """
    is_robot = path.lower().endswith((".urdf", ".xacro")) and path in submission.whole_tree.files
    return is_robot or path == submission.path


def is_worse(before: Result, after: Result) -> bool:
    """Return whether a criterion no longer passes, has fewer points, or is undecided now.

    An adjusted one is never worse.
    """
    was = before.outcome.status
    status = after.outcome.status
    if after.is_adjusted:
        return False
    if was != status and (was == "passed" or status in ("pending", "errored")):
        return True
    return after.points < before.points


def sum_costs(results: _Results) -> _Gains:
    """Return what each failed criterion costs, with the criteria that are skipped because of it."""
    lost: _Gains = {}
    for name, result in results.items():
        if result.is_lost:
            cause = result.because if result.because in results else None
            lost[cause or name] = lost.get(cause or name, Decimal(0)) + result.criterion.points
    return {
        name: points for name, points in lost.items() if results[name].outcome.status == "failed"
    }


def list_gains(before: _Results, after: _Results) -> _Gains:
    """Return the criteria that pass now and did not before, with the points that this gives."""
    return {
        name: result.points - before[name].points
        for name, result in after.items()
        if result.outcome.status == "passed"
        and before[name].outcome.status in ("failed", "skipped")
        and not result.is_adjusted
    }


def judged_results(report: Report) -> dict[str, Result]:
    """Return the results that hints begin with: those on the words that are meant."""
    results = report.results if not report.meant else report.meant.results
    return {result.criterion.id: result for result in results}


def hints_on_slips(report: Report) -> list[FoundHint]:
    """Return the hints that correct slips.

    Each gives its criterion the points, unless that fails all the same.
    """
    judged = judged_results(report)
    of_payers: dict[str, list[Slip]] = {}
    for paid in report.meant.paid if report.meant else ():
        of_payers.setdefault(paid.payer, []).append(paid.slip)
    hints = []
    for payer, slips in of_payers.items():
        edits = _edits_of(slips)
        cause = enumerated(dict.fromkeys(slip.reaction for slip in slips), _MAX_REACTIONS)
        is_passed = judged[payer].outcome.status == "passed"
        gains = {payer: judged[payer].criterion.points} if is_passed else {}
        # A hint never writes a part that is missing, such as a call of rclpy.init().
        words = cause if _adds_part(edits) else ""
        hints.append(FoundHint(Proposal(edits, cause), gains, words=words))
    return hints


def _edits_of(fixes: Iterable[Slip | FoundHint]) -> Edits:
    """Return the edits of slips or hints, one after another."""
    return tuple(edit for fix in fixes for edit in fix.edits)


def _adds_part(edits: Edits) -> bool:
    """Return whether an edit inserts words that no other one takes from elsewhere."""
    removed = {word for edit in edits for word in _WORD.findall(edit.old)}
    inserted = [edit.new for edit in edits if not edit.old]
    return any(not removed.issuperset(_WORD.findall(new)) for new in inserted)


class _Tried(Named):
    """A proposal that was graded alone, after the edits so far."""

    proposal: Proposal
    passes: frozenset[str]  # the criteria that pass with it, and did not before


class _Proof(Named):
    """What a proposal gains, and the results then.

    The gains are as a hint says them, and together with all edits before it.
    """

    proposal: Proposal
    gains: _Gains
    together: _Gains
    results: _Results
    is_late: bool


def _is_reverse(one: Proposal, other: Proposal) -> bool:
    """Return whether the edits change texts of which the other ones make the old ones."""
    reversed_changes = {(edit.new, edit.old) for edit in other.edits}
    return {(edit.old, edit.new) for edit in one.edits} == reversed_changes


def _leave_out(groups: _EditGroups, is_enough: Callable[[Edits], bool]) -> _EditGroups:
    """Return the groups of edits without those that are not needed.

    The last ones are dropped first, because the first gain most. Without trials, the rest stay.
    """
    kept = groups
    with suppress(_NoTrialsLeft):
        for group in reversed(groups):
            others = [one for one in kept if one != group]
            if is_enough(tuple(edit for one in others for edit in one)):
                kept = others
    return kept


class HintSearch:
    """The search for one submission.

    `found` are proven edits that fit together, first those of `slips`, `edits` are those of all.
    """

    def __init__(
        self,
        trials: Trials,
        reference: Draft | None,
        package: "Callable[[str], Package | None]" = lambda _: None,
        told: Collection[str] = (),
        slips: Sequence[FoundHint] = (),
    ) -> None:
        """Take the robot of the rubric's solution, `reference`.

        `package` returns its package of a name.

        No edit is searched for the criteria that are `told`. The results of the trials are those
        with the edits of `slips`, which are found already.
        """
        self.trials = trials
        self._situation_of = partial(
            Situation, wanted=trials.rubric.links, reference=reference, package=package
        )
        self.found = list(slips)
        self.slips = tuple(slips)
        self._corrected = _edits_of(slips)
        self._situation = self._situation_of(trials.submission)
        if slips:
            self._situation = self._situation_after(self.edits)
        self._criteria = {criterion.id: criterion for criterion in trials.rubric.criteria}
        self.missing: dict[
            str, FoundHint
        ] = {}  # by the criterion that shows that a part is missing, or two edits
        self._refused: set[Edits] = set()  # after all hints so far
        self._told = {*told}  # also criteria for which two edits are told that cannot be told apart
        self._tried_after: dict[Stage, Edits] = {}  # the edits after which a stage was tried last
        self.results: _Results = trials.results  # with all edits
        self.is_complete = self._is_cut = False

    @property
    def edits(self) -> Edits:
        """The edits of all hints."""
        return _edits_of(self.found)

    def run(self) -> "HintSearch":
        """Search until nothing more is found, or the budget is spent."""
        with suppress(_NoTrialsLeft):
            for stage in STAGES:
                self._take(stage)
            self.is_complete = not self._is_cut or not self._lost
        # One grading is left to verify all hints.
        self.trials.left = max(self.trials.left, 1 + self.trials.submission.cost)
        with self.trials.isolated():
            self._verify()
        self.trials.left = _MAX_WITHOUT
        with self.trials.isolated():
            self._name_needed_hints()
        with self.trials.isolated():
            explained = {name for hint in self.found for name in hint.gains}
            explained |= self.missing.keys()
            lost = sum_costs(self.trials.results)
            for name in explained:
                lost.pop(name, None)
            after = self._situation_after(self.edits)
            if after.is_whole:
                self.missing |= missing_hints(
                    after.difference, self._situation.draft, self._criteria, lost
                )
        return self

    def _situation_after(self, edits: Edits) -> Situation:
        edited = self.trials.edited(edits) if edits else None
        if edited:
            return self._situation_of(edited)
        return self._situation

    def _verify(self) -> None:
        """Take no hint back only if all together hold where the submission is read from scratch."""
        if self.found and not self.trials.graded(self.edits, self.results, whole=True):
            self.found, self.results = list(self.slips), self.trials.results

    def _name_needed_hints(self) -> None:
        """Drop from each late hint the earlier hints without which it gives the points, too.

        A criterion that is carried has them.
        """
        for index, hint in enumerate(self.found):

            def still_gains(before: Edits, needed_hint: FoundHint = hint) -> bool:
                _, after = self._gains(
                    self._corrected + before, needed_hint.edits, self.trials.results
                )
                return all(name in after and not after[name].is_lost for name in needed_hint.gains)

            self.found[index] = hint._replace(after=_leave_out(hint.after, still_gains))

    def edits_needed_for(self, name: str) -> _EditGroups:
        """Return the edits of hints that a criterion without a hint of its own needs to pass."""

        def passes(edits: Edits) -> bool:
            if not edits:
                return False
            results = self.trials.graded(edits, [name])
            return name in results and not results[name].is_lost

        return _leave_out([hint.edits for hint in self.found], passes)

    @property
    def _lost(self) -> list[str]:
        return [
            name
            for name, result in self.results.items()
            if result.is_lost and name not in self._told
        ]

    def _take(self, stage: Stage) -> None:
        """Take the proposals of a stage that are proven, those that gain most first."""
        if not self._lost or self._tried_after.get(stage) == self.edits:
            return
        self._tried_after[stage] = self.edits
        for exchange in reversed(self._situation.exchanges):
            # What else is wrong shows when joints have the right ends; no line moves.
            if exchange.edits and {*exchange.edits} <= {*self.edits}:
                self._situation = self._situation_after(exchange.edits)
                break
        tried: list[_Tried] = []
        with self.trials.isolated():
            self._try(stage, tried)
        while best := self._best(tried):
            if not self._prove(best, tried):
                self._refused.add(best.proposal.edits)

    def _try(self, stage: Stage, tried: list[_Tried]) -> None:
        """Grade the proposals of a stage, each once; add those with which a criterion passes."""
        has_package = self.trials.submission.package is not None
        lost = [
            name
            for name in self._lost
            if has_package or self._criteria[name].check.subject != "package"
        ]
        seen = set()
        for proposals in stage(self._situation, [self._criteria[name] for name in lost]):
            with self.trials.isolated():
                for proposal in proposals:
                    if proposal.edits in seen:
                        continue
                    seen.add(proposal.edits)
                    if self._is_in_reference(proposal):
                        continue
                    if self.trials.left < _RESERVE:
                        self._is_cut = True
                        return
                    passes = self._passes_with(proposal, lost)
                    if passes:
                        tried.append(_Tried(proposal, passes))

    def _is_in_reference(self, proposal: Proposal) -> bool:
        """Return whether a proposal edits a file that is the same in the reference."""
        changed = [edit.path for edit in proposal.edits if not edit.renamed]
        return any(map(self.trials.is_of_reference, changed))

    def _passes_with(self, proposal: Proposal, lost: Collection[str]) -> frozenset[str]:
        """Return which of the lost criteria pass with a proposal."""
        results = self.trials.graded(self.edits + proposal.edits, lost)
        return frozenset(
            name for name, result in results.items() if result.outcome.status == "passed"
        )

    def _best(self, tried: Iterable[_Tried]) -> _Tried | None:
        lost = set(self._lost)
        left = (
            trial
            for trial in tried
            if trial.passes & lost and trial.proposal.edits not in self._refused
        )
        return min(left, key=lambda trial: self._order(trial, lost), default=None)

    def _order(self, one: _Tried, lost: Collection[str]) -> tuple[Decimal, int, int, int]:
        gain = sum((self._criteria[name].points for name in one.passes if name in lost), Decimal(0))
        return -gain, one.proposal.rank, one.proposal.way, one.proposal.size

    def _prove(self, best: _Tried, tried: Iterable[_Tried]) -> bool:
        """Add the hint of a proposal if it is proven, and return whether it was added."""
        wanted = best.passes & {*self._lost}
        proof = self._find_proof(best.proposal, wanted)
        if not proof or self._is_half(best, proof.results) or self._disconnects(proof):
            return False
        best = best._replace(proposal=proof.proposal)
        equal = self._equal_to(best, proof.together, wanted, tried)
        is_of_robot = all(edit.path.endswith((".urdf", ".xacro")) for edit in proof.proposal.edits)
        if equal and (is_of_robot or _is_reverse(proof.proposal, equal.proposal)):
            name = max(
                (criterion for criterion in self._criteria if criterion in wanted), key=self._weight
            )
            self.missing[name] = FoundHint(
                proof.proposal, {}, "one of several", alternative=equal.proposal
            )
            self._told |= wanted
            return False
        certainty: Certainty = "preferred" if not equal else "one of several"
        after: _EditGroups = ()
        if proof.is_late:
            after = tuple(hint.edits for hint in self.found if hint not in self.slips)
        other = equal.proposal if equal else None
        self.found.append(FoundHint(proof.proposal, proof.gains, certainty, after, equal=other))
        self.results = proof.results
        self._refused = set()
        return True

    def _disconnects(self, proof: _Proof) -> bool:
        """Return whether launch files connect less with the edits of a package.

        A controller that hears nothing compares with nothing.
        """
        edits = proof.proposal.edits
        if all(edit.path.endswith(ROBOT_ENDINGS) for edit in edits):
            return False
        before = self.trials.edited(self.edits) if self.edits else self.trials.submission
        after = self.trials.edited(self.edits + edits)
        return bool(_count_connections(before) - _count_connections(after))

    def _weight(self, name: str) -> tuple[bool, bool, Decimal]:
        """Return how well a criterion shows a hint.

        Best is one that is not skipped, that the URDF loads, and the costliest.
        """
        criterion = self._criteria[name]
        return (
            self.results[name].outcome.status == "failed",
            criterion.check.subject == "urdf",
            criterion.points,
        )

    def _find_proof(self, proposal: Proposal, wanted: frozenset[str]) -> _Proof | None:
        """Return what edits gain alone, or else after the edits before them.

        It is None if they lose anything.
        """
        edits = tuple(edit for edit in proposal.edits if edit not in self.edits)
        together, after = self._gains(self.edits, edits, self.results)
        if not together:
            return None
        if proposal.rank in (REFERENCE, STRUCTURE) and 1 < len(edits) <= _MAX_PARTS:
            edits, together, after = self._needed(edits, together, after)
        gains = together
        is_late = False
        if self.found:
            alone, _ = self._gains(self._corrected, edits, self.trials.results)
            is_late = wanted.isdisjoint(alone)
            gains = together if is_late else alone
        if gains.keys().isdisjoint(wanted):
            return None
        if any(after[name].outcome.status != "passed" for name in gains):
            return None
        new_gains = self._without_known(gains) or gains
        return _Proof(proposal._replace(edits=edits), new_gains, together, after, is_late)

    def _without_known(self, gains: _Gains) -> _Gains:
        """Return what edits gain that no hint gains which was found before."""
        known = {name for hint in self.found for name in hint.gains}
        return {name: points for name, points in gains.items() if name not in known}

    def _needed(
        self, edits: Edits, gains: _Gains, after: _Results
    ) -> tuple[Edits, _Gains, _Results]:
        """Leave out changes of values without which the others gain as much.

        Return the rest with what it gains.
        """
        for edit in [named_edit for named_edit in edits if named_edit.old and named_edit.new]:
            rest = tuple(other for other in edits if other is not edit)
            if not rest:
                break
            left, results = self._gains(self.edits, rest, self.results)
            if gains.keys() <= left.keys():
                edits = rest
                gains = left
                after = results
        return edits, gains, after

    def _equal_to(
        self,
        best: _Tried,
        gains: _Gains,
        wanted: frozenset[str],
        tried: Iterable[_Tried],
    ) -> _Tried | None:
        """Return another edit that gains as much, at other places, and loses nothing either.

        Another text that may be missing at the same place is one, too: a value of another call of a
        macro, or negated.
        """
        lost = set(self._lost)
        known = {best.proposal.edits, *self._refused}
        order = self._order(best, lost)
        places = best.proposal.places
        added = set()  # also in the next line
        for edit in best.proposal.edits:
            if not edit.old:
                added.add(edit.new.strip(_AROUND))
        is_added = all(
            not edit.old and edit.path.endswith(ROBOT_ENDINGS) for edit in best.proposal.edits
        )
        for other in tried:
            proposal = other.proposal
            if proposal.edits in known or not other.passes >= wanted:
                continue
            if added.issuperset(edit.new.strip(_AROUND) for edit in proposal.edits):
                continue
            order_of_other = self._order(other, lost)
            is_apart = order_of_other == order and proposal.places.isdisjoint(places)
            is_as_good = order_of_other[:-1] == order[:-1]  # apart from the size
            is_other_text = is_added and is_as_good and proposal.places == places
            if is_apart or is_other_text:
                gains_of_other, _ = self._gains(self.edits, proposal.edits, self.results)
                if gains.keys() <= gains_of_other.keys():
                    return other
        return None

    def _is_half(self, best: _Tried, after: _Results) -> bool:
        """Return whether an edit leaves what it should correct as well.

        It is left in another call of a macro, or of its link.
        """
        lost = [self._criteria[name] for name, result in after.items() if result.is_lost]
        passing = [self._criteria[name] for name in best.passes]
        if leaves_others(best.proposal.shared, passing, lost):
            return True
        if best.proposal.rank in (REFERENCE, STRUCTURE) or not best.proposal.link:
            return False
        for criterion in lost:
            if best.proposal.link in self._situation.own_chain(criterion.arguments.get("link")):
                return True
        return False

    def _gains(self, before: Edits, edits: Edits, against: _Results) -> tuple[_Gains, _Results]:
        """Return what edits gain, with the results.

        It is nothing where a criterion is worse with them.
        """
        after = self.trials.graded(before + edits, against)
        return list_gains(against, after), after
