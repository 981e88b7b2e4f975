"""The slips of a robot that are proven by reading its files again.

What is written can stand for one thing only if no other way to read it gives another robot.
"""

from collections.abc import Iterator, Sequence

from grader.base.slips import Slip
from grader.lab.submission.edited import edited_files, with_urdf
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read

_MAX_TRIALS = 60  # times that the robot is read again


def proven_slips(submission: Submission) -> Iterator[Slip]:
    """Yield the slips of the robot that can be read in one way only."""
    urdf = submission.urdf
    if not isinstance(urdf, Read):
        return
    trials: _Trials | None = None
    for choice in urdf.slip_choices:
        if trials is None:
            trials = _Trials(submission, urdf)
        slip = trials.choose(choice)
        if slip is not None:
            yield slip
        if trials.is_spent:
            return


class _Trials:
    """Reads a robot again with slips corrected."""

    def __init__(self, submission: Submission, urdf: Read) -> None:
        self._submission = submission
        self._before = urdf.state
        self._left = _MAX_TRIALS

    @property
    def is_spent(self) -> bool:
        """Whether the robot was read as often as it may be."""
        return self._left <= 0

    def choose(self, choice: Sequence[Slip]) -> Slip | None:
        """Return the one way to read what is written that gives a robot; None if several do.

        Of all ways, those count that leave the fewest reasons to refuse or to drop something.
        """
        slips: dict[str, Slip] = {}
        fewest = self._before.faults
        for slip in choice:
            after = self._read(slip)
            if after is None or after.state.faults > fewest or not self._is_changed(slip, after):
                continue
            if after.state.faults < fewest:
                fewest, slips = after.state.faults, {}
            is_refused = slip.is_refused or after.state.refusals < self._before.refusals
            slips.setdefault(after.state.content, slip._replace(is_refused=is_refused))
        return next(iter(slips.values())) if len(slips) == 1 else None

    def _is_changed(self, slip: Slip, after: Read) -> bool:
        """Return whether a slip matters that is corrected.

        It does not if the robot is read as it is meant without it.
        """
        if after.state.faults == self._before.faults and slip.is_refused:
            return False
        if self._before.is_read:
            return after.state.content != self._before.content
        return after.state != self._before

    def _read(self, slip: Slip) -> Read | None:
        """Return the robot with a slip corrected.

        It is None if that cannot be read, or if the robot was read as often as it may be.
        """
        self._left -= 1
        files = edited_files(self._submission, slip.edits) if self._left >= 0 else None
        if files is None:
            return None
        urdf = with_urdf(self._submission, files).urdf
        return urdf if isinstance(urdf, Read) else None
