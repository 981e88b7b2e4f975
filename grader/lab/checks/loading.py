"""The check of whether ROS 2 loads the URDF."""

from collections.abc import Iterable

from grader.base.problems import Problem, kinds_in
from grader.base.source import Location
from grader.base.text import counted, enumerated, sentence_end
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, passed, pending
from grader.ros.urdf.reader import Reading
from grader.ros.xml import xml_problems

ABOUT = {"urdf_loads": About(("joint", "link"), is_of_writing=True)}

_MAX_ASSUMED = 3  # that a message names
_OF_XML = kinds_in(vars(xml_problems).values())


def urdf_loads(urdf: Reading) -> Outcome:
    """ROS 2 loads the URDF, and all links form one tree."""
    problems = [
        problem
        for problem in urdf.problems
        if problem.kind.effect == "rejects" or problem.kind.detaches_links
    ]
    raw = urdf.raw_xacro
    if raw and urdf.verdict != "clean":
        return _raw_xacro_failure(urdf, raw)
    if not problems and urdf.verdict != "rejected":
        return passed("ROS 2 loads the file, and all links form one tree")
    undetermined = [problem for problem in urdf.problems if problem.kind.effect == "undetermined"]
    if undetermined and not problems:
        return pending(
            f"{undetermined[0].message}; needs manual grading",
            undetermined[0].message,
            undetermined[0].location,
        )
    return _fail_loading(urdf, problems)


def _fail_loading(urdf: Reading, problems: list[Problem]) -> Outcome:
    """Return the failure of a URDF that ROS 2 does not load as one tree, with its first cause."""
    problems.sort(key=lambda problem: (not problem.kind.is_before_ros, problem.kind not in _OF_XML))
    causes = [problem for problem in problems if not problem.kind.is_consequence]
    first = (causes or problems or list(urdf.problems))[0]
    if len(problems) > 1:
        others = f" (and {counted(len(problems) - 1, 'more such problem')})"
    else:
        others = ""
    message = f"{first.message}{others}"
    if assumed := _list_assumed(urdf):
        what = "The rest is graded with this correction" if urdf.is_meant else "Assumed"
        message = f"{sentence_end(message)} {what}: {assumed}"
    outcome = failed(message, first.location, problem=first.message)
    return outcome._replace(mistake=f"{first.code}: {first.kind.title}")


def _list_assumed(urdf: Reading) -> str:
    """Return what is assumed about a file that ROS 2 rejects, each with its lines.

    It is empty if nothing is.
    """
    assumed = []
    for problem in urdf.problems:
        if problem.kind is xml_problems.RECOVERED and not problem.subject:
            assumed.append((problem.message, problem.location))
    return list_with_lines(assumed)


def list_with_lines(assumed: Iterable[tuple[str, Location]]) -> str:
    """Return sentences on places as one text, each sentence once and with its lines."""
    lines: dict[str, dict[str, None]] = {}
    for sentence, at in assumed:
        lines.setdefault(sentence, {})[str(at.line)] = None
    texts = []
    for sentence, numbers in lines.items():
        word = "line" if len(numbers) == 1 else "lines"
        texts.append(f"{sentence} ({word} {enumerated(numbers, _MAX_ASSUMED)})")
    return enumerated(texts, _MAX_ASSUMED)


def _raw_xacro_failure(urdf: Reading, raw: Problem) -> Outcome:
    """Return the failure of xacro that is loaded without xacro, with what ROS 2 does about it."""
    lost = (
        problem.message for problem in urdf.problems if problem.kind.effect in ("rejects", "drops")
    )
    effect = next(lost, "ROS 2 ignores its tags, and the robot lacks what they stand for")
    outcome = failed(f"{raw.message}: {effect}", raw.location, problem=raw.message)
    return outcome._replace(mistake=f"{raw.code}: {raw.kind.title}")
