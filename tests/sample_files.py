"""Write what follows from the samples in submissions/: `python tests/sample_files.py`.

That is a README.md for each rubric, which lists its samples by what is wrong, the package of each sample whose mistake is not in
its package (that of the reference, around the sample's own folder `urdf`), and the class in submissions/class.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

sys.path.append(sys.path.pop(0))  # the folder of this script, whose `xml` would hide Python's
sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from grader.lab.rubric.rubric import Rubric
from tests.recordings.rover_drives import drive_files
from tests.sample_class import class_files, package_files
from tests.samples import ROOT, RUBRICS, SAMPLES, Sample

# Samples that lose nothing in their package, but whose package is their point.
OWN_PACKAGES = {
    *(
        f"equivalent-{name}"
        for name in ("f-strings-and-pathlib", "launch-file-in-xml", "literal-lists")
    ),
    *(f"equivalent-{name}" for name in ("nested-install-paths", "urdf-launch")),
    *(f"equivalent-xacro-{name}" for name in ("command", "inertials", "macros", "numbers")),
    "diffdrive/equivalent-other-names",
    *(
        f"sensors/equivalent-{name}"
        for name in ("find-in-include", "flat-install", "macro-included")
    ),
    "xacro-from-another-package",
}


def packages() -> Iterator[tuple[Path, dict[str, bytes]]]:
    """Yield the folder of each package that is the reference's, and the files of it except the robot."""
    for name, sample in SAMPLES.items():
        rubric, folder = sample.rubric, sample.expected.folder / sample.rubric.package
        is_own = name in OWN_PACKAGES or not _of_packages(rubric).isdisjoint(sample.expected.lost)
        if rubric.package and (folder / "urdf").is_dir() and not is_own:
            yield folder, package_files(rubric.path.parent / rubric.reference)


def _of_packages(rubric: Rubric) -> set[str]:
    parts = {part.id for part in rubric.parts if part.needs == "package"}
    return {criterion.id for criterion in rubric.criteria if criterion.part in parts}


def readmes() -> Iterator[tuple[Path, bytes]]:
    """Yield the path and the text of each README.md."""
    for rubric in RUBRICS.values():
        if own := [sample for sample in SAMPLES.values() if sample.rubric is rubric]:
            yield ROOT / "submissions" / rubric.id / "README.md", _readme(rubric, own).encode()


def _readme(rubric: Rubric, samples: list[Sample]) -> str:
    """Return a page with a table for each criterion: the samples of which it is the first that loses points."""
    titles = {"": "Correct", "?": "Needs manual grading"} | {
        row.id: f"`{row.id}`: {row.title}" for row in rubric.criteria
    }
    groups: dict[str, list[Sample]] = {key: [] for key in titles}
    for sample in samples:
        groups[
            next(
                iter(lost_criteria(sample, rubric)),
                "?" if rubric.criteria[0].id in sample.expected.pending else "",
            )
        ].append(sample)
    text = _TOP.format(id=rubric.id, title=rubric.title, count=len(samples))
    for key, found in groups.items():
        rows = "".join(
            f"| [{it.expected.folder.name}]({it.expected.folder.name}/) | {it.expected.about} | {_others(it, rubric)} |\n"
            for it in found
        )
        text += (
            f"\n## {titles[key]}\n\n| sample | what is in it | points lost |\n|---|---|---|\n{rows}"
            if rows
            else ""
        )
    return text


def lost_criteria(sample: Sample, rubric: Rubric) -> list[str]:
    """Return the criteria that lose points: those of extra credit only if not all of them do."""
    extra = {row.id for row in rubric.criteria if row.bonus}
    lost = sample.expected.lost
    return [name for name in lost if name not in extra] if extra.issubset(lost) else [*lost]


def _others(sample: Sample, rubric: Rubric) -> str:
    lost = [row for row in rubric.criteria if row.id in sample.expected.lost and not row.bonus]
    points, count = sum(row.points for row in lost), len(lost)
    return f"{points} in {count} criteria" if count > 1 else str(points)


_TOP = """\
# Samples of the rubric {id}: {title}

{count} submissions, one folder each. `grader grade submissions/{id}/NAME --rubric {id}` prints the report of one; its `expected.toml`
says which criteria lose their points. `grader rubric test {id} submissions/{id}` compares all of them.
Each is listed under the first criterion that it loses.
"""


def generated() -> Iterator[tuple[Path, bytes]]:
    """Yield the path of each file that follows from others, and what it must contain."""
    yield from readmes()
    yield from drive_files()
    yield from class_files()
    for folder, files in packages():
        yield from ((folder / name, data) for name, data in files.items())


if __name__ == "__main__":
    for path, data in generated():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(data)
