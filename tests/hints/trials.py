"""Search hints for submissions, and judge what was found."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from itertools import count
from typing import NamedTuple

from grader.base.source import Edit
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Result
from grader.lab.hints.edits import FoundHint
from grader.lab.hints.robot_draft import Draft
from grader.lab.hints.search import HintSearch, Trials, hints_on_slips, judged_results
from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.lab.submission.edited import content, with_files
from grader.lab.submission.opening import read_submission
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from tests.samples import LAB6, LAB6_SAMPLES, SAMPLES, reference


class Hints(NamedTuple):
    """What a search found for a submission: the criteria that lost points, the proven edits, and all of them together.

    `fixed` is the submission with all edits, `left` are the criteria that still lose points then.
    """

    submission: Submission
    lost: tuple[str, ...]
    found: list[FoundHint]
    fixed: Submission
    left: tuple[str, ...]
    steps: int

    @property
    def is_full(self) -> bool:
        """Whether nothing is lost any more with all edits."""
        return not self.left


@cache
def reference_draft(name: str) -> Draft | None:
    """Return the draft of the reference of a rubric."""
    urdf = reference(LAB6 if name == LAB6.id else load_rubric(name)).urdf
    assert isinstance(urdf, Read)
    return Draft.of(urdf.reading)


def hints_for(submission: Submission, rubric: Rubric = LAB6) -> Hints:
    """Return the hints for a submission; it is searched only if it lost points."""
    results = graded(submission, rubric)
    search = search_for(submission, results, rubric)
    budget = Trials(rubric, submission, results).left
    fixed = with_edits(submission, search.edits)
    return Hints(
        submission,
        _lost(results),
        search.found,
        fixed,
        _lost(graded(fixed, rubric)),
        budget - search.trials.left,
    )


def search_for(
    submission: Submission, results: Mapping[str, Result], rubric: Rubric = LAB6
) -> HintSearch:
    """Return the search for a submission with these results."""
    report = grade(rubric, submission)
    search = HintSearch(
        Trials(rubric, submission, judged_results(report)),
        reference_draft(rubric.id),
        lambda _: reference(rubric).package,
        slips=hints_on_slips(report),
    )
    return search.run() if _lost(results) else search


def graded(submission: Submission, rubric: Rubric = LAB6) -> dict[str, Result]:
    """Return the results of a submission by criterion."""
    return {result.criterion.id: result for result in grade(rubric, submission).results}


def _lost(results: Mapping[str, Result]) -> tuple[str, ...]:
    return tuple(name for name, result in results.items() if result.is_lost)


def with_edits(submission: Submission, edits: Iterable[Edit]) -> Submission:
    """Return a submission with edits, which are applied here: nothing of the search is trusted."""
    files: dict[str, bytes | None] = {}
    for path in {edit.path for edit in edits}:
        own = [edit for edit in edits if edit.path == path]
        files[path] = applied(
            content(submission, path) or b"", [edit for edit in own if not edit.renamed]
        )
        for edit in own:
            if edit.renamed:
                files[edit.renamed] = files[path]
                files[path] = None
    return with_files(submission, files) if files else submission


def applied(data: bytes, edits: Iterable[Edit]) -> bytes:
    """Return bytes after edits, each of which must find the old text where it says; at one place in their order."""
    lines = data.decode("utf-8", "surrogateescape").split("\n")
    if lines[0].startswith("\ufeff"):
        mark, lines[0] = "\ufeff", lines[0][1:]
    else:
        mark = ""
    text = "\n".join(lines)
    starts = [
        sum(len(line) + 1 for line in lines[: edit.line - 1]) + edit.column - 1 for edit in edits
    ]
    for start, _, edit in sorted(zip(starts, count(), edits, strict=False), reverse=True):
        assert text[start : start + len(edit.old)] == edit.old, edit
        text = text[:start] + edit.new + text[start + len(edit.old) :]
    return (mark + text).encode("utf-8", "surrogateescape")


class Base(NamedTuple):
    """A correct robot whose text is changed: a submission, and the path of the file."""

    name: str
    submission: Submission
    path: str
    text: str

    def changed(self, text: str) -> Submission:
        """Return the submission with another text of the file."""
        data = text.encode("utf-8", "surrogateescape")
        if self.submission.is_single:
            return read_submission(data, identity=self.name, path=self.path)
        return with_files(self.submission, {self.path: data})


def _alone(submission: Submission, urdf: Read) -> Submission:
    """Return the URDF without its package where that makes no difference: it is read faster."""
    return (
        submission
        if urdf.is_expanded
        else read_submission(urdf.data, identity=submission.id, path=urdf.path)
    )


def _bases() -> Iterator[Base]:
    """Yield the reference and every different text of the equivalents, the files that xacro includes as well."""
    texts: Counter[bytes] = Counter()
    for sample in [
        SAMPLES["reference"],
        *(SAMPLES[name] for name in LAB6_SAMPLES if name.startswith("equivalent-")),
    ]:
        submission = sample.open()
        urdf = submission.urdf
        assert isinstance(urdf, Read)
        paths = [urdf.path]
        if urdf.is_expanded:
            paths += [
                path
                for path in submission.whole_tree.files
                if path.endswith(".xacro") and path not in paths
            ]
        for path in paths:
            data = (
                urdf.data if path == urdf.path else submission.whole_tree.files[path].read(1 << 20)
            )
            texts[data] += 1
            if texts[data] == 1:
                name = sample.name if path == urdf.path else f"{sample.name}/{path}"
                yield Base(
                    name, _alone(submission, urdf), path, data.decode("utf-8", "surrogateescape")
                )


BASES = {base.name: base for base in _bases()}


def text_after(base: Base, hints: Hints) -> str:
    """Return the text of a base's file after all edits."""
    return (content(hints.fixed, base.path) or b"").decode("utf-8", "surrogateescape")
