"""Write a rubric from a reference solution, and test a rubric.

A test has its reference, equivalents, samples and mutants.
"""

import os
import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from functools import partial
from itertools import chain
from pathlib import Path

from grader.base.errors import GraderError, InputError
from grader.base.names import did_you_mean
from grader.base.text import enumerated, printable, printable_path, shell_quoted
from grader.classroom.run.preloading import PRELOAD
from grader.files.reading import URDF_LIMIT
from grader.lab.authoring.draft import Head, RubricDraft, draft
from grader.lab.authoring.draft_choice import WITHOUT, DraftChoice
from grader.lab.authoring.expectations import Omission, Solution
from grader.lab.authoring.mutant_kinds import KindScore
from grader.lab.authoring.mutants import Mutant
from grader.lab.authoring.recording_expectations import read_reference_recording
from grader.lab.authoring.rubric_test import (
    GROUP,
    MutantOutcome,
    Trial,
    mutant_outcomes,
    run_rubric_test,
)
from grader.lab.authoring.samples import read_samples
from grader.lab.checks.loading import urdf_loads
from grader.lab.rubric.rubric import Rubric
from grader.lab.rubric.rubric_files import load_named
from grader.lab.submission.opening import open_with_packages
from grader.lab.submission.submission import Submission
from grader.report.explanations import rubric_summary
from grader.report.formats import GraphFormat, render_graph
from grader.report.inspection import Inspection
from grader.report.invocation import ExitCode, read_threshold
from grader.report.shown_graph import ShownGraph
from grader.report.writers.rubric_test_result import (
    render_rubric_test,
    render_rubric_test_json,
    unexamined_line,
)
from grader.report.writing import Terminal, Warn, missing_folder, save_bytes
from grader.ros.api import MANIFEST, Absent, Configuration, Read, Unreadable
from grader.workers.pool import Processes, processors
from grader.workers.queue import Progress
from grader.workspace.api import STANDARD_INPUT, launch_files, launch_graph

_SCHEMA = "rubric.schema.json"  # beside the rubric, as the documentation calls it
_GRAPH = ".mmd"  # the ending of Mermaid
_MAX_IN_NOTE = 4  # files or criteria
_SECONDS = 60.0  # that a group of mutants may take


def draft_choice(
    without: Iterable[str],
    free: Iterable[str],
    *,
    is_names_only: bool,
    weights: str,
    total: int | None = None,
) -> DraftChoice:
    """Return what a draft has criteria about. Raises GraderError for a kind that does not exist.

    Args:
        without: Kinds that are omitted, also several in one text with commas.
        free: Names that the handout leaves open, likewise.
        is_names_only: Whether only names are compared.
        weights: equal, or importance.
        total: The points of all criteria; None for as many as there are.
    """
    kinds = frozenset(_split_texts(without))
    for kind in sorted(kinds.difference(WITHOUT)):
        guess = did_you_mean(kind, WITHOUT) or f"; there are: {', '.join(WITHOUT)}"
        raise GraderError(f"--without takes no {printable(kind)!r}{guess}")
    return DraftChoice(
        without=kinds,
        is_names_only=is_names_only,
        free=frozenset(_split_texts(free)),
        has_equal_weights=weights == "equal",
        total=total,
    )


def _split_texts(given: Iterable[str]) -> Iterator[str]:
    """Yield the words of options, of which several may be in one text, with commas."""
    for text in given:
        yield from filter(None, map(str.strip, text.split(",")))


def write_rubric(
    file: Path,
    reference: str,
    warn: Warn,
    choice: DraftChoice,
    *,
    force: bool,
    recording: Path | None = None,
) -> str:
    """Write a rubric of a reference's facts; return what it contains, omits, and the next step.

    A recording is in the reference, or it is the reference. Raises GraderError.
    """
    _check_target(file, force=force)
    if reference == STANDARD_INPUT:
        raise GraderError("--from takes a file or folder, which the rubric names as its reference")
    submission = open_with_packages(reference)
    recorded = None
    if recording:
        path = os.path.relpath(recording, reference).replace(os.sep, "/")
        recorded = read_reference_recording(submission, path)
    solution = _solution(submission, reference, warn, is_recorded=recording is not None)
    head = _rubric_head(file, reference, submission)
    made = draft(submission, solution, head, file, choice, recorded)
    if len(made.data) > URDF_LIMIT:
        raise GraderError(
            f"the reference has too many facts for a rubric: {len(made.rubric.criteria)} criteria"
        )
    save_bytes(file, made.data)
    drawn = _save_graph(file, submission)
    return "".join(f"{printable(line)}\n" for line in _result_lines(file, made, drawn))


def _save_graph(file: Path, submission: Submission) -> Path | None:
    """Write the graph of the reference beside a rubric, as Mermaid; None without a node."""
    launches = launch_files(submission.workspace) if submission.packages else []
    if not launches:
        return None
    graph = launch_graph(submission.workspace, launches[0])
    if not graph.nodes:
        return None
    shown = ShownGraph(graph, Inspection(submission.id))
    drawn = file.with_suffix(_GRAPH)
    save_bytes(drawn, render_graph(shown, GraphFormat.MERMAID).encode())
    return drawn


def _check_target(file: Path, *, force: bool) -> None:
    shown = printable_path(file)
    if file.suffix != ".toml":
        raise GraderError(f"a rubric is a .toml file: give a name that ends in .toml, not {shown}")
    for target in (file, file.with_suffix(_GRAPH)):
        if os.path.lexists(target) and not force:
            raise GraderError(
                f"{printable_path(target)} exists already: give another name, or --force to "
                "replace it"
            )
    if not file.parent.is_dir():
        raise missing_folder(file)


def _solution(
    submission: Submission, reference: str, warn: Warn, *, is_recorded: bool
) -> Solution | None:
    """Return the robot of the reference, which ROS 2 must load; None of others without one.

    Raises GraderError.
    """
    shown = printable_path(reference)
    match submission.urdf:
        case Absent() if submission.packages or is_recorded:
            return None
        case Absent():
            raise InputError(
                f"{shown} has neither a URDF nor a package: no file has a <robot>, none is "
                "a package.xml"
            )
        case Unreadable(reason=reason):
            raise InputError(reason)
        case Read(reading=reading, loaded=loaded):
            loading = urdf_loads(loaded)
            if not reading.robot or loading.status != "passed":
                reason = loading.mistake if loading.status == "pending" else loading.message
                advice = f"see `grader inspect {shell_quoted(reference)}`"
                raise InputError(f"{shown} is no reference solution: {reason} ({advice})")
            for problem in (
                problem for problem in submission.urdf.problems if problem.kind.effect == "drops"
            ):
                warn(f"{problem.location.file_and_line}: {problem.label}: {problem.message}")
    others = []
    for file in submission.unused_candidates:
        if not file.is_part and not file.path.endswith(MANIFEST):
            others.append(file.path)
    if others:
        warn(
            f"the rubric is made from {submission.path}; other candidates: "
            f"{enumerated(others, _MAX_IN_NOTE)}"
        )
    return Solution(submission, reading, Configuration(reading.robot))


def _rubric_head(file: Path, reference: str, submission: Submission) -> Head:
    words = re.sub(r"[\s_-]+", " ", printable(file.stem)).strip() or "lab"
    place = _relative(Path(reference), file.parent)
    package = submission.package
    path = submission.path or ""
    if package and package.holds(path):
        path = path.removeprefix(package.path(""))
    names = tuple(lab_package.name for lab_package in submission.lab_packages.values())
    schema = f"./{_SCHEMA}" if (file.parent / _SCHEMA).is_file() else ""
    title = words[0].upper() + words[1:]
    return Head(words.replace(" ", "-"), title, place, path, names, schema, submission.distro)


def _relative(reference: Path, folder: Path) -> str:
    """Return the path of the reference as a rubric in a folder names it.

    Raise GraderError if it is no text.
    """
    try:
        path = os.path.relpath(reference.resolve(), folder.resolve())
    except ValueError:  # on another drive
        path = str(reference.resolve())
    try:
        path.encode()
    except UnicodeEncodeError:
        raise GraderError(f"the path {printable_path(path)} is not UTF-8: rename it") from None
    return path.replace(os.sep, "/")


def _result_lines(file: Path, made: RubricDraft, drawn: Path | None) -> Iterator[str]:
    yield (
        f"wrote {printable_path(file)}: {rubric_summary(made.rubric)}; its reference gets full "
        "marks"
    )
    if made.rubric.reference.startswith(("..", "/")):
        yield (
            f"note: the reference is {made.rubric.reference}, outside the rubric's folder: move "
            "both together"
        )
    if drawn:
        yield f"wrote {printable_path(drawn)}: what the reference connects, as Mermaid"
    yield from (f"omitted: {line}" for line in _omission_lines(made.omissions))
    paths, count = Trial(made.rubric).unexamined()
    if paths:
        yield unexamined_line(paths, count)
    yield f"next: grader rubric test {shell_quoted(file)}"


def _omission_lines(omissions: Iterable[Omission]) -> Iterator[str]:
    """Yield what is omitted, in one line for each reason."""
    by_reason: dict[str, list[str]] = {}
    for omission in omissions:
        by_reason.setdefault(omission.why, []).append(omission.what)
    yield from (f"{enumerated(names, _MAX_IN_NOTE)}: {why}" for why, names in by_reason.items())


def test_rubric(
    name: str,
    folder: Path | None,
    fail_under: str | None,
    is_json: bool,
    terminal: Terminal,
    *,
    are_all_graded: bool,
    seed: int,
) -> tuple[str, ExitCode]:
    """Return the result of testing a rubric, and the exit code.

    All mutants are graded, or a sample that the seed draws.

    Raises GraderError for a broken rubric or one without a reference.
    """
    least = read_threshold(fail_under)[0] if fail_under is not None else 0
    rubric = load_named(name)
    samples = read_samples(folder) if folder else None
    with (
        terminal.show_class(f"Testing {rubric.id}") as show,
        Processes(processors(), _SECONDS, preload=PRELOAD) as executor,
    ):

        def progress(done: int, total: int, scores: Sequence[KindScore]) -> None:
            kinds = ", ".join(
                f"{score.kind} {100 * score.caught // score.graded} %" for score in scores
            )
            show(Progress(total, done, note=kinds))

        grade_all = partial(_graded, executor, rubric)
        if are_all_graded:
            result = run_rubric_test(rubric, samples, progress, grade_all, most=sys.maxsize)
        else:
            result = run_rubric_test(rubric, samples, progress, grade_all, seed=seed)
    if is_json:
        text = render_rubric_test_json(result)
    else:
        text = render_rubric_test(result, terminal.screen().width)
    if result.is_interrupted:
        return text, ExitCode.INTERRUPTED
    is_passed = result.is_sound and result.score >= least
    code = ExitCode.PASSED if is_passed else ExitCode.FAILED
    return text, ExitCode.FAULT if result.is_faulty else code


def _graded(
    executor: Processes, rubric: Rubric, mutants: Sequence[Mutant]
) -> Iterator[MutantOutcome]:
    """Yield the outcomes of mutants, which are graded in groups. Raises WorkerError."""
    groups = [mutants[at : at + GROUP] for at in range(0, len(mutants), GROUP)]
    return chain.from_iterable(
        executor.map(partial(mutant_outcomes, rubric.data, str(rubric.path)), groups)
    )
