"""The reference solution of a rubric."""

from collections.abc import Callable
from functools import cached_property
from pathlib import Path

from grader.errors import InputError
from grader.files.reading import read_capped
from grader.robot.kinematics import Configuration
from grader.robot.reader import Reading, find_xacro, read_urdf
from grader.submission.opening import open_submission
from grader.submission.submission import Lab, Submission


class ReferenceSolution:
    """A rubric's own solution; no more is read than is needed. Properties raise InputError where it cannot be read."""

    def __init__(self, path: Path, lab: Lab, missing: Callable[[], str]) -> None:
        self._path, self._lab, self._missing = path, lab, missing

    @cached_property
    def submission(self) -> Submission:
        """The solution as a submission."""
        if not self._path.exists():
            raise InputError(self._missing())
        return open_submission(str(self._path), self._lab)

    @cached_property
    def reading(self) -> Reading:
        """Its URDF; the rest is not read where the URDF is known and is no xacro."""
        file = self._path / self._lab.urdf
        if file.suffix == ".urdf" and file.is_file():
            reading = read_urdf(read_capped(file), self._lab.urdf)
            if find_xacro(reading.source.text) is None:
                return reading
        try:
            return self.submission.needed_urdf()
        except LookupError as error:
            raise InputError(f"the reference {self._path} cannot be compared with: {error}") from None

    @cached_property
    def robot(self) -> Configuration:
        """Its robot, with the joints at 0."""
        if self.reading.robot is None:
            raise InputError(f"the reference {self._path} cannot be compared with: it has no robot")
        return Configuration(self.reading.robot)
