"""Grade mutants of a reference: of the robot only the URDF is read again, else everything. Find names in rubrics."""

import re
from collections.abc import Collection, Iterator, Mapping
from functools import cached_property
from typing import Any

from grader.checks.manual import MANUAL_CHECKS
from grader.errors import InputError
from grader.files.reading import URDF_LIMIT
from grader.grading.deciding import decide
from grader.grading.hints.trials import is_worse
from grader.grading.report import Report, Result
from grader.grading.rubric import Rubric
from grader.mutation.mutants import Mutant
from grader.mutation.sameness import is_same_robot
from grader.submission.editing import content, with_files, with_urdf
from grader.submission.submission import Submission
from grader.submission.urdf import Read

_WORD = re.compile(r"[\w@:.-]+")
_TEXTS = (".py", ".xml", ".yaml", ".yml", ".rviz", ".launch", ".cfg", ".json", ".txt", ".world", ".sdf")


def names_in(rubric: Rubric) -> set[str]:
    """Return every text in the arguments of a rubric's checks, also keys of tables, and the joints that it poses."""
    used = [(it.arguments, it.at, [one.arguments for one in it.carried]) for it in rubric.criteria]
    return set(_texts(used))


def words_in_files(submission: Submission) -> set[str]:
    """Return the words in the text files around a URDF: launch files, configurations of controllers and of RViz."""
    found: set[str] = set()
    for path, file in submission.whole_tree.files.items():
        if path.lower().endswith(_TEXTS):
            try:
                found |= set(_WORD.findall(file.read(URDF_LIMIT).decode("utf-8", "replace")))
            except InputError:
                continue
    return found


def _texts(value: Any) -> Iterator[str]:
    """Yield the texts in the arguments of a check, also the keys of tables."""
    if isinstance(value, str):
        yield value
    elif isinstance(value, Mapping):
        yield from _texts([*value, *value.values()])
    elif isinstance(value, list | tuple):
        for item in value:
            yield from _texts(item)


_OF_ROBOT = (".urdf", ".xacro")


class Trial:
    """The reference of a rubric, and the results of its criteria for changed copies.

    Manual checks and adjusted criteria do not count.
    """

    def __init__(self, report: Report, reference: Submission) -> None:
        self.report, self.rubric, self.reference = report, report.rubric, reference
        counting = (found for found in report.results if not found.is_adjusted)
        own = (found for found in counting if found.criterion.check.function not in MANUAL_CHECKS)
        self.expected: Mapping[str, Result] = {found.criterion.id: found for found in own}
        self.of_robot = {name for name, found in self.expected.items() if found.criterion.check.subject != "package"}

    @property
    def tested(self) -> list[str]:
        """The criteria that the reference passes."""
        return [name for name, found in self.expected.items() if found.outcome.status == "passed"]

    @cached_property
    def kept(self) -> set[str]:
        """The names that the rubric and the files around the URDF refer to."""
        return names_in(self.rubric) | words_in_files(self.reference)

    @cached_property
    def robot_files(self) -> tuple[str, ...]:
        """The URDF and the xacro files that it includes."""
        if not isinstance(self.reference.urdf, Read):
            return ()
        found = [self.reference.urdf.path]
        others = [path for path in self.reference.whole_tree.files if path.lower().endswith(_OF_ROBOT)]
        for path in found:  # grows
            text = self.text(path)
            found += [other for other in others if other not in found and other.rpartition("/")[2] in text]
        return tuple(found)

    def text(self, path: str) -> str:
        """Return the text of a file of the reference."""
        return (content(self.reference, path) or b"").decode("utf-8", "surrogateescape")

    def submission(self, mutant: Mutant) -> Submission | None:
        """Return the reference with a mistake; None where nothing of it can be read any more."""
        if mutant.renamed or mutant.is_deleted:
            file = self.reference.whole_tree.files[mutant.path]
            files = {mutant.path: None, **({mutant.renamed: file.read(file.size)} if mutant.renamed else {})}
        else:
            files = {mutant.path: mutant.applied(self.text(mutant.path)).encode("utf-8", "surrogateescape")}
            if mutant.path in self.robot_files:
                return with_urdf(self.reference, files)
        try:
            return with_files(self.reference, files)
        except InputError:
            return None

    def results(self, mutant: Mutant, submission: Submission, wanted: Collection[str]) -> Iterator[Result]:
        """Yield the results of the wanted criteria that a mutant can change."""
        names = self.of_robot.intersection(wanted) if self._is_of_robot(mutant) else wanted
        yield from decide(self.rubric, submission, names)

    def _is_of_robot(self, mutant: Mutant) -> bool:
        return mutant.path in self.robot_files and not (mutant.renamed or mutant.is_deleted)

    def is_lost(self, result: Result) -> bool:
        """Return whether a criterion has less than on the reference."""
        return is_worse(self.expected[result.criterion.id], result)

    def is_same(self, mutant: Mutant, submission: Submission) -> bool:
        """Return whether a mutant is the same robot as the reference."""
        return self._is_of_robot(mutant) and is_same_robot(self.reference.urdf, submission.urdf, self.kept)
