"""One line for each outcome of the cases of checks, and for each fact of references."""

from collections.abc import Iterator
from dataclasses import asdict
from pathlib import Path

from grader.checks.measures.fact import Solution
from grader.checks.registry import declared, own_checks
from grader.robot.kinematics import Configuration
from tests.checks.cases import CASES
from tests.checks.outcomes import ask, row, wording
from tests.checks.package_cases import PACKAGE_CASES, PENDING_CASES
from tests.checks.robots import inertial, joint, link, scene
from tests.checks.submissions import LAUNCH, MANIFEST, REFERENCE, RVIZ, SETUP, URDF
from tests.samples import RUBRICS

FILES = {name: Path(__file__).parent / f"outcomes-of-{name}.txt" for name in ("cases", "references")}

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


def outcomes_of_cases() -> Iterator[str]:
    """Yield what a check measures in the robot or submission that passes, and in the one that fails."""
    for case in (*CASES, *PACKAGE_CASES):
        for tried in (case.passing, case.failing):
            yield row(case.name, ask(case.check, tried, **case.arguments)._asdict())
    for pending in PENDING_CASES:
        for submitted in (REFERENCE, pending.without):
            yield row(pending.name, ask(pending.check, submitted, **pending.arguments)._asdict())


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


ROWS = {"cases": outcomes_of_cases, "references": facts_of_references}
