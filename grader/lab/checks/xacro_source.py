"""The check of the xacro that a robot is written in.

It is about its properties, its macros, and the files that it includes.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from grader.base.errors import InputError, MissingElement, NotDecided
from grader.base.names import last_part, similar_there
from grader.base.source import LazyLocation, Location
from grader.base.text import MAX_NAMED, counted, enumerated, quoted
from grader.base.toml_types import Count
from grader.files.reading import URDF_LIMIT
from grader.lab.checks.check import About, everything
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read
from grader.ros.urdf.reader import find_xacro

if TYPE_CHECKING:
    from grader.ros.xacro.expansion import ExpandedSource

ABOUT = {
    "xacro_uses": About(
        ("xacro:property", "xacro:macro", "xacro:include"),
        breaks_under=everything,
        is_of_writing=True,
    )
}


class _Lack(NamedTuple):
    """What is missing, where, and what differs between students."""

    message: str
    location: Location | None = None
    detail: str = ""


def xacro_uses(
    submission: Submission,
    *,
    file: str = "",
    properties: Count | list[str] = 0,
    macros: Count | list[str] = 0,
    includes: Count | list[str] = 0,
) -> Outcome:
    """The robot is written in xacro, which defines and uses properties and macros, and includes
    files.

    The graded URDF and the files that it includes are examined as they are written. A property is
    used if an expression names it, also in the body of a macro; a macro is used if it is called.
    Without any argument, xacro must be expanded before ROS 2 reads it.

    Args:
        file: The end of the path of the one file whose definitions and includes count, such as
            "urdf/wheel.xacro"; by default, all files. They may be used in any file.
        properties: How many properties must at least be defined and used, or their names.
        macros: How many macros must at least be defined and called, or their names.
        includes: How many files must at least be included, or the ends of their paths.
    """
    source = _find_source(submission, file)
    if isinstance(source, Outcome):
        return source
    if not (file or properties or macros or includes):
        return _judge_expansion(submission)
    paths = list(source.documents)
    if not submission.is_single:
        paths = [path for path in paths if _ends_with(path, file)]
    inventory = source.inventory(submission.budget)
    included = {}
    for (path, _), files in source.includes.items():
        if path in paths:
            included.update(dict.fromkeys(files))
    lacks = [
        *_missing_uses(
            "property",
            "properties",
            properties,
            inventory.first_places(inventory.properties, paths),
            inventory.used,
        ),
        *_missing_uses(
            "macro",
            "macros",
            macros,
            inventory.first_places(inventory.macros, paths),
            inventory.called,
        ),
        *_missing_includes(includes, list(included)),
    ]
    if not lacks:
        names = [last_part(path) for path in paths]
        return passed(
            f"{enumerated(names, MAX_NAMED)}: xacro with the expected properties, macros "
            "and includes"
        )
    source.check_known(inventory)
    return _fail_lacks(source, lacks)


def _fail_lacks(source: "ExpandedSource", lacks: "Sequence[_Lack]") -> Outcome:
    """Return the failure of a xacro that lacks things, at the place of the first."""
    message = "; ".join(lack.message for lack in lacks)
    detail = "".join(lack.detail for lack in lacks)
    places = [lack.location for lack in lacks if lack.location]
    at = places[0] if places else LazyLocation(source, 0)
    return failed(message, at, detail=detail)


def _find_source(submission: Submission, file: str) -> "ExpandedSource | Outcome":
    """Return the xacro that is examined, or the failure of a robot that is not written in xacro."""
    from grader.ros.xacro.expansion import ExpandedSource

    reading = submission.needed_urdf()
    urdf = submission.urdf
    assert isinstance(urdf, Read)  # else there is none that is needed
    source = reading.source
    if not isinstance(source, ExpandedSource) and find_xacro(source.text) is not None:
        source = submission.surroundings(submission.budget).expanded(urdf.data, urdf.path)
    if isinstance(source, ExpandedSource):
        if (
            not file
            or submission.is_single
            or any(_ends_with(path, file) for path in source.documents)
        ):
            return source
    elif not file or submission.is_single:
        others = [
            path
            for path in submission.tree.files
            if path.lower().endswith(".xacro") and path != urdf.path
        ]
        if others:
            listed = enumerated(others, MAX_NAMED)
            message = f"the graded URDF is {urdf.path}, which is no xacro, but there is {listed}"
            raise NotDecided(message, "the graded URDF is no xacro, but the submission has xacro")
        if reading.root is None:
            raise MissingElement(
                "robot", "", message="ROS 2 cannot read the file, so there is no robot"
            )
        return failed(
            "the URDF is not written in xacro: it has no expression and no tag of xacro",
            LazyLocation(source, 0),
        )
    return _other_file(submission, file)


def _other_file(submission: Submission, file: str) -> "ExpandedSource | Outcome":
    """Return the xacro in a file of the submission that the graded URDF does not include."""
    from grader.ros.xacro.expansion import ExpandedSource

    files = [path for path in submission.tree.files if _ends_with(path, file)]
    if len(files) > 1:
        raise NotDecided(
            f"several files are called {file}: {enumerated(files, MAX_NAMED)}",
            "several files have the name",
        )
    if not files:
        raise MissingElement("file", file, message=f"the submission has no file {quoted(file)}")
    try:
        data = submission.tree.files[files[0]].read(URDF_LIMIT)
        source = submission.surroundings(submission.budget).expanded(data, files[0])
    except InputError as error:
        raise NotDecided(str(error), "a file cannot be read") from None
    if isinstance(source, ExpandedSource) and find_xacro(source.text) is not None:
        return source
    return failed(f"{files[0]} has no expression and no tag of xacro", Location(files[0], 1, 1))


def _judge_expansion(submission: Submission) -> Outcome:
    """Return whether xacro is expanded before ROS 2 reads the robot."""
    urdf = submission.urdf
    assert isinstance(urdf, Read)
    raw = urdf.loaded.raw_xacro
    if raw:
        return failed(raw.message, raw.location, problem=raw.message)
    return passed(f"{urdf.path} is written in xacro, and is expanded before ROS 2 reads it")


def _missing_uses(
    kind: str,
    plural: str,
    wanted: int | list[str],
    first_places: Mapping[str, Location],
    used: Collection[str],
) -> Iterator[_Lack]:
    """Yield what is missing of definitions that are used.

    These are some of the named ones, or of a number.
    """
    if isinstance(wanted, int):
        unused = [name for name in first_places if name not in used]
        count = len(first_places) - len(unused)
        if count < wanted:
            message = f"{counted(count, kind, plural)} defined and used; there should be {wanted}"
            if unused:
                detail = f"; not used: {enumerated(map(quoted, unused), MAX_NAMED)}"
                yield _Lack(message, first_places[unused[0]], detail)
            else:
                yield _Lack(message)
        return
    for name in wanted:
        if name not in first_places:
            detail = similar_there(name, first_places)
            yield _Lack(f"the {kind} {quoted(name)} is not defined", None, detail)
        elif name not in used:
            verb = "called" if kind == "macro" else "used"
            message = f"the {kind} {quoted(name)} is defined, but never {verb}"
            yield _Lack(message, first_places[name])


def _missing_includes(wanted: int | list[str], included: Sequence[str]) -> Iterator[_Lack]:
    if isinstance(wanted, int):
        if len(included) < wanted:
            yield _Lack(f"{counted(len(included), 'file')} included; there should be {wanted}")
        return

    def is_included(end: str) -> bool:
        return any(_ends_with(path, end) for path in included)

    missing = [quoted(end) for end in wanted if not is_included(end)]
    if missing:
        names = [last_part(path) for path in included]
        detail = f"; included: {enumerated(names, MAX_NAMED) or 'none'}"
        files = enumerated(missing, MAX_NAMED, "and no file")
        yield _Lack(f"no file {files} is included", None, detail)


def _ends_with(path: str, end: str) -> bool:
    """Return whether a path ends with whole names; everything ends with nothing."""
    return not end or f"/{path}".endswith(f"/{end.strip('/')}")
