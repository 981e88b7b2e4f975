"""Identical work: submissions that have the same URDF, robot, or files of a package. It is no verdict."""

import json
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import reduce
from itertools import combinations
from operator import and_
from types import MappingProxyType
from typing import Any, NamedTuple

from grader.classroom.gradebook.gradebook import Gradebook
from grader.text import counted, enumerated

_SUBMISSIONS = "SELECT key, urdf, robot, forms, source, files FROM grade WHERE NOT is_gone ORDER BY key"
_MAX_SHARING = 4  # students, or a tenth of the class: what more have in common comes from the handout


class IdenticalWork(NamedTuple):
    """Students with `equal` work; `same_file` groups those among them whose URDFs are the same bytes."""

    students: tuple[str, ...]
    same_file: tuple[tuple[str, ...], ...] = ()
    equal: str = "the same robot"


class _Work(NamedTuple):
    """The hashes of a submission: of the robot as `written`, of lines of `others`, of kinds of files of `package`."""

    key: str
    place: tuple[str, str]  # several students of a team may have one submission
    urdf: str
    robot: str
    written: str = ""
    others: Sequence[str] = ()
    package: Mapping[str, str] = MappingProxyType({})


def identical_work(book: Gradebook) -> list[IdenticalWork]:
    """Return the groups of students with identical work, without what the course handed out.

    Groups with identical files come first, then the largest; at the end those in which only a part is the same.
    """
    handed_out = {sha256 for (sha256,) in book.rows("SELECT sha256 FROM handed_out")}
    works = [
        _Work(key, (source, files), urdf, robot, **json.loads(forms or "{}"))
        for key, urdf, robot, forms, source, files in book.rows(_SUBMISSIONS)
    ]
    robots = [work for work in works if work.urdf and handed_out.isdisjoint((work.urdf, work.robot))]
    return [*_same_robots(robots), *_same_parts(works, handed_out)]


def _same_robots(works: list[_Work]) -> list[IdenticalWork]:
    same = []
    for group in _groups_of_several((work.robot or work.urdf, work) for work in works).values():
        files = _groups_of_several((work.urdf, work) for work in group)
        same.append(IdenticalWork(_keys(group), tuple(map(_keys, files.values()))))
    return sorted(same, key=lambda work: (not work.same_file, -len(work.students), work.students))


def _same_parts(works: list[_Work], handed_out: set[str]) -> Iterator[IdenticalWork]:
    """Yield the students with the same links, joints and materials, and those with two equal kinds of package files."""
    most = max(_MAX_SHARING, len(works) // 10)
    written = _groups_of_several((one.written, one) for one in works if one.written and one.written not in handed_out)
    for group in written.values():
        if len(group) <= most and len({work.robot for work in group}) > 1:
            yield IdenticalWork(_keys(group), equal=f"the same links, joints and materials; {_difference(group)}")
    counts = Counter(file for work in works for file in work.package.items())
    own = {file for file, count in counts.items() if count <= most and file[1] not in handed_out}
    pairs = ((pair, work) for work in works for pair in combinations(filter(own.__contains__, work.package.items()), 2))
    kinds: dict[tuple[str, ...], dict[str, None]] = {}
    for pair, group in _groups_of_several(pairs).items():
        kinds.setdefault(_keys(group), {}).update(dict.fromkeys(kind for kind, _ in pair))
    for keys, same in kinds.items():
        yield IdenticalWork(keys, equal=f"the same {enumerated(same)}")


def _difference(group: list[_Work]) -> str:
    """Return how many lines of the other elements are not the same in all: "5 lines of <gazebo> differ"."""
    lines = [Counter(work.others) for work in group]
    apart = [own - reduce(and_, lines) for own in lines]
    tags = sorted({f"<{line.partition(' ')[2]}>" for own in apart for line in own})
    count = max(own.total() for own in apart)
    return f"{counted(count, 'line')} of {enumerated(tags)} {'differs' if count == 1 else 'differ'}"


def _groups_of_several(works: Iterable[tuple[Any, _Work]]) -> dict[Any, list[_Work]]:
    """Return the groups with the same hash that come from more than one submission."""
    groups: dict[Any, list[_Work]] = {}
    for sha256, work in works:
        groups.setdefault(sha256, []).append(work)
    return {key: group for key, group in groups.items() if len({work.place for work in group}) > 1}


def _keys(group: list[_Work]) -> tuple[str, ...]:
    return tuple(work.key for work in group)
