"""The edits of a package that may make criteria pass, by the check that decides each."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import AbstractContextManager
from typing import Any

from grader.edits import Proposal
from grader.package.edits import launch_edits, manifest_edits, rviz_edits, setup_edits
from grader.package.edits.task import Task
from grader.package.package import Package
from grader.source import Edit

_MAX_PROPOSALS = 14  # for one criterion
_BY_CHECK: Mapping[str, Callable[[Task, Mapping[str, Any]], Iterator[Proposal]]] = {
    "package_found": manifest_edits.named,
    "package_type": manifest_edits.typed,
    "build_installs": setup_edits.installs,
    "installs_files": setup_edits.installs_files,
    "setup_imports": setup_edits.readable,
    "launch_found": launch_edits.named,
    "launch_starts": launch_edits.starts,
    "launch_finds_files": launch_edits.finds_files,
    "rviz_found": rviz_edits.named,
    "rviz_fixed_frame": rviz_edits.fixed_frame,
    "rviz_shows_robot": rviz_edits.shows_robot,
    "rviz_display_on": rviz_edits.display_on,
}


def package_proposals(
    package: Package | None,
    reference: Package | None,
    wanted: Iterable[tuple[str, Mapping[str, Any]]],
    isolated: Callable[[], AbstractContextManager[None]],
) -> list[Proposal]:
    """Return edits of a package for checks with their arguments, each edit once; of each check the smallest are first.

    The edits for each check are made in a context `isolated`, which keeps a fault from those for others.
    """
    if package is None:
        return []
    task = Task(package, reference)
    found: dict[tuple[Edit, ...], Proposal] = {}
    with isolated():
        found |= {proposal.edits: proposal for proposal in manifest_edits.one_name(task, package.share.split("/")[1])}
    for check, arguments in wanted:
        family = _BY_CHECK.get(check)
        with isolated():
            own = [it for it in family(task, arguments) if it.edits] if family is not None else []
            for proposal in sorted(own, key=lambda it: it.size)[:_MAX_PROPOSALS]:
                found.setdefault(proposal.edits, proposal)
    return list(found.values())
