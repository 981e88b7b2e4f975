"""Print the digest of each sample's report as JSON, with the hints of every nth sample from a first one on.

`python -m tests.report_digests FIRST STEP`. A digest has another name with hints: they take four times as long as all grading.
"""

import sys
from hashlib import sha256

from grader.grading.hints.hinting import hinted
from grader.report.formats import Format, render
from tests.samples import SAMPLES


def main(first: int, step: int) -> None:
    """Print a line for each report."""
    for number, (name, sample) in enumerate(SAMPLES.items()):
        report = sample.grade()
        print(name, sha256(render(report, Format.JSON).encode()).hexdigest())
        if number % step == first and report.has_failures:
            report = hinted(report, sample.open(), report.rubric.hints).report
            print(f"{name} with hints", sha256(render(report, Format.JSON).encode()).hexdigest())


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
