"""Equal and nearly equal work: submissions with the same URDF or robot. It is no verdict."""

from collections import defaultdict
from collections.abc import Collection, Iterable
from itertools import starmap
from typing import NamedTuple

from grader.base.grouping import Strings
from grader.classroom.results.results import StoredResult
from grader.files.reading import hash_bytes
from grader.lab.checks.registry import GRAPH_CHECKS, RECORDING_CHECKS
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.submission import Submission
from grader.ros.api import Read, robot_hash, written_form

# students, or a tenth of the class: what more have in common comes from the handout
_MAX_SHARING = 4
_DIGITS = 16  # of a hash
_LABELS = {
    "urdf": "the same file",
    "recording": "the same recording",
    "robot": "the same robot",
    "written": "the same links, joints and materials",
    "graph": "the same graph of nodes, but for names",
}


class EqualWork(NamedTuple):
    """Students with work that is equal, and what of it is: "the same file"."""

    students: Strings
    equal: str


def hash_forms(
    submission: Submission, rubric: Rubric, *, is_handed_out: bool = False
) -> dict[str, str]:
    """Return the hashes of the forms of a robot and a graph, without what is empty.

    `urdf` is that of the file, `robot` that of its normal form, `written` that of its links, joints
    and materials as written; `graph` that of what its first launch file connects, without names, if
    a rubric asks about the graph; `recording` that of its longest recording, if a rubric asks
    about recordings.
    """
    urdf = submission.urdf
    forms = dict[str, str]()
    if isinstance(urdf, Read):
        if urdf.data.strip():
            forms |= {"urdf": hash_bytes(urdf.data), "robot": robot_hash(urdf.reading)}
        forms["written"] = written_form(urdf.reading.elements, is_handed_out=is_handed_out)
    if any(criterion.check.name in GRAPH_CHECKS for criterion in rubric.criteria):
        from grader.workspace.api import (  # late: few labs ask
            graph_form,
            launch_files,
            launch_graph,
        )

        launches = launch_files(submission.workspace) if submission.packages else []
        if launches:
            forms["graph"] = graph_form(launch_graph(submission.workspace, launches[0]))
    if any(criterion.check.name in RECORDING_CHECKS for criterion in rubric.criteria):
        from grader.ros.api import read_longest_recording  # late: few labs ask

        recording = read_longest_recording(submission.tree)
        forms["recording"] = recording.hash if recording else ""
    return {name: form[:_DIGITS] for name, form in forms.items() if form}


def hash_handed_out(submission: Submission, rubric: Rubric) -> Strings:
    """Return the hashes of work that is no equal work, as the course handed it out."""
    return tuple(hash_forms(submission, rubric, is_handed_out=True).values())


def equal_work(results: Iterable[StoredResult], handed_out: Iterable[str]) -> list[EqualWork]:
    """Return the groups of students with equal work, without what the course handed out.

    The same file comes first, then the same recording, the same robot, the same elements, and the
    same graph. A recording is nobody else's, also of a robot that the course handed out.
    """
    known = {*handed_out}
    works = [stored for stored in results if stored.work]
    most = max(_MAX_SHARING, len(works) // 10)
    own_works = [
        stored
        for stored in works
        if known.isdisjoint((stored.work.get("urdf"), stored.work.get("robot")))
    ]
    label_of: dict[Strings, str] = {}
    for kind, label in _LABELS.items():
        for group in _groups(works if kind == "recording" else own_works, kind, known):
            robots = {stored.work.get("robot") for stored in group}
            is_rare = len(group) <= most and (kind == "graph" or len(robots) > 1)
            if kind not in ("written", "graph") or is_rare:
                label_of.setdefault(tuple(stored.student for stored in group), label)
    return list(starmap(EqualWork, label_of.items()))


def _groups(
    results: Iterable[StoredResult], kind: str, known: Collection[str]
) -> list[list[StoredResult]]:
    """Return the groups whose hash of one kind is the same, the largest first.

    It is not known, and the works come from more than one submission.
    """
    groups = defaultdict(list)
    for stored in results:
        form = stored.work.get(kind, "")
        if form and form not in known:
            groups[form].append(stored)
    several = []
    for group in groups.values():
        submissions = {(stored.root, stored.paths) for stored in group}
        if len(submissions) > 1:  # members of a team share one
            several.append(group)
    return sorted(several, key=lambda group: (-len(group), [stored.student for stored in group]))
