from grader.app.api import grade
from grader.base.errors import GraderError, MissingElement, RubricError
from grader.base.transforms import Transform
from grader.lab.grading.report import Report, Result
from grader.lab.rubric.rubric import Rubric, load_rubric
from grader.ros.api import Configuration, Joint, Link, Reading, Robot, read_urdf

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
