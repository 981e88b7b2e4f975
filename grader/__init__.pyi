from grader.api import grade
from grader.errors import GraderError, MissingElement, RubricError
from grader.grading.report import Report, Result
from grader.grading.rubric import Rubric, load_rubric
from grader.robot.kinematics import Configuration
from grader.robot.model import Joint, Link, Robot
from grader.robot.reader import Reading, read_urdf
from grader.robot.transforms import Transform

__all__ = [
    "Configuration",
    "GraderError",
    "Joint",
    "Link",
    "MissingElement",
    "Reading",
    "Report",
    "Result",
    "Robot",
    "Rubric",
    "RubricError",
    "Transform",
    "grade",
    "load_rubric",
    "read_urdf",
]
__version__: str
