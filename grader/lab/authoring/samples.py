"""Sample submissions: folders with an expected.toml, which says what their report must be."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Literal, NamedTuple

from grader.base.errors import InputError
from grader.base.grouping import StringsByName
from grader.base.names import did_you_mean
from grader.base.text import printable_path
from grader.base.toml_file import KeyTable, TomlRowReader, raise_complaints, read_toml
from grader.base.toml_types import toml_type
from grader.files.reading import read_capped
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Result
from grader.lab.rubric.keys import NAMES
from grader.lab.rubric.rubric import Rubric
from grader.lab.submission.opening import open_submission
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read

_EXPECTED = "expected.toml"
_TEXT = toml_type(str)
_VERDICT = toml_type(Literal["clean", "degraded", "rejected", "missing"])
_WORDS = {
    "lost": "loses its points",
    "carried": "fails without a deduction",
    "pending": "needs manual grading",
}
_TABLE = KeyTable(
    "sample",
    dict.fromkeys(("about", "path", "rubric"), _TEXT)
    | {"verdict": _VERDICT}
    | dict.fromkeys(_WORDS, NAMES),
)


class Loss(NamedTuple):
    """A submission with criteria that are not what they must be, each with its message."""

    name: str
    criteria: StringsByName
    diff: str = ""


class SampleResults(NamedTuple):
    """How many samples were graded, and what differs from their expected.toml.

    It also says how many belong to another rubric.
    """

    tried: int
    skipped: int
    different: Sequence[Loss] = ()


@dataclass(frozen=True, slots=True)
class Sample:
    """A folder with an expected.toml. All criteria that it does not name pass."""

    folder: Path
    about: str = ""
    path: str = ""  # of the submission in it; default: the folder
    rubric: str = ""  # the id of the only rubric that it is for
    verdict: str = ""  # that of ROS 2, if it matters
    lost: Sequence[str] = ()  # criteria that lose their points
    # criteria that keep them, because an earlier mistake makes them fail
    carried: Sequence[str] = ()
    pending: Sequence[str] = ()  # criteria that need manual grading


def read_samples(folder: Path) -> list[Sample]:
    """Return the samples in a folder by name.

    Raises RubricError for a broken expected.toml, InputError without any.
    """
    if not folder.is_dir():
        raise InputError(f"{printable_path(folder)} is not a folder with samples")
    samples = [_sample(path) for path in sorted(folder.glob(f"*/{_EXPECTED}"))]
    if not samples:
        raise InputError(
            f"{printable_path(folder)} has no samples: no folder in it has an {_EXPECTED}"
        )
    return samples


def _sample(path: Path) -> Sample:
    text, table = read_toml(read_capped(path, advice=""), path)
    reader = TomlRowReader()
    values = reader.row((), table, _TABLE)
    raise_complaints(reader.complaints, text, path)
    return Sample(path.parent, **values)


def tested_samples(
    rubric: Rubric, samples: list[Sample], show: Callable[[int], None]
) -> SampleResults:
    """Return which samples of a rubric differ from what they expect."""
    own_samples = [sample for sample in samples if sample.rubric in ("", rubric.id)]
    different = []
    for done, sample in enumerate(own_samples):
        show(done)
        differences = dict(_differences(sample, rubric))
        if differences:
            different.append(Loss(sample.folder.name, differences))
    return SampleResults(len(own_samples), len(samples) - len(own_samples), different)


def _differences(sample: Sample, rubric: Rubric) -> Iterator[tuple[str, str]]:
    """Yield what differs from the expected report.

    Each is a criterion that is not adjusted, or `verdict`, and a message.
    """
    try:
        submission = open_submission(str(sample.folder / sample.path), rubric.lab)
    except InputError as error:
        yield "submission", f"cannot be read: {error}"
        return
    verdict = submission.urdf.loaded.verdict if isinstance(submission.urdf, Read) else "missing"
    if sample.verdict not in ("", verdict):
        yield "verdict", f"is {verdict}, expected {sample.verdict}"
    yield from _differences_of_criteria(sample, rubric, submission)


def _differences_of_criteria(
    sample: Sample, rubric: Rubric, submission: Submission
) -> Iterator[tuple[str, str]]:
    """Yield the criteria whose results differ from the expected ones, each with a message."""
    expected = {}
    for kind, words in _WORDS.items():
        for name in getattr(sample, kind):
            expected[name] = words
    known = {criterion.id: not criterion.adjustment for criterion in rubric.criteria}
    for name in expected:
        if name not in known:
            yield name, f"the rubric has no such criterion{did_you_mean(name, known)}"
    graded = {
        result.criterion.id: (_actual(result), f": {result.outcome.message}")
        for result in grade(rubric, submission).results
    }
    for name in (name for name, counts in known.items() if counts):
        actual, message = graded.get(name, ("is not graded", ""))
        wanted = expected.get(name, "passes")
        if actual != wanted and (name in graded or name in expected):
            yield name, f"{actual}, expected: {wanted}{message}"


def _actual(result: Result) -> str:
    status = result.outcome.status
    kind: str = status
    if result.carried:
        kind = "carried"
    elif result.is_lost:
        kind = "lost"
    return _WORDS.get(kind, "passes" if status == "passed" else status)
