from grader.api import grade as grade
from grader.errors import GraderError as GraderError
from grader.errors import MissingElement as MissingElement
from grader.errors import RubricError as RubricError
from grader.grading.report import Report as Report
from grader.grading.report import Result as Result
from grader.grading.rubric import Rubric as Rubric
from grader.grading.rubric import load_rubric as load_rubric
from grader.robot.kinematics import Configuration as Configuration
from grader.robot.reader import Reading as Reading
from grader.robot.reader import read_urdf as read_urdf

__version__: str
