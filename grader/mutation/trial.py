"""Grade mutants of a reference: of the robot only the URDF is read again, of other files everything."""

from collections.abc import Collection, Iterator, Mapping
from functools import cached_property

from grader.checks.manual import MANUAL_CHECKS
from grader.errors import InputError
from grader.grading.deciding import decide
from grader.grading.hints.trials import is_worse
from grader.grading.report import Report, Result
from grader.mutation.mutants import Mutant
from grader.mutation.references import names_in, words_in_files
from grader.mutation.sameness import is_same_robot
from grader.submission.editing import content, with_files, with_urdf
from grader.submission.submission import Submission
from grader.submission.urdf import Read

_OF_ROBOT = (".urdf", ".xacro")


class Trial:
    """The reference of a rubric, and the results of its criteria for changed copies.

    Manual checks and adjusted criteria do not count.
    """

    def __init__(self, report: Report, reference: Submission) -> None:
        self.rubric, self.reference = report.rubric, reference
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
        others = [path for path in self.reference.everything.files if path.lower().endswith(_OF_ROBOT)]
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
            file = self.reference.everything.files[mutant.path]
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
