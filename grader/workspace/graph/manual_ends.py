"""What a person brings from another terminal: teleoperation, the tools of RViz."""

from collections.abc import Sequence

from grader.ros.known.end_rows import OpenedEnds, manual_programs
from grader.workspace.graph.launch_graph import OPPOSITES, GraphEnd
from grader.workspace.graph.opened_by_programs import shown_type


def manual_ends(ends: Sequence[GraphEnd]) -> list[tuple[GraphEnd, list[str]]]:
    """Return the ends that a well-known program of another terminal is made for.

    Each is with these programs, as `package/program`.
    """
    brought = []
    for end in ends:
        programs = [name for name, row in manual_programs() if _connects(row, end)]
        if programs:
            brought.append((end, programs))
    return brought


def _connects(row: OpenedEnds, end: GraphEnd) -> bool:
    """Return whether a program has the other end, with its name and type."""
    varying = [(each.kind, each.name, each.type) for each in row.varying]
    for kind, name, message in (*row.fixed, *varying):
        is_of_kind = kind == OPPOSITES[end.kind]
        if is_of_kind and f"/{name.lstrip('/')}" == end.name and shown_type(message) == end.type:
            return True
    return False
