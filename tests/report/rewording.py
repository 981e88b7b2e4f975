"""The same report with other text wherever a student's text may be."""

from collections.abc import Callable
from dataclasses import replace
from typing import NamedTuple, cast

from grader.grading.graded_submission import GradedPackage, GradedSubmission
from grader.grading.report import Hint, Report, Result
from grader.report.content import other_problems
from grader.source import Location, Source
from grader.submission.submission import Submission
from grader.submission.urdf import Absent, OtherCandidate, Read, Urdf
from grader.text import printable

Words = Callable[[], str]


class Reworded(NamedTuple):
    """The files of a submission, each with the same text."""

    text: str
    urdf: Urdf

    def source(self, path: str) -> Source:
        return Source(path, self.text)


def recast(report: Report, words: Words) -> Report:
    """Return a report with the same results and other text: messages, notes, problems, paths, names, quoted lines."""

    def path() -> str:
        return f"a{printable(words())}"

    hints: dict[str, Hint] = {}  # criteria with the same hint still have the same
    problems = tuple(
        problem._replace(message=words(), location=Location(path(), 2, 3)) for problem in other_problems(report)
    )
    return report._replace(
        submission=_submission(report.submission, words, path),
        results=tuple(_result(result, words, path, hints) for result in report.results),
        problems=problems,
        notes=tuple(words() for _ in report.notes),
        evidence=tuple(
            file._replace(files=tuple(replace(file, path=path()) for file in file.files)) for file in report.evidence
        ),
        other_pictures=tuple(replace(other, path=path()) for other in report.other_pictures),
    )


def _submission(old: GradedSubmission, words: Words, path: Words) -> GradedSubmission:
    text = "\n".join(f"<a b='{words()}'/>{words()}" for _ in range(3))
    urdf = _urdf(old.originals.urdf, words) if old.originals is not None else Absent()
    return GradedSubmission(
        words(),
        path() if old.path is not None else None,
        old.sha256,
        GradedPackage(path() if old.package.folder else "", words()) if old.package is not None else None,
        tuple(OtherCandidate(path(), words()) for _ in old.other_candidates),
        tuple(words() for _ in old.ignored),
        old.has_urdf,
        old.verdict,
        old.is_single,
        "unread" if old.unread else "",
        another_robot=f"a {words()}" if old.another_robot else "",
        originals=cast("Submission", Reworded(text, urdf)),
    )


def _urdf(old: Urdf, words: Words) -> Urdf:
    """Return a URDF with other names of the robot, its links and joints."""
    if not isinstance(old, Read) or old.reading.robot is None:
        return old
    robot = old.reading.robot
    links = {link.name: f"{number}{words()}" for number, link in enumerate(robot.links)}
    joints = {joint.name: f"{number}{words()}" for number, joint in enumerate(robot.joints)}
    renamed = replace(
        robot,
        name=words(),
        links=tuple(replace(link, name=links[link.name]) for link in robot.links),
        joints=tuple(
            replace(
                joint,
                name=joints[joint.name],
                parent=links.get(joint.parent, joint.parent),
                child=links.get(joint.child, joint.child),
            )
            for joint in robot.joints
        ),
    )
    return old._replace(reading=old.reading._replace(robot=renamed))


def _result(old: Result, words: Words, path: Words, known: dict[str, Hint]) -> Result:
    outcome = old.outcome
    where = Location(path(), 1, 2) if outcome.location is not None else None
    measured = f"found\n{words()}" if isinstance(outcome.measured, str) else outcome.measured
    hint = known.setdefault(old.hint.message, _hint(old.hint, words, path)) if old.hint is not None else None
    mistake = outcome.mistake or outcome.message  # equal for what is about the same, as before
    renamed = outcome._replace(message=words(), measured=measured, location=where, mistake=mistake)
    return old._replace(outcome=renamed, hint=hint)


def _hint(old: Hint, words: Words, path: Words) -> Hint:
    edits = tuple(
        edit._replace(path=f"{number}{path()}", old=words(), new=words()) for number, edit in enumerate(old.edits)
    )
    return old._replace(message=words(), edits=edits)
