"""Code: what stops own nodes, or keeps them from doing anything."""

from collections.abc import Iterator

from grader.ros.workspace.model.workspace import Workspace
from grader.ros.workspace.names import Compared, Fact, Mismatch, Undecided


def code_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield what is wrong in the code of nodes."""
    for package, nodes in workspace.code.by_package.items():
        if nodes.has_more_faults:
            yield Undecided("code", f"the code of {package!r} is too long to search")
        if nodes.nodes or nodes.programs:  # a script may use rclpy without a node of its own
            yield Compared("code")
        for program in nodes.programs:
            if program.syntax is not None:
                at = program.syntax.location
                message = f"Python cannot read the file: {program.syntax.message}"
                if program.syntax.is_certain:
                    yield Mismatch("code", message, at, rule="syntax")
                else:
                    yield Undecided("code", f"{at.path} is not read")
        for fault in nodes.faults:
            yield Mismatch(
                "code",
                fault.message,
                fault.location,
                fault.related,
                fault.is_certain,
                rule=fault.rule,
            )
