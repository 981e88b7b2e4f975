"""A URDF that was looked for, and what ROS 2 makes of it with the files around.

It has one of three states.
"""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from itertools import chain
from posixpath import basename, dirname
from typing import TYPE_CHECKING, cast

from grader.base.errors import InputError, MissingElement, NotDecided
from grader.base.grouping import known_values
from grader.base.patterns import on_use
from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.reuse import Answers, Memory
from grader.base.slips import Slip
from grader.base.source import Edits, Source
from grader.files.reading import URDF_LIMIT
from grader.files.tree import Tree, make_tree, parents
from grader.ros.known.releases import Release
from grader.ros.package.package import Package, Packages
from grader.ros.python.budget import Budget
from grader.ros.python.values import Undetermined
from grader.ros.urdf.reader import Reading, find_xacro, read_robot, read_urdf
from grader.ros.urdf.urdf_problems import OF_SLIPS, OF_VALUES, RAW_XACRO
from grader.ros.urdf.versions import UrdfVersion, newest_version
from grader.ros.xml.parsing import XmlDocument, read_document
from grader.ros.xml.xml_problems import DOCTYPE, NOT_WELL_FORMED

if TYPE_CHECKING:
    from grader.ros.launch.launch_model import NamedFile
    from grader.ros.package.robot_comparison import RobotState
    from grader.ros.slips.choices import Choice
    from grader.ros.xacro.corrections import Refusal
    from grader.ros.xacro.expansion import ExpandedSource
    from grader.ros.xacro.texts import OtherArguments
    from grader.ros.xacro.xacro_files import SurroundingFiles

_MAX_FOLDERS = 40  # whose launch files are read
# What may be a slip although it is no problem of a URDF: text, CDATA, xacro, words of SDF.
_NO_PROBLEM = on_use(r">\s*+(?!-->)[^\s<]|<!(?!--)|[${]|xacro:|<gazebo")
_NO_FILES = make_tree("", (), ())


class OtherCandidate(Named):
    """A file that could have been graded, and why another one is."""

    path: str
    reason: str
    is_part: bool = False  # of a robot: another file includes it, or it has no name or only macros


# These are no dataclasses: making each one takes 1 ms of the start of every command.


class Absent:
    """No file is a URDF; `blank` is the path of one without content."""

    __slots__ = ("blank",)

    def __init__(self, blank: str = "") -> None:
        self.blank = blank

    @property
    def reason(self) -> str:
        """Why there is no robot."""
        return "the URDF is empty" if self.blank else "no URDF was submitted"


class Unreadable(Named):
    """The URDF is too large or damaged; `reason` is a sentence that names the file."""

    path: str
    reason: str


class Read(Named):
    """The URDF was read, even if ROS 2 rejects it.

    `reading` is of the expanded text if it is xacro.

    Of xacro that is loaded without xacro, `as_it_stands` is what ROS 2 makes of the text: whether
    it loads, and the verdict. The robot is that of `reading`, so that everything else is graded as
    if it had been expanded.
    """

    path: str
    data: bytes
    reading: Reading
    is_expanded: bool = False
    has_xacro: bool = False  # so that it is read as the files around say
    as_it_stands: Reading | None = None

    @property
    def loaded(self) -> Reading:
        """What ROS 2 loads."""
        return self.as_it_stands or self.reading

    @property
    def source(self) -> Source:
        """The text that the student wrote."""
        if self.is_expanded:
            return Source.decoded(self.path, self.data)
        return self.reading.source

    @property
    def problems(self) -> tuple[Problem, ...]:
        """Every problem of the file.

        For xacro that is loaded without xacro, these are the problems of the expanded text.
        """
        if not self.as_it_stands:
            return self.reading.problems
        raw = [problem for problem in self.as_it_stands.problems if problem.kind is RAW_XACRO]
        return (*raw, *self.reading.problems)

    @property
    def state(self) -> "RobotState":
        """What this is compared by with another reading of the file."""
        from grader.ros.package.robot_comparison import make_state  # late: most files have no slips

        return make_state(self.reading)

    @property
    def slip_choices(self) -> "Iterator[Choice]":
        """The slips that another reading of the files proves, each with all ways to read it."""
        text = self.data.decode("utf-8", "replace")
        if OF_VALUES.issuperset(
            problem.kind for problem in self.problems
        ) and not _NO_PROBLEM.search(text):
            return iter(())
        from grader.ros.slips.choices import list_choices  # late: as above

        texts = {self.path: Source(self.path, text)}
        refused: Sequence[Refusal] = ()
        if self.reading.source.is_expanded:
            expanded = cast("ExpandedSource", self.reading.source)
            refused = expanded.refused
            for source in expanded.texts_of_files:
                texts.setdefault(source.path, source)
        return list_choices(list(texts.values()), refused, self.reading.fixes)

    @property
    def slips(self) -> list[Slip]:
        """The words of the file, and of those that xacro includes, that surely are others."""
        slips: list[Slip] = []
        if self.reading.source.is_expanded:
            from grader.ros.xacro.xacro_slips import xacro_slips

            slips += xacro_slips(cast("ExpandedSource", self.reading.source))
        kinds = {problem.kind for problem in self.reading.problems}
        reading = self.reading
        if reading.elements is not None and not OF_SLIPS.isdisjoint(kinds):
            from grader.ros.urdf.robot_slips import RobotSlips  # late: most files have none

            search = RobotSlips(reading.elements, reading.source, reading.unresolved)
            slips += search.listed()
        return slips


Urdf = Absent | Unreadable | Read


class Surroundings(Named):
    """The files and packages around a URDF, as launch files and xacro find them.

    This is the Workspace of xacro.
    """

    budget: Budget  # of what is expanded and evaluated
    tree: Tree = _NO_FILES
    graded: Package | None = None
    packages: Packages = ()
    arguments: Mapping[str, str] = {}  # that the user gives xacro
    launch_arguments: Mapping[
        str, str
    ] = {}  # that a criterion gives launch files, and xacro if these do not
    is_single: bool = False  # whether the files are those around a single file
    assumes_defaults: bool = False  # whether arguments whose values are not evaluated have those
    ask: Callable[[str], object] = lambda _: (
        None
    )  # is called with the name of each other file that xacro reads
    memory: Memory | None = None  # of robots that were read before
    releases: Collection[Release] = ()  # of ROS 2 that read the robot; Jazzy without any
    called: str = "submission"  # what messages call the files

    def robot_references(self, path: str) -> "list[NamedFile]":
        """Return where launch files of the graded package, else of others, read a URDF.

        If none does, return those in a folder around.
        """
        around = self._launched_packages(path)
        return [
            reference
            for package in around
            for reference in package.robot_references(basename(path))
        ]

    def runs_xacro_beside(self, path: str) -> bool:
        """Return whether a launch file runs xacro on a file of the same folder.

        It may also name xacro and make a path of variables that may be this one.
        """
        from grader.ros.package.made_paths import made_paths  # late: few robots need it

        folder = basename(dirname(path))
        for launch in chain.from_iterable(package.launches for package in self.packages):
            for file in launch.named("urdf"):
                beside = basename(dirname(file.path or ""))
                if file.by == "xacro" and file.path is not None and beside == folder:
                    return True
            is_run = "xacro" in launch.source.text
            if is_run and any(made.matches(path) for made in made_paths(launch.source)):
                return True
        return False

    def other_arguments(self, path: str, references: "Sequence[NamedFile]") -> "OtherArguments":
        """Return what is known of arguments of xacro that nobody gives.

        Neither the user nor the launch file gives them.
        """
        launches = [
            launch for package in self._launched_packages(path) for launch in package.launches
        ]
        if self.assumes_defaults:
            return "default"
        if any(launch.unknown or launch.syntax for launch in launches):
            return "default" if references else "unknown"
        return "none" if references and not self.arguments else "default"

    def expanded(self, data: bytes, path: str) -> "ExpandedSource":
        """Return a file as xacro.

        Raises NotDecided or MissingElement where it cannot be expanded at all.
        """
        from grader.ros.xacro.expansion import ExpandedSource, expand  # late: most are no xacro

        expansion = expand(data, path, self, self.arguments)
        if isinstance(expansion.source, ExpandedSource):
            return expansion.source
        for part in expansion.undetermined:
            raise NotDecided(part.reason)
        first = expansion.problems[0]
        raise MissingElement(
            "xacro", path, message=first.message, location=first.location, problem=first.message
        )

    def _launched_packages(self, path: str) -> list[Package]:
        if not self.graded:
            loose = launch_folders(self.tree, self.packages, [path] if not self.is_single else [])
            return [reference.under(self.launch_arguments) for reference in loose]
        name = basename(path)
        if self.graded.robot_references(name):
            return [self.graded]
        owner = next((package for package in self.packages if package.holds(path)), self.graded)
        return self._packages_that_read(name, owner) or [self.graded]

    def _packages_that_read(self, name: str, owner: Package) -> list[Package]:
        """Return the packages whose launch files read a file of this name of its package."""
        launched = []
        for package in self.packages:
            if package is owner or package.name != owner.name:
                references = package.robot_references(name)
                if any(owner.find_source(reference.path or "") for reference in references):
                    launched.append(package)
        return launched

    @property
    def paths(self) -> Collection[str]:
        """The paths of the files."""
        return self.tree.files

    @property
    def is_part(self) -> bool:
        """Whether the files may be a part of any package, because there is none among them."""
        return bool(self.tree.files) and not self.packages

    def package(self, name: str) -> str | None:
        """Return the folder of a package."""
        return next((package.folder for package in self._named(name)), None)

    def _named(self, name: str) -> list[Package]:
        """Return the packages of a name, of several that of the URDF first."""
        return sorted(
            (candidate for candidate in self.packages if candidate.name == name),
            key=lambda candidate: candidate is not self.graded,
        )

    def read(self, path: str) -> bytes:
        """Return the bytes of a file. Raises InputError, NotDecided."""
        file = self.tree.files.get(path)
        if not file:
            raise self._error_of_missing(path)
        try:
            return file.read(URDF_LIMIT)
        except InputError as error:
            raise NotDecided(str(error)) from None

    def _error_of_missing(self, path: str) -> Exception:
        """Return why a file is not there: NotDecided if it may only not be submitted."""
        ignored = next((other for other in self.tree.ignored if other.path == path), None)
        if ignored:
            return NotDecided(str(ignored))
        if not self.tree.files:
            return NotDecided(
                f"the included file {path} is not read with a single file: give the folder "
                "with both"
            )
        if self.is_single and not self.packages:
            return NotDecided(
                f"there is no file {path} in the folder of this single file: give the "
                "folder with both"
            )
        return InputError(f"there is no file {path} in the {self.called}")

    def installed(self, package: str, inside: str) -> str | None:
        """Return the file at a path in a package once it is built.

        Without any package, return the most similar path.
        """
        owners = list(self._named(package))
        if owners:
            return self._installed_by(owners[0], package, inside)
        if self.packages:
            return None
        steps = inside.split("/")
        for count in range(len(steps), 0, -1):
            end = "/" + "/".join(steps[-count:])
            matches = [path for path in self.tree.files if f"/{path}".endswith(end)]
            if len(matches) == 1:
                return matches[0]
        return None

    def _installed_by(self, owner: Package, package: str, inside: str) -> str | None:
        """Return the file that a build of a package installs at a path in the share folder."""
        if self.assumes_defaults and inside in owner.tree.files:
            return owner.path(inside)
        source = owner.installed.get(f"share/{package}/{inside}")
        setup = owner.installation
        if source is not None:
            return owner.path(source)
        is_similar = any(f"/{path}".endswith(f"/{inside}") for path in owner.tree.files)
        if is_similar and setup and setup.is_cmake and setup.unknown:
            raise Undetermined(
                f"cannot determine statically whether CMakeLists.txt installs {inside}"
            )
        return None


def launch_folders(tree: Tree, packages: Sequence[Package], paths: Iterable[str]) -> list[Package]:
    """Return the nearest folders around these files with launch files, as packages.

    These launch files are outside of packages.
    """
    packaged = tuple(package.path("") for package in packages)
    loose = tree.only(lambda path: not path.startswith(packaged)) if packaged else tree
    files = Package("", loose, None, {}).launch_files
    folders = {folder for path in files for folder in (*parents(path), "")}
    around = set()
    for path in paths:
        nearest = next((folder for folder in (*parents(path), "") if folder in folders), None)
        if nearest is not None:
            around.add(nearest)
    return [
        Package(folder, loose.below(folder), None, {}) for folder in sorted(around)[:_MAX_FOLDERS]
    ]


def read_as_ros(data: bytes, path: str, surroundings: Surroundings | None = None) -> Read:
    """Read a URDF as ROS 2 gets it.

    It is expanded if a launch file runs xacro on it, or else if its name says xacro.

    Other xacro is loaded as it stands; unless that makes no difference, everything but that is
    graded on its expansion.
    """
    surroundings = surroundings or Surroundings(Budget())
    releases = surroundings.releases
    if not _needs_xacro(data):
        reading = read_urdf(data, path, releases)
        if not any(problem.kind in (DOCTYPE, NOT_WELL_FORMED) for problem in reading.problems):
            return Read(path, data, reading)
    launched = surroundings.robot_references(path)
    if _is_run_by_xacro(path, surroundings, launched):
        expanded = _expanded(data, path, surroundings, launched)
        return Read(path, data, expanded, is_expanded=True, has_xacro=True)
    reading = read_urdf(data, path, releases)
    if not reading.raw_xacro:
        return Read(path, data, reading, has_xacro=True)
    expanded = _expand_xacro(data, path, surroundings, [])
    if not expanded.robot:
        return Read(path, data, reading, has_xacro=True)
    if reading.verdict == "clean":
        if _loaded_model(reading) == _loaded_model(expanded):
            return Read(path, data, reading, has_xacro=True)
        # ROS 2 ignores the tags of xacro, and what they stand for.
        reading = reading._replace(verdict="degraded")
    return Read(path, data, expanded, is_expanded=True, has_xacro=True, as_it_stands=reading)


def _is_run_by_xacro(
    path: str, surroundings: Surroundings, launched: "Iterable[NamedFile]"
) -> bool:
    """Return whether ROS 2 gets a file from xacro: launch files say so, else its name."""
    programs = {reference.by for reference in launched}
    if programs:
        return programs == {"xacro"}
    name = basename(path).lower()
    # Nothing loads a file of another name as a URDF; standard input is one.
    if ".xacro" in name or (".urdf" not in name and name != "-"):
        return True
    return surroundings.assumes_defaults and surroundings.runs_xacro_beside(path)


def _loaded_model(reading: Reading) -> tuple[object, ...]:
    """Return the links, shapes and joints that ROS 2 loads, without the masses: RViz needs none."""
    robot = reading.robot
    if not robot:
        return ()
    links = {link.name: (link.visuals, link.collisions) for link in robot.links}
    return links, {joint.name: joint for joint in robot.joints}


def _needs_xacro(data: bytes) -> bool:
    """Return whether there is xacro in a text, outside of comments."""
    return (b"$" in data or b"xacro:" in data) and find_xacro(
        data.decode("utf-8", "replace")
    ) is not None


def _expanded(
    data: bytes, path: str, surroundings: Surroundings, references: "Sequence[NamedFile]"
) -> Reading:
    """Return the robot that xacro makes of a file.

    Where it fails under arguments that are assumed, return the robot without them.
    """
    reading = _expand_xacro(data, path, surroundings, references)
    fails = any(problem.kind.is_before_ros for problem in reading.problems)
    if surroundings.assumes_defaults and fails:
        return _expand_xacro(data, path, surroundings._replace(assumes_defaults=False), references)
    return reading


def _expand_xacro(
    data: bytes, path: str, surroundings: Surroundings, references: "Sequence[NamedFile]"
) -> Reading:
    """Return the robot that xacro makes of a file.

    Where it cannot be expanded at all, return what can be read of the text.

    The folder that a build installs a package in is called differently in launch files and in
    xacro. A file that the launch file names there and that no build certainly installs stays as it
    is: what is in it cannot be determined.
    """
    from grader.ros.installation.places import SHARE  # late: most URDFs are no xacro
    from grader.ros.xacro.texts import INSTALLED

    launched = dict(references[0].arguments) if references else {}
    if surroundings.assumes_defaults:
        launched = known_values(launched)
    given = dict(launched)
    for name, text in launched.items():
        shared = re.fullmatch(rf"{SHARE}/([^/]+)/?(.*)", text or "")
        if not shared:
            continue
        package, inside = shared.groups()
        is_known = not inside or surroundings.package(package) is None
        with suppress(Undetermined):
            is_known = is_known or surroundings.installed(package, inside) is not None
        if is_known:
            given[name] = f"{INSTALLED}/{package}/share/{package}/{inside}".rstrip("/")
    arguments = {**surroundings.launch_arguments, **given, **surroundings.arguments}
    others = surroundings.other_arguments(path, references)
    key = (data, path, tuple(arguments.items()), others, newest_version(surroundings.releases))
    if not surroundings.memory:
        return _read_expanded(*key, surroundings)

    from grader.ros.package.recorded_files import RecordedFiles  # late: only editors read twice

    def read(answers: "Answers[SurroundingFiles]") -> Reading:
        return _read_expanded(*key, RecordedFiles(answers, surroundings.budget))

    files: SurroundingFiles = surroundings
    return surroundings.memory.recall(key, files, surroundings.budget, read)


def _read_expanded(
    data: bytes,
    path: str,
    arguments: "tuple[tuple[str, str | None], ...]",
    others: "OtherArguments",
    newest: UrdfVersion,
    files: "SurroundingFiles",
) -> Reading:
    """Return the robot that xacro makes of a file with these arguments, as `_expand_xacro` does."""
    from grader.ros.xacro.expansion import expand  # late: as above

    expansion = expand(data, path, files, dict(arguments), others)
    if expansion.root is None and expansion.recovered is None and expansion.problems:
        raw = read_robot(read_document(data, path), newest)
        problems = [
            problem for problem in raw.problems if problem.kind not in (RAW_XACRO, NOT_WELL_FORMED)
        ]
        return Reading("rejected", raw.robot, (*expansion.problems, *problems), raw.source)
    return _read_document(expansion.document, newest)


def _read_document(document: XmlDocument, newest: UrdfVersion) -> Reading:
    """Return the robot of a document.

    The fixes of a text that xacro expanded edit what it was expanded from.
    """
    if not document.source.is_expanded:
        return read_robot(document, newest)

    def rewrites(index: int, attribute: str, values: tuple[str, str]) -> list[Edits]:
        from grader.ros.xacro.rewriting import ExpandedEdits  # late: few problems are fixed

        edits = ExpandedEdits(cast("ExpandedSource", document.source))
        return edits.rewrites(attribute, {index: values})

    return read_robot(document._replace(rewrites=rewrites), newest)
