"""Identical work: submissions whose URDFs are the same file, or the same robot in its normal form. It is no verdict."""

from collections.abc import Iterable
from typing import NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook

_SUBMISSIONS = "SELECT key, urdf, robot, source, files FROM grade WHERE urdf <> '' AND NOT is_gone ORDER BY key"


class IdenticalWork(NamedTuple):
    """Students whose robots are the same; `same_file` groups those among them whose URDFs are the same bytes."""

    students: tuple[str, ...]
    same_file: tuple[tuple[str, ...], ...]


class _Work(NamedTuple):
    key: str
    urdf: str
    robot: str
    place: tuple[str, str]  # several students of a team may have one submission


def identical_work(book: Gradebook) -> list[IdenticalWork]:
    """Return the groups of students with identical work, without what the course handed out.

    Groups with identical files come first, then the largest.
    """
    handed_out = {sha256 for (sha256,) in book.rows("SELECT sha256 FROM handed_out")}
    rows = (_Work(key, urdf, robot, (source, files)) for key, urdf, robot, source, files in book.rows(_SUBMISSIONS))
    works = [work for work in rows if work.urdf not in handed_out and work.robot not in handed_out]
    files = _groups_of_several((work.urdf, work) for work in works)
    robots = _groups_of_several((work.robot, work) for work in works if work.robot)
    numbers = {work.key: number for number, group in enumerate(robots) for work in group}
    inside: dict[int, list[tuple[str, ...]]] = {}
    apart = []
    for group in files:
        owners = {numbers.get(work.key) for work in group}
        owner = next(iter(owners))
        if len(owners) == 1 and owner is not None:
            inside.setdefault(owner, []).append(_keys(group))
        else:
            apart.append(IdenticalWork(_keys(group), (_keys(group),)))
    same = [IdenticalWork(_keys(group), tuple(inside.get(number, ()))) for number, group in enumerate(robots)]
    return sorted(same + apart, key=lambda work: (not work.same_file, -len(work.students), work.students))


def _groups_of_several(works: Iterable[tuple[str, _Work]]) -> list[list[_Work]]:
    """Return the groups with the same hash that come from more than one submission."""
    groups: dict[str, list[_Work]] = {}
    for sha256, work in works:
        groups.setdefault(sha256, []).append(work)
    return [group for group in groups.values() if len({work.place for work in group}) > 1]


def _keys(group: list[_Work]) -> tuple[str, ...]:
    return tuple(work.key for work in group)
