"""Compare the grader's marks with the second opinion: `python -m tests.second_opinion N [FIRST SEED]`."""

import time
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from itertools import islice
from multiprocessing import Pool
from typing import NamedTuple
from xml.etree import ElementTree as ET

import numpy as np

from grader.lab.authoring.rubric_test import Trial
from grader.lab.grading.deciding import decide
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.rubric import Rubric as GraderRubric
from grader.lab.rubric.rubric import load_rubric
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.reader import read_urdf
from grader.ros.xml.xml_problems import RECOVERED
from tests.second_opinion.elements import Unclear
from tests.second_opinion.opinion import Opinion, Rubric
from tests.second_opinion.robot import Robot
from tests.second_opinion.robots import random_robot
from tests.xacro import oracle
from tests.xacro.documents.document import Document

MAX_SHOWN = 100
_SAME = 1e-9
# The grader measures an overlap in steps of a tenth of a millimetre, and none that is within the tolerance.
_LESS_EXACT = {"clear_of": 1e-4}


class Comparison(NamedTuple):
    """What was compared of one robot: the numbers of criteria by kind of agreement, and the disagreements."""

    name: str
    counts: Counter[str]
    different: list[str]


@cache
def _rubric(name: str) -> tuple[Rubric, GraderRubric]:
    return Rubric(name), load_rubric(name)


def compared(
    name: str, rubric: str, text: bytes, results: Iterable[Result] | None = None
) -> Comparison:
    """Compare the results of a robot, by default those of grading its text alone."""
    own, graders = _rubric(rubric)
    reading = read_urdf(text)
    is_assumed = any(problem.kind is RECOVERED for problem in reading.problems)
    report = grade(graders, read_submission(text, identity="student", path="robot.urdf"))
    if report.meant is not None:  # all criteria but the one that pays are judged on other words
        urdf = report.meant.submission.urdf
        assert isinstance(urdf, Read)
        text = urdf.data
        results = as_ros_reads_it(report, report.meant.submission)
    elif results is None:
        results = as_ros_reads_it(report, report.submission)
    found = {result.criterion.id: result for result in results}
    try:
        opinions = own.opinions(Robot(text))
    except ET.ParseError:
        return Comparison(name, Counter({"no XML": 1}), [])
    except Unclear:
        is_assumed = True
    if is_assumed:
        status = found["urdf-loads"].outcome.status
        return Comparison(
            name,
            Counter({"only refused": 1}),
            [] if status == "failed" else [f"urdf-loads: {status}, not failed"],
        )
    verdicts = [(key, *_agreement(found[key], opinion)) for key, opinion in opinions.items()]
    different = [f"{key}: {text}" for key, kind, text in verdicts if kind == "different"]
    return Comparison(name, Counter(kind for _, kind, _ in verdicts), different)


def as_ros_reads_it(report: Report, submission: Submission) -> Sequence[Result]:
    """Return the results without what is judged as written of elements that ROS 2 drops."""
    return [*decide(report.rubric, submission, {it.criterion.id for it in report.results})]


def _agreement(result: Result, opinion: Opinion) -> tuple[str, str]:
    """Return the kind of agreement, and how a criterion differs."""
    outcome = result.outcome
    status = "carried" if result.carried else outcome.status
    if opinion.status == "unsure":
        return "unsure", ""
    if status != opinion.status:
        return (
            "different",
            f"{status} {outcome.measured}, opinion {opinion.status} {opinion.measured}: {outcome.message}",
        )
    check = result.criterion.check.name
    if (
        outcome.measured is None
        or opinion.measured is None
        or (check in _LESS_EXACT and status == "passed")
    ):
        return "same status", ""
    limit = _LESS_EXACT.get(check, _SAME)
    values = [np.ravel(np.asarray(value, float)) for value in (outcome.measured, opinion.measured)]
    scale = max(1.0, float(np.abs(values[0]).max()))
    if len(values[0]) == len(values[1]) and np.abs(values[0] - values[1]).max() <= limit * scale:
        return "same value", ""
    return (
        "different",
        f"measured {outcome.measured}, opinion {opinion.measured}: {outcome.message}",
    )


def _of_seed(seed: int) -> Comparison:
    robot = random_robot(seed)
    return compared(f"seed {seed}", robot.rubric, robot.text)


def compared_seeds(seeds: Iterable[int], processes: int = 1) -> Iterator[Comparison]:
    """Yield the comparisons of the robots of seeds."""
    if processes == 1:
        yield from map(_of_seed, seeds)
        return
    with Pool(processes) as pool:
        yield from pool.imap(_of_seed, seeds, chunksize=100)


def compared_mutants(rubric: str, step: int = 1) -> Iterator[Comparison]:
    """Yield the comparisons of mutants of the robot of a rubric's reference; xacro itself expands those in xacro."""
    trial = Trial(_rubric(rubric)[1])
    texts = {path: trial.text(path) for path in trial.robot_files}
    for mutant in islice(trial.mutants(), None, None, step):
        submission = (
            trial.submission(mutant) if mutant.path in texts and not mutant.is_deleted else None
        )
        if submission is None:
            continue
        files: dict[str, str | bytes] = {**texts, mutant.path: mutant.applied(texts[mutant.path])}
        expanded = oracle.expand(
            Document(str(files[trial.robot_files[0]]), files, path=trial.robot_files[0])
        )
        results = list(trial.results(mutant, submission))
        if isinstance(expanded, oracle.Accepted):
            yield compared(
                mutant.id, rubric, expanded.text.encode("utf-8", "surrogateescape"), results
            )
        else:
            yield Comparison(mutant.id, Counter({"no XML": 1}), [])


def summary(comparisons: Iterable[Comparison]) -> tuple[list[str], int]:
    """Return the lines that say how many robots and criteria agree, and the number of disagreements."""
    start, robots, counts, shown, number = time.monotonic(), 0, Counter[str](), list[str](), 0
    for comparison in comparisons:
        robots += 1
        counts += comparison.counts
        number += len(comparison.different)
        shown += [f"{comparison.name}: {text}" for text in comparison.different][
            : MAX_SHOWN - len(shown)
        ]
    same = counts["same value"] + counts["same status"]
    lines = [
        f"{robots} robots, {same + counts['different']} criteria compared, {same} agree ({counts['same value']} with the value), {number} differ",
        f"not compared: {counts['unsure']} criteria that depend on random positions",
        f"not compared: all but the loading of {counts['only refused']} robots that ROS 2 refuses, all of {counts['no XML']} that are no XML, or that xacro refuses",
        f"{time.monotonic() - start:.0f} s",
    ]
    return lines + shown, number
