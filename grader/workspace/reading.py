"""Read a workspace: what its files define and use, and what does not agree."""

from collections.abc import Iterator
from functools import lru_cache
from itertools import chain

from grader.submission.submission import Submission
from grader.workspace.arguments import argument_facts
from grader.workspace.bridges import bridge_facts
from grader.workspace.controllers import controller_facts
from grader.workspace.dependencies import dependency_facts
from grader.workspace.files import file_facts
from grader.workspace.frames import frame_facts
from grader.workspace.gazebo import gazebo_facts
from grader.workspace.moveit import moveit_facts
from grader.workspace.names import Agreement, Fact, Family, Mismatch, agreement
from grader.workspace.parameters import parameter_facts
from grader.workspace.programs import program_facts
from grader.workspace.spawners import spawner_facts
from grader.workspace.srdf import srdf_facts
from grader.workspace.topics import topic_facts
from grader.workspace.unused import unused_files
from grader.workspace.workspace import Workspace, workspace_of

_READERS = (
    file_facts,
    frame_facts,
    controller_facts,
    spawner_facts,
    parameter_facts,
    argument_facts,
    program_facts,
    topic_facts,
    gazebo_facts,
    bridge_facts,
    srdf_facts,
    moveit_facts,
    dependency_facts,
)


@lru_cache(maxsize=2)
def read_agreement(submission: Submission) -> Agreement:
    """Return what does not agree in the packages of a submission."""
    workspace = workspace_of(submission)
    found = agreement(_facts(workspace))
    # names_agree needs a package.
    families = found.families if workspace.packages else frozenset[Family]()
    return found._replace(families=families, unused=tuple(unused_files(workspace)))


def wrong_names(submission: Submission, family: Family) -> list[Mismatch]:
    """Return what certainly does not agree in the packages that are graded."""
    packages = submission.lab_packages.values()
    own = [it for it in read_agreement(submission).mismatches if it.family == family and it.is_sure]
    return [it for it in own if any(package.holds(it.location.path) for package in packages)]


def read_facts(submission: Submission) -> Iterator[Fact]:
    """Yield what the files of a submission define and use."""
    return _facts(workspace_of(submission))


def _facts(workspace: Workspace) -> Iterator[Fact]:
    return chain.from_iterable(reader(workspace) for reader in _READERS)
