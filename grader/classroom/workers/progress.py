"""The progress of a run over a class."""

from dataclasses import dataclass, replace


@dataclass(frozen=True, slots=True)
class Progress:
    """The progress of a run. `errored` and `unreadable` count submissions that were graded in this run."""

    total: int
    graded: int = 0
    unchanged: int = 0
    unreadable: int = 0
    errored: int = 0

    @property
    def done(self) -> int:
        """The number of submissions that have a result."""
        return self.graded + self.unchanged

    def with_result(self, verdict: str) -> "Progress":
        """Return the progress after one more result."""
        counted = {"unchanged"} if verdict == "unchanged" else {"graded", verdict}
        return replace(self, **{name: getattr(self, name) + 1 for name in counted})
