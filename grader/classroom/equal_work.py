"""Equal and nearly equal work: submissions with the same URDF, robot, or files of a package. It is no verdict."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from contextlib import suppress
from itertools import combinations, starmap
from typing import Any, NamedTuple

from grader.classroom.graded import Graded
from grader.errors import InputError
from grader.files.reading import sha256_of
from grader.package.package import SETUP, Package
from grader.robot.normal_form import robot_hash, written_form
from grader.static_python.budget import PYTHON_LIMIT
from grader.submission.submission import Submission
from grader.submission.urdf import Read
from grader.text import enumerated

_MAX_SHARING = 4  # students, or a tenth of the class: what more have in common comes from the handout
_DIGITS = 16  # of a hash
_KINDS = ("setup.py", "launch files", "RViz files")
_LABELS = {"urdf": "the same file", "robot": "the same robot", "written": "the same links, joints and materials"}
_IGNORED = re.compile(rb"^(?:[ \t]*+#.*|(?:Panels|Window Geometry):.*\n(?:[ \t-].*(?:\n|\Z))*)", re.MULTILINE)


class EqualWork(NamedTuple):
    """Students with work that is equal, and what of it is: "the same file"."""

    students: tuple[str, ...]
    equal: str


def forms_of(submission: Submission, *, is_handed_out: bool = False) -> dict[str, Any]:
    """Return the hashes of a submission's forms, without what is empty.

    `urdf` is that of the file, `robot` that of its normal form, `written` that of its links, joints and materials as
    written; `package` are the hashes of kinds of files of the package.
    """
    found: dict[str, Any] = {}
    urdf = submission.urdf
    if isinstance(urdf, Read):
        if urdf.data.strip():
            found |= {"urdf": sha256_of(urdf.data), "robot": robot_hash(urdf.reading)}
        found["written"] = written_form(urdf.reading.elements, is_handed_out=is_handed_out)
    if submission.package is not None:
        found["package"] = dict(_package_forms(submission.package))
    return {name: form[:_DIGITS] if isinstance(form, str) else form for name, form in found.items() if form}


def _package_forms(package: Package) -> Iterator[tuple[str, str]]:
    """Yield kinds of files, each with the hash of what they are apart from comments, white space, quotes, windows."""
    for kind, paths in zip(_KINDS, ((SETUP,), package.launch_files, package.rviz_files), strict=True):
        with suppress(InputError):
            files = [package.tree.files[path].read(PYTHON_LIMIT) for path in paths if path in package.tree.files]
            forms = sorted(_IGNORED.sub(b"", data).replace(b"'", b'"').split() for data in files)
            if any(forms):
                yield kind, sha256_of(repr((kind, forms)).encode())[:_DIGITS]


def hashes_of(submission: Submission) -> tuple[str, ...]:
    """Return the hashes of the robot and the package, which are no equal work if the course handed them out."""
    forms = forms_of(submission, is_handed_out=True)
    own = (forms.get(name) for name in ("urdf", "robot", "written"))
    return tuple(filter(None, (*own, *forms.get("package", {}).values())))


def equal_work(results: Iterable[Graded], handed_out: Iterable[str]) -> list[EqualWork]:
    """Return the groups of students with equal work, without what the course handed out.

    The same file comes first, then the same robot, the same elements, and two equal kinds of package files.
    """
    known, works = {*handed_out}, [one for one in results if one.work]
    most = max(_MAX_SHARING, len(works) // 10)
    found: dict[tuple[str, ...], str] = {}
    own = [one for one in works if known.isdisjoint((one.work.get("urdf"), one.work.get("robot")))]
    for kind, label in _LABELS.items():
        for group in _groups((one.work[kind], one) for one in own if one.work.get(kind, "") not in {"", *known}):
            is_rare = len(group) <= most and len({one.work.get("robot") for one in group}) > 1
            if kind != "written" or is_rare:
                found.setdefault(_keys(group), label)
    files = {one.student: one.work.get("package", {}).items() for one in works}
    counts = Counter(file for some in files.values() for file in some)
    rare = {file for file, count in counts.items() if count <= most and file[1] not in known}
    pairs = ((pair, one) for one in works for pair in combinations(filter(rare.__contains__, files[one.student]), 2))
    parts: dict[tuple[str, ...], str] = {}
    for group in _groups(pairs):
        same = rare.intersection(*(files[one.student] for one in group))
        parts[_keys(group)] = f"the same {enumerated([kind for kind in _KINDS if kind in dict(same)])}"
    return [*starmap(EqualWork, found.items()), *starmap(EqualWork, parts.items())]


def _groups(works: Iterable[tuple[Any, Graded]]) -> list[list[Graded]]:
    """Return the groups with the same hash that come from more than one submission, the largest first."""
    groups: dict[Any, list[Graded]] = {}
    for form, work in works:
        groups.setdefault(form, []).append(work)
    several = (group for group in groups.values() if len({(one.root, one.paths) for one in group}) > 1)
    return sorted(several, key=lambda group: (-len(group), _keys(group)))


def _keys(group: Iterable[Graded]) -> tuple[str, ...]:
    return tuple(one.student for one in group)
