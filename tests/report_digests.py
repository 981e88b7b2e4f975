"""Print the digest of each sample's report as JSON, and of every STEPth one with its hints.

`python -m tests.report_digests STEP`. A digest has another name with hints: they take four times as long as all grading.
"""

import sys
from hashlib import sha256

from grader.lab.hints.hinting import hinted
from grader.report.formats import Format, render
from tests.samples import SAMPLES


def main(step: int) -> None:
    """Print a line for each report."""
    for number, (name, sample) in enumerate(SAMPLES.items()):
        report = sample.grade()
        print(name, sha256(render(report, Format.JSON).encode()).hexdigest())
        if number % step == 0 and report.has_failures:
            report = hinted(report, sample.open(), report.rubric.hints).report
            print(f"{name} with hints", sha256(render(report, Format.JSON).encode()).hexdigest())


if __name__ == "__main__":
    main(int(sys.argv[1]))
