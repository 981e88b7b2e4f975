"""One line for each wording among the samples, and for each fact of references."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import asdict
from pathlib import Path

from grader.checks.measures.fact import Solution
from grader.checks.registry import declared, own_checks
from grader.robot.kinematics import Configuration
from grader.source import LazyLocation, Location
from tests.checks.cases import CASES
from tests.checks.robots import inertial, joint, link, scene
from tests.checks.submissions import LAUNCH, MANIFEST, REFERENCE, RVIZ, SETUP, URDF
from tests.samples import RUBRICS, SAMPLES

FILES = {name: Path(__file__).parent / f"outcomes-of-{name}.txt" for name in ("samples", "references")}
_DATA = re.compile(r"'[^']*'|\"[^\"]*\"|[-\d.]+|\S*/\S*")  # names in quotes, numbers and paths

CMAKE = "my_robot/CMakeLists.txt"
PACKAGES = (  # references whose package lacks something, or has something unusual
    REFERENCE.replacing(MANIFEST, "ament_python", "ament_cmake")
    .without(SETUP)
    .with_files({CMAKE: "project(my_robot)\n"}),
    REFERENCE.replacing(MANIFEST, "ament_python", ""),
    REFERENCE.without(MANIFEST),
    REFERENCE.renaming(URDF, "my_robot.urdf"),
    REFERENCE.with_files({LAUNCH: "def generate_launch_description():\n    return LaunchDescription([])\n"}),
    REFERENCE.with_files({RVIZ: "Visualization Manager:\n  Displays: []\n"}),
    REFERENCE.replacing(RVIZ, "Value: /robot_description", "Value: /other"),
    REFERENCE.replacing(SETUP, "glob('urdf/*')", "glob('urdf/*.*')").with_files({"my_robot/urdf/part.stl": "solid"}),
)
ROBOT = scene(  # links without shapes, and a joint without values
    link("base", inertial(1.0, (1.0, 0.0, 0.0, 1.0, 0.0, 1.0))),
    link("flat", inertial(1.0, (0.0, 0.0, 0.0, 1.0, 0.0, 1.0))),
    joint("turn", "continuous", "base", "flat", more='<limit lower="0"/>'),
)


def wording(found: str) -> str:
    """Return what a line says after its name and status, without the data of one robot."""
    return _DATA.sub("", found.partition("message ")[2])


def row(name: str, fields: Mapping[str, object]) -> str:
    """Return the fields of an outcome or a fact in one line, but those that are empty."""
    return f"{name}: " + "; ".join(
        f"{key} {_shown(value)}" for key, value in fields.items() if value is not None and value not in ("", ())
    )


def _shown(value: object) -> str:
    match value:
        case Location():
            return f"{value.path}:{value.line}:{value.column}"
        case LazyLocation():
            return _shown(value.resolve())
        case tuple():
            return f"({', '.join(map(_shown, value))})"
        case Mapping():
            return f"{{{', '.join(f'{key}: {_shown(one)}' for key, one in value.items())}}}"
        case float():
            return f"{round(value, 9) + 0.0:.6g}"
        case _:
            return str(value).replace("\n", "\\n")


def outcomes_of_samples() -> Iterator[str]:
    """Yield what failed or needs manual grading in the samples, and what is noted about them, each wording once."""
    seen = set()
    for name, sample in SAMPLES.items():
        report = sample.grade()
        wrong = [result for result in report.results if result.outcome.status in ("failed", "pending")]
        rows = [row(f"{name}: {result.criterion.id}", result.outcome._asdict()) for result in wrong]
        rows += [f"{name}: message {note}" for note in report.notes]
        for found in rows:
            if wording(found) not in seen:
                seen.add(wording(found))
                yield found


def facts_of_references() -> Iterator[str]:
    """Yield what a new rubric asks for, of the references and of the robots in the cases, each wording once."""
    references = [rubric.solution.submission for rubric in RUBRICS.values() if rubric.solution is not None]
    seen = set()
    references += [ROBOT.submission, *(package.submission for package in PACKAGES)]
    for submission in [*references, *(case.passing.submission for case in CASES)]:
        reading = submission.needed_urdf()
        assert reading.robot is not None
        solution = Solution(submission, reading, Configuration(reading.robot))
        for check in own_checks():
            for fact in declared(check.about.measure)(solution) if check.about.measure else ():
                fields = {key: value for key, value in asdict(fact).items() if key != "title" and value is not False}
                found = row(check.name, {"message": getattr(fact, "title", ""), **fields})
                if wording(found) not in seen:
                    seen.add(wording(found))
                    yield found


ROWS = {"samples": outcomes_of_samples, "references": facts_of_references}
