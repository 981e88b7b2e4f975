"""Edits that make ROS 2 load a xacro file that no xacro expands: the launch file runs xacro, or the name says xacro."""

from collections.abc import Iterator

from grader.edits import Proposal
from grader.source import Edit
from grader.submission.submission import Submission
from grader.submission.urdf import Read

_CAUSE = "the URDF contains xacro, but is loaded without xacro"


def raw_xacro_proposals(submission: Submission) -> Iterator[Proposal]:
    """Yield edits that let xacro expand the URDF, where it is xacro that is loaded without it."""
    urdf = submission.urdf
    if not isinstance(urdf, Read) or urdf.as_it_stands is None:
        return
    from grader.package.edits.python_file import with_xacro  # late: most URDFs are no such file

    for path in submission.package.launch_files if submission.package is not None else ():
        source = submission.source(submission.package.path(path)) if submission.package is not None else None
        for edits in with_xacro(source) if source is not None else ():
            yield Proposal(edits, _CAUSE)
    folder, slash, name = urdf.path.rpartition("/")
    renamed = f"{folder}{slash}{name.removesuffix('.urdf')}.urdf.xacro"
    yield Proposal((Edit(urdf.path, 1, 1, "", "", renamed),), _CAUSE)
