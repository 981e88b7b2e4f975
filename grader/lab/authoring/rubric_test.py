"""Test a rubric.

Mutants of its reference must lose points, equivalents nothing, samples what they declare.

`Trial` grades changed copies of the reference; `run_rubric_test` counts what becomes of them.
"""

import re
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from difflib import unified_diff
from fnmatch import fnmatchcase
from functools import cached_property, lru_cache
from itertools import chain
from pathlib import Path
from posixpath import basename
from typing import Any, NamedTuple

from grader.base.errors import InputError
from grader.base.grouping import StringsByName
from grader.base.patterns import on_use
from grader.base.reuse import Memory
from grader.base.source import Source
from grader.files.reading import URDF_LIMIT
from grader.lab.authoring.equivalents import Equivalent, RewritingRules, equivalents, is_same_robot
from grader.lab.authoring.file_equivalents import EVERY_NODE, file_equivalents
from grader.lab.authoring.mutant_kinds import KindScore, draw, scores_by_kind, why_right
from grader.lab.authoring.mutants import Mutant, MutantEdit, mutants, package_mutants
from grader.lab.authoring.name_mutants import ComparedName, compared_names, name_changes
from grader.lab.authoring.node_equivalents import node_equivalents
from grader.lab.authoring.node_mutants import (
    default_changes,
    defaults_in,
    goal_changes,
    node_changes,
    type_changes,
)
from grader.lab.authoring.package_equivalents import BUILT_BY_CMAKE, package_equivalents
from grader.lab.authoring.recording_mutants import mutated_recording, recording_mutants
from grader.lab.authoring.samples import Loss, Sample, SampleResults, tested_samples
from grader.lab.checks.manual import MANUAL_CHECKS
from grader.lab.checks.registry import RECORDING_CHECKS
from grader.lab.grading.deciding import decide
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report, Result
from grader.lab.hints.search import is_worse
from grader.lab.rubric.criterion import Criterion
from grader.lab.rubric.rubric import Rubric, read_rubric
from grader.lab.submission.edited import content, text_of, with_files, with_urdf
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Lab, Submission
from grader.ros.package.package import MANIFEST, Package
from grader.ros.package.robot_file import Read
from grader.ros.urdf.link_tree import JOINT_OF
from grader.workspace.rules.rule_table import Family

_WORD = on_use(r"[\w@:.-]+")
_TEXTS = (
    ".py",
    ".xml",
    ".yaml",
    ".yml",
    ".rviz",
    ".launch",
    ".cfg",
    ".json",
    ".txt",
    ".world",
    ".sdf",
)


# The families of names on which checks of what is launched depend.
_CONNECTING: Mapping[str, tuple[Family, ...]] = {
    "connects": ("topics",),
    "topic_has_type": ("topics",),
    "reaches": ("services",),
    "publishes_transform": ("frames",),
}
# Documents, pictures, the tests of a package, and what rosbag2 says of a recording.
_NO_PART_OF_LAB = on_use(
    r"(?i)(^|/)(tests?|docs?)/|(^|/)(license|readme|changelog|contributing)[^/]*$"
    r"|\.(md|pdf|docx|png|jpe?g|gif|svg)$|(^|/)metadata\.yaml$"
)
_MAX_EMPTIED = 100  # files
_MAX_MUTANTS = 600  # by default; of more, a sample over all kinds is graded
GROUP = 5  # mutants that are graded at once, after which the progress is told
_MAX_KEPT = 64  # results that mutants share, such as the nodes of a package
_CONTEXT = 2  # lines around a change
# How many submissions of how many are graded, and the scores by kind so far.
_Progress = Callable[[int, int, Sequence[KindScore]], None]


class MutantOutcome(NamedTuple):
    """What the criteria made of a mutant: those that fail, and those that say nothing of it."""

    mutant: Mutant
    fate: str  # caught, same, survived, faulty or over budget
    failed: Sequence[str] = ()
    # With their messages: those that are faulty, or what is left open for lack of work.
    faults: Mapping[str, str] = {}


class Trial:
    """The reference of a rubric, graded. Manual checks and adjusted criteria do not count."""

    def __init__(self, rubric: Rubric) -> None:
        if not rubric.solution:
            missing = 'has no reference: add reference = "FOLDER" with a correct solution'
            raise InputError(f"the rubric {rubric.id} {missing}")
        self._memory = Memory(_MAX_KEPT)
        self.rubric = rubric
        self.reference = replace(rubric.solution.submission, memory=self._memory)
        self.report = grade(rubric, self.reference)
        self.expected = {
            result.criterion.id: result
            for result in self.report.results
            if not result.is_adjusted and result.criterion.check.function not in MANUAL_CHECKS
        }

    @cached_property
    def tested(self) -> list[Criterion]:
        """The criteria that the reference passes."""
        return [
            result.criterion
            for result in self.expected.values()
            if result.outcome.status == "passed"
        ]

    @cached_property
    def kept(self) -> set[str]:
        """The names that the rubric and the text files around the URDF refer to."""
        names = set(_names_in(self.rubric))
        for path, file in self.reference.whole_tree.files.items():
            if path.lower().endswith(_TEXTS) and file.size <= URDF_LIMIT:
                names |= set(_WORD.findall(self.text(path)))
        return names

    @cached_property
    def robot_files(self) -> Sequence[str]:
        """The URDF and the xacro files that it includes."""
        if not isinstance(self.reference.urdf, Read):
            return ()
        paths = [self.reference.urdf.path]
        others = [
            path
            for path in self.reference.whole_tree.files
            if path.lower().endswith((".urdf", ".xacro"))
        ]
        for path in paths:  # grows
            text = self.text(path)
            paths += [other for other in others if other not in paths and basename(other) in text]
        return paths

    def text(self, path: str) -> str:
        """Return the text of a file of the reference."""
        return text_of(self.reference, path)

    def unexamined(self) -> tuple[list[str], int]:
        """Return the files that no criterion needs, and how many were tried.

        They may be emptied or removed without a difference for any criterion.
        """
        files = self.reference.whole_tree.files.items()
        tried = [path for path, file in files if file.size and not _NO_PART_OF_LAB.search(path)][
            :_MAX_EMPTIED
        ]
        return [path for path in tried if not self._is_examined(path)], len(tried)

    def _is_examined(self, path: str) -> bool:
        if any(edit.path == path for _, edit in self._names):
            return True
        return any(self._differs(path, data) for data in (b"", None))

    def _differs(self, path: str, data: bytes | None) -> bool:
        """Return whether a criterion has another status with other bytes of a file.

        None removes it.
        """
        try:
            changed = with_files(self.reference, {path: data})
        except InputError:
            return True
        results = decide(self.rubric, changed, self.expected)
        return any(
            result.outcome.status != self.expected[result.criterion.id].outcome.status
            for result in results
        )

    def mutants(self) -> Iterator[Mutant]:
        """Yield the mutants of the robot, and those of the package that a criterion may look at."""
        hidden = [
            one.arguments.get("link", "")
            for one in self.tested
            if one.check.name == "shows_nothing"
        ]
        for path in self.robot_files:
            yield from mutants(self.text(path), path, hidden)
        if self.reference.package:
            yield from self._mutants_of_packages(self.reference.package)
        if any(criterion.check.name in RECORDING_CHECKS for criterion in self.tested):
            yield from recording_mutants(self.reference)

    def _mutants_of_packages(self, package: Package) -> Iterator[Mutant]:
        """Yield the mutants of the packages, the main one first, that a criterion may look at."""
        robot = self.reference.robot
        links = [link.name for link in robot.links] if robot else []
        packages = [
            lab_package
            for lab_package in self.reference.lab_packages.values()
            if lab_package.folder != package.folder
        ]
        for one in (package, *packages):
            prefix = "" if one is package else f"{one.name}/"
            made = package_mutants(one, links, self.text, self._name_changes, prefix=prefix)
            yield from filter(self._is_looked_at, made)

    def _name_changes(self, source: Source) -> Iterable[MutantEdit]:
        """Return the changes of names and values in a file, if a criterion compares them."""
        is_value_asked = any(criterion.check.name == "parameter_is" for criterion in self.tested)
        changes = [
            goal_changes(source, self._goals_asked),
            default_changes(source, self._defaults),
        ]
        if self._families or is_value_asked:
            changes.append(name_changes(source, self._names, self._families))
            changes.append(node_changes(self.reference, source, self._families))
            changes.append(type_changes(source, self._typed_topics))
        return chain.from_iterable(changes)

    @cached_property
    def _goals_asked(self) -> list[str]:
        """What is asked of the goals of actions, by the arguments of serves_action."""
        asked = set()
        for criterion in self.tested:
            if criterion.check.name == "serves_action":
                asked |= {name for name, value in criterion.arguments.items() if value is True}
        return sorted(asked)

    @cached_property
    def _defaults(self) -> StringsByName:
        """The defaults of the parameters that code has to use, as code has them."""
        asked = {
            criterion.arguments["parameter"]
            for criterion in self.tested
            if criterion.check.name == "uses_parameter"
        }
        return defaults_in(self.reference.workspace.code.nodes, asked)

    @cached_property
    def _typed_topics(self) -> frozenset[str]:
        """The last words of the topics whose types are asked for."""
        return frozenset(
            basename(criterion.arguments["topic"])
            for criterion in self.tested
            if criterion.check.name == "topic_has_type"
        )

    @cached_property
    def _families(self) -> Sequence[Family]:
        """The families of names that have to agree, or by which something connects."""
        families: dict[Family, None] = {}
        for criterion in self.tested:
            if criterion.check.name == "names_agree":
                families[criterion.arguments["of"]] = None
            families.update(dict.fromkeys(_CONNECTING.get(criterion.check.name, ())))
        return tuple(families)

    @cached_property
    def _names(self) -> list[ComparedName]:
        return list(compared_names(self.reference.renewed(), self._families))

    def _is_looked_at(self, mutant: Mutant) -> bool:
        """Return whether a criterion may look at a mutant of a package.

        Some look at its name or at meshes only.
        """
        subjects = {criterion.check.subject for criterion in self.tested}
        if "package" in subjects:
            return True
        if mutant.path.lower().endswith((".stl", ".dae", ".obj")):
            return any(criterion.check.name == "shows_mesh" for criterion in self.tested)
        return "submission" in subjects and mutant.path.endswith(MANIFEST)

    def submission(self, mutant: Mutant) -> Submission | None:
        """Return the reference with a mistake; None where nothing of it can be read any more.

        What does not depend on the changed file was read before.
        """
        data = mutant.applied(self.text(mutant.path)).encode("utf-8", "surrogateescape")
        if self._is_of_robot(mutant):
            return with_urdf(self.reference, {mutant.path: data})
        renamed = {mutant.renamed: content(self.reference, mutant.path)} if mutant.renamed else {}
        files = {mutant.path: None if mutant.is_deleted else data, **renamed}
        if mutant.mutation.startswith("record"):
            files = mutated_recording(self.reference, mutant)
        try:
            return replace(with_files(self.reference, files), memory=self._memory)
        except InputError:
            return None

    def results(self, mutant: Mutant, submission: Submission) -> list[Result]:
        """Return the results of the criteria that a mutant can change.

        Of the robot only the URDF is read again.
        """
        is_of_robot = self._is_of_robot(mutant)
        names = [
            name
            for name, result in self.expected.items()
            if not is_of_robot or result.criterion.check.subject != "package"
        ]
        return list(decide(self.rubric, submission, names))

    def _is_of_robot(self, mutant: Mutant) -> bool:
        return mutant.path in self.robot_files and not mutant.is_deleted

    def is_lost(self, result: Result) -> bool:
        """Return whether a criterion has less than on the reference."""
        return is_worse(self.expected[result.criterion.id], result)

    def outcome(self, mutant: Mutant) -> MutantOutcome:
        """Grade a mutant."""
        submission = self.submission(mutant)
        if not submission:
            return MutantOutcome(mutant, "caught")
        results = self.results(mutant, submission)
        lost = [result for result in results if self.is_lost(result)]
        faults = _messages(results, "errored")
        undecided = _messages(lost, "pending")
        if faults:
            fate = "faulty"
        elif submission.is_over_budget and len(undecided) == len(lost) > 0:
            fate = "over budget"
            faults = undecided
        elif lost:
            fate = "caught"
        elif self._is_of_robot(mutant) and is_same_robot(
            self.reference.urdf, submission.urdf, self.kept
        ):
            fate = "same"
        else:
            fate = "survived"
        return MutantOutcome(mutant, fate, tuple(_messages(results, "failed")), faults)

    def equivalents(self) -> Iterator[Loss]:
        """Yield what each rewriting of the reference loses: most lose nothing."""
        urdf = self.reference.urdf
        if isinstance(urdf, Read) and urdf.loaded.verdict == "clean":
            yield from self._robot_equivalents(urdf)
        names = set(_names_in(self.rubric))
        reference = self.reference.renewed()
        rewritten = package_equivalents(reference, names, self.robot_files)
        of_nodes = node_equivalents(reference, names)
        for rewriting, texts in chain(file_equivalents(reference), rewritten, of_nodes):
            yield self._file_equivalent(rewriting, texts)

    def _file_equivalent(self, rewriting: str, texts: Mapping[str, str | None]) -> Loss:
        """Return what other texts of files lose; None for a file that is not there any more."""
        names = [one.id for one in self.tested if not _is_of_writing(one, rewriting)]
        files = {}
        diffs = []
        for path, text in texts.items():
            files[path] = None if text is None else text.encode("utf-8", "surrogateescape")
            diffs.append(_text_diff(path, self.text(path), text or ""))
        changed = with_files(self.reference, files)
        return Loss(rewriting, self._lost(changed, names), "\n".join(diffs))

    def _robot_equivalents(self, urdf: Read) -> Iterator[Loss]:
        root = urdf.reading.root
        if root is None:
            return
        has_places = any(
            name.startswith("@") and not name.startswith(JOINT_OF)
            for name in _names_in(self.rubric)
        )
        for equivalent in equivalents(root, RewritingRules(self.kept, has_places)):
            submission = _rewritten(self.reference, urdf, equivalent)
            lost = self._lost(submission, self._must_pass(submission, equivalent.rewriting))
            diff = ""
            if lost:
                diff = _text_diff(self.robot_files[0], equivalent.before, equivalent.text)
            yield Loss(equivalent.rewriting, lost, diff)

    def _lost(self, submission: Submission, names: Collection[str]) -> StringsByName:
        """Return the criteria that lose points, with their messages."""
        results = decide(self.rubric, submission, names)
        return {
            result.criterion.id: result.outcome.message
            for result in results
            if self.is_lost(result)
        }

    def _must_pass(self, submission: Submission, rewriting: str) -> Collection[str]:
        """Return the criteria on the robot that must still pass.

        For a URDF on its own, these are those that need no package.
        """
        others = ("package", "submission") if submission.is_single else ("package",)
        return [
            criterion.id
            for criterion in self.tested
            if criterion.check.subject not in others
            and rewriting not in criterion.check.about.breaks_under(criterion.arguments)
        ]


def _messages(results: Iterable[Result], status: str) -> dict[str, str]:
    """Return the messages of the criteria that have a status."""
    return {
        result.criterion.id: result.outcome.message
        for result in results
        if result.outcome.status == status
    }


def _is_of_writing(criterion: Criterion, rewriting: str) -> bool:
    """Return whether a criterion asks for what a rewriting of files changes."""
    check = criterion.check.name
    arguments = criterion.arguments
    if check == "entry_is":
        # A path names one of several nodes, or an entry of a file that is written anew.
        return rewriting == EVERY_NODE or "file" in arguments
    return (
        rewriting == BUILT_BY_CMAKE
        and check == "package_type"
        and bool(arguments.get("build_type"))
    )


def _rewritten(reference: Submission, urdf: Read, equivalent: Equivalent) -> Submission:
    """Return the reference with another text of its robot.

    A URDF that becomes xacro is graded on its own.
    """
    data = equivalent.text.encode()
    if not equivalent.is_xacro or (urdf.is_expanded and not urdf.as_it_stands):
        return with_urdf(reference, {urdf.path: data})
    name = basename(urdf.path)
    path = f"{name.removesuffix('.xacro')}.xacro"
    lab = Lab(path, distro=reference.distro)
    return read_submission(data, identity=reference.id, path=path, lab=lab)


def _names_in(rubric: Rubric) -> Iterator[str]:
    """Yield every text in the arguments of a rubric's checks, and the joints that it poses.

    Keys of tables are texts, too.
    """
    for criterion in rubric.criteria:
        yield from _texts_in(
            (
                criterion.arguments,
                criterion.at,
                [(one.arguments, one.at) for one in criterion.carried],
            )
        )


def _texts_in(value: Any) -> Iterator[str]:
    if isinstance(value, Mapping):
        value = [*value, *value.values()]
    if isinstance(value, str):
        yield value
        yield from re.findall(rf"{JOINT_OF}([^']+)", value)
    elif isinstance(value, Iterable):
        for item in value:
            yield from _texts_in(item)


_GradeAll = Callable[[Sequence[Mutant]], Iterable[MutantOutcome]]  # in any order


class _Survivor(NamedTuple):
    """A mutant that loses nothing: its diff, and why the rubric ignores it."""

    mutant: Mutant
    diff: str
    reason: str = ""


class _Rest(NamedTuple):
    """What is tried after the mutants."""

    equivalents: list[Loss]
    unexamined: list[str]
    files: int


class RubricTest(NamedTuple):
    """The result of testing a rubric."""

    reference: Report
    total: int  # mutants that exist
    tried: int  # mutants that were graded
    caught: int  # mutants that lose points
    same: int  # mutants that are the same robot
    survivors: Sequence[_Survivor]  # mutants that lose nothing
    ignored: Sequence[_Survivor]  # mutants that lose nothing, and that the rubric ignores
    unused: Sequence[str]  # patterns of [[test.ignore]] that match no mutant
    idle: Sequence[str]  # criteria that no mutant fails
    unexamined: Sequence[str]  # files that no criterion looks at
    files: int  # how many were tried
    faults: Sequence[Loss]  # mutants on which a check is faulty
    # mutants that lose nothing but what takes more work than one submission may use
    over_budget: Sequence[Loss]
    equivalents: Sequence[str]  # the rewritings that were tried
    losses: Sequence[Loss]  # equivalents that lose points
    samples: SampleResults | None = None  # None where no folder was given
    kinds: Sequence[KindScore] = ()  # without mutants that are ignored or right
    # by Ctrl-C: then the rest of the mutants, the equivalents and the files are not tried
    is_interrupted: bool = False

    @property
    def score(self) -> Decimal:
        """The mutation score: the percentage of the mutants that lose points.

        Those that are ignored do not count.
        """
        count = self.caught + len(self.survivors)
        if count:
            return Decimal(100 * self.caught) / count
        return Decimal(100)

    @property
    def lost(self) -> Sequence[str]:
        """The criteria that the reference does not pass.

        Extra credit and criteria for manual grading are not among them.
        """
        return [result.criterion.id for result in self.reference.unearned]

    @property
    def is_faulty(self) -> bool:
        """Return whether a check failed to give an outcome, on the reference or a mutant."""
        return bool(self.faults) or self.reference.fault != ""

    @property
    def is_sound(self) -> bool:
        """Return whether no correct robot loses anything, and each sample what it should."""
        return not (self.lost or self.losses or (self.samples and self.samples.different))


def run_rubric_test(
    rubric: Rubric,
    samples: list[Sample] | None,
    progress: _Progress,
    grade_all: _GradeAll,
    *,
    most: int = _MAX_MUTANTS,
    seed: int = 0,
) -> RubricTest:
    """Return the test of a rubric.

    Raises InputError without a readable reference, RubricError for wrong samples.

    `grade_all` grades mutants elsewhere, as `mutant_outcomes` does: all of at most `most`, else a
    sample that the seed draws.
    """
    trial = Trial(rubric)
    every = list(trial.mutants())
    chosen = draw(every, most, seed)
    total = len(chosen) + len(samples or ())
    if samples is not None:
        of_samples = tested_samples(rubric, samples, lambda done: progress(done, total, ()))
    else:
        of_samples = None
    outcomes = []
    rest = None
    try:
        for outcome in grade_all(chosen):
            outcomes.append(outcome)
            # Those of a group arrive at once: after the first of them, no time left is true.
            if len(outcomes) % GROUP == 0:
                scores = scores_by_kind(
                    (graded.mutant.mutation, graded.fate) for graded in outcomes
                )
                progress(len(samples or ()) + len(outcomes), total, scores)
        rest = _Rest(list(trial.equivalents()), *trial.unexamined())
    except KeyboardInterrupt:
        if not outcomes:
            raise
    return _counted(trial, every, outcomes, of_samples, rest)


def mutant_outcomes(data: bytes, path: str, mutants: Sequence[Mutant]) -> list[MutantOutcome]:
    """Grade mutants of the reference of the rubric in a file."""
    return list(map(_trial_from(data, path).outcome, mutants))


@lru_cache(maxsize=1)
def _trial_from(data: bytes, path: str) -> Trial:
    return Trial(read_rubric(data, Path(path)))


def _counted(
    trial: Trial,
    every: Sequence[Mutant],
    outcomes: Iterable[MutantOutcome],
    samples: SampleResults | None,
    rest: "_Rest | None",
) -> RubricTest:
    """Return the result of a test.

    `outcomes` are those of the mutants that were graded, in any order.
    """
    places = {mutant: place for place, mutant in enumerate(every)}
    graded = sorted(outcomes, key=lambda outcome: places[outcome.mutant])
    fates = Counter(outcome.fate for outcome in graded)
    survivors = []
    ignored = []
    unjudged: dict[str, list[Loss]] = {"faulty": [], "over budget": []}
    failed: set[str] = set()
    scored = []
    for outcome in graded:
        mutant = outcome.mutant
        failed.update(outcome.failed)
        if outcome.fate == "caught":
            scored.append((mutant.mutation, "caught"))
        if outcome.fate == "survived":
            survivor = _survivor(trial, mutant)
            scored.append((mutant.mutation, "ignored" if survivor.reason else "survived"))
            if survivor.reason:
                ignored.append(survivor)
            else:
                survivors.append(survivor)
        elif outcome.fate in unjudged:
            unjudged[outcome.fate].append(
                Loss(mutant.id, outcome.faults, _mutant_diff(trial, mutant))
            )
    idle = [criterion.id for criterion in trial.tested if criterion.id not in failed]
    is_interrupted = not rest
    equivalents, unexamined, files = rest or _Rest([], [], 0)
    names = [loss.name for loss in equivalents]
    losses = [loss for loss in equivalents if loss.criteria]
    return RubricTest(
        reference=trial.report,
        total=len(every),
        tried=len(graded),
        caught=fates["caught"],
        same=fates["same"],
        survivors=survivors,
        ignored=ignored,
        unused=tuple(_unused_patterns(trial.rubric, every)),
        idle=() if is_interrupted else idle,
        unexamined=unexamined,
        files=files,
        faults=unjudged["faulty"],
        over_budget=unjudged["over budget"],
        equivalents=names,
        losses=losses,
        samples=samples,
        kinds=scores_by_kind(scored),
        is_interrupted=is_interrupted,
    )


def _unused_patterns(rubric: Rubric, mutants: Sequence[Mutant]) -> Iterator[str]:
    """Yield the patterns of ignored mutants that no mutant matches."""
    for row in rubric.ignored:
        for pattern in row.mutants:
            if not any(_matches(mutant, pattern) for mutant in mutants):
                yield pattern


def _survivor(trial: Trial, mutant: Mutant) -> _Survivor:
    """Return a mutant that loses nothing, with a reason.

    This is why the rubric ignores it, or why it is right.
    """
    reason = why_right(mutant)
    for row in trial.rubric.ignored:
        if any(_matches(mutant, pattern) for pattern in row.mutants):
            reason = row.reason
            break
    return _Survivor(mutant, _mutant_diff(trial, mutant), reason)


def _mutant_diff(trial: Trial, mutant: Mutant) -> str:
    if mutant.is_deleted:
        if mutant.renamed:
            return f"rename {mutant.path} to {mutant.renamed}"
        return f"delete {mutant.path}"
    if mutant.mutation.startswith("record"):
        return mutant.id
    text = trial.text(mutant.path)
    return _text_diff(mutant.path, text, mutant.applied(text))


def _text_diff(path: str, before: str, after: str) -> str:
    """Return the unified diff of two texts of a file, without a line break at its end."""
    return "\n".join(
        unified_diff(before.splitlines(), after.splitlines(), path, path, n=_CONTEXT, lineterm="")
    )


def _matches(mutant: Mutant, pattern: str) -> bool:
    """Return whether a pattern is a mutant's id or matches it.

    Brackets in an id are a set of characters to fnmatch.
    """
    return mutant.id == pattern or fnmatchcase(mutant.id, pattern)
