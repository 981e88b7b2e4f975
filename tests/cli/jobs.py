"""A job of GitHub Actions: a checkout, the variables that the runner sets, and a file for the summary."""

import shutil
from collections.abc import Mapping
from pathlib import Path

from tests.command_line import Done, run_with_input
from tests.samples import ROOT

MISTAKEN = ROOT / "submissions/lab6/several-mistakes/my_robot/urdf/my_robot.urdf"
ON_GITHUB: Mapping[str, str] = {}
ELSEWHERE: Mapping[str, str] = {"GITHUB_ACTIONS": ""}


class GithubJob:
    """A checkout with a submission in it, and the file that becomes the job's summary."""

    def __init__(self, folder: Path) -> None:
        self.checkout = folder / "checkout"
        (self.checkout / ".git").mkdir(parents=True)
        shutil.copy(MISTAKEN, self.checkout)
        self.summary = folder / "summary.md"

    def run(self, *arguments: str, start: Path | None = None, around: Mapping[str, str] = ON_GITHUB) -> Done:
        """Run the command line in the checkout, as a step does; `around` overrides variables of the runner."""
        job = {
            "GITHUB_ACTIONS": "true",
            "GITHUB_WORKSPACE": str(self.checkout),
            "GITHUB_STEP_SUMMARY": str(self.summary),
        }
        hints = ("--hints", "none") if "grade" in arguments and "--hints" not in arguments else ()
        return run_with_input((*arguments, *hints), b"", {**job, **around}, start or self.checkout)
