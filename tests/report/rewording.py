"""The same report with other text wherever a student's text may be."""

from collections.abc import Callable
from dataclasses import replace

from grader.base.source import Location, Source
from grader.base.text import printable
from grader.files.tree import IgnoredFile
from grader.lab.grading.report import Hint, Report, Result
from grader.lab.submission.submission import Submission
from grader.report.content import other_problems
from grader.ros.package.package import Package
from grader.ros.package.robot_file import Absent, OtherCandidate, Read, Urdf

Words = Callable[[], str]


class Reworded(Submission):
    """A submission whose files all have the same text."""

    text: str = ""

    def source(self, path: str) -> Source:
        """Return the text, whatever the file."""
        return Source(path, self.text)


def recast(report: Report, words: Words) -> Report:
    """Return a report with the same results and other text: messages, notes, problems, paths, names, quoted lines."""

    def path() -> str:
        return f"a{printable(words())}"

    hints: dict[
        str, Hint
    ] = {}  # criteria with the same hint still have the same, and those with the same place
    places: dict[Location, Location] = {}
    problems = tuple(
        problem._replace(message=words(), location=Location(path(), 2, 3))
        for problem in other_problems(report)
    )
    return report._replace(
        submission=_submission(report.submission, words, path),
        results=tuple(_result(result, words, path, hints, places) for result in report.results),
        problems=problems,
        notes=tuple(words() for _ in report.notes),
        another_robot=f"a {words()}" if report.another_robot else "",
        evidence=tuple(
            file._replace(files=tuple(file._replace(path=path()) for file in file.files))
            for file in report.evidence
        ),
        other_pictures=tuple(other._replace(path=path()) for other in report.other_pictures),
    )


def _submission(old: Submission, words: Words, path: Words) -> Submission:
    return Reworded(
        words(),
        _urdf(old.urdf, words, path),
        tuple(OtherCandidate(path(), words()) for _ in old.unused_candidates),
        tree=replace(old.tree, ignored=tuple(IgnoredFile(path(), words()) for _ in old.ignored)),
        package=_package(old.package, words, path) if old.package is not None else None,
        lab_packages={
            name: _package(package, words, path) for name, package in old.lab_packages.items()
        },
        is_single=old.is_single,
        text="\n".join(f"<a b='{words()}'/>{words()}" for _ in range(3)),
    )


def _package(old: Package, words: Words, path: Words) -> Package:
    manifest = old.manifest._replace(name=words()) if old.manifest is not None else None
    return replace(old, folder=path() if old.folder else "", manifest=manifest)


def _urdf(old: Urdf, words: Words, path: Words) -> Urdf:
    """Return a URDF with another path, and other names of the robot, its links and joints."""
    if isinstance(old, Absent):
        return old
    if not isinstance(old, Read) or old.reading.robot is None:
        return old._replace(path=path())
    robot = old.reading.robot
    links = {link.name: f"{number}{words()}" for number, link in enumerate(robot.links)}
    joints = {joint.name: f"{number}{words()}" for number, joint in enumerate(robot.joints)}
    renamed = replace(
        robot,
        name=words(),
        links=tuple(link._replace(name=links[link.name]) for link in robot.links),
        joints=tuple(
            joint._replace(
                name=joints[joint.name],
                parent=links.get(joint.parent, joint.parent),
                child=links.get(joint.child, joint.child),
            )
            for joint in robot.joints
        ),
    )
    return old._replace(path=path(), reading=old.reading._replace(robot=renamed))


def _result(
    old: Result, words: Words, path: Words, known: dict[str, Hint], places: dict[Location, Location]
) -> Result:
    outcome, where = old.outcome, old.outcome.location
    if where is not None:
        where = places.setdefault(where, Location(f"{len(places)}{path()}", 1, 2))
    measured = f"found\n{words()}" if isinstance(outcome.measured, str) else outcome.measured
    hint = (
        known.setdefault(old.hint.message, _hint(old.hint, words, path))
        if old.hint is not None
        else None
    )
    mistake = outcome.mistake or outcome.message  # equal for what is about the same, as before
    renamed = outcome._replace(message=words(), measured=measured, location=where, mistake=mistake)
    return old._replace(outcome=renamed, hint=hint)


def _hint(old: Hint, words: Words, path: Words) -> Hint:
    edits = tuple(
        edit._replace(path=f"{number}{path()}", old=words(), new=words())
        for number, edit in enumerate(old.edits)
    )
    return old._replace(message=words(), edits=edits)
