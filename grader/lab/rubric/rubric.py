"""A rubric: the facts that are checked, and their points.

It is loaded strictly: all mistakes are reported at once.
"""

from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import field
from decimal import Decimal
from functools import cache, cached_property, lru_cache
from itertools import starmap
from pathlib import Path

from grader.base.errors import InputError, RubricError
from grader.base.grouping import Strings, StringsByName
from grader.base.names import did_you_mean
from grader.base.records import Record
from grader.base.reuse import Memory
from grader.base.text import printable_path, shell_quoted, texts_in
from grader.base.toml_file import (
    TomlPath,
    TomlRow,
    find_line,
    key_lines,
    raise_complaints,
    read_toml,
)
from grader.files.limits import ARCHIVES, ROBOT_ENDINGS
from grader.files.reading import hash_bytes, read_capped, shipped_folder
from grader.lab.checks.check import LINK_ARGUMENTS
from grader.lab.checks.manual import answered
from grader.lab.rubric.criterion import (
    Adjustment,
    Carried,
    Criterion,
    Evidence,
    Ignored,
    Late,
    Part,
)
from grader.lab.rubric.hint_levels import HintLevel
from grader.lab.rubric.validation import BoundCarried, BoundCheck, Complaint, Validation
from grader.lab.submission.opening import open_submission
from grader.lab.submission.submission import Lab, Submission
from grader.ros.known.releases import Release
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.link_tree import is_selector
from grader.ros.urdf.reader import Reading, find_xacro, read_urdf

_URDF = "robot.urdf"
# The keys of a file that are fields of a rubric with the same default.
_WITH_DEFAULTS = (
    *("package", "packages", "answers", "folders", "without_urdf", "without_package"),
    *("hints", "distro", "transforms"),
)
RUBRIC_FILE = "rubric.toml"  # in the folder of a shipped rubric
_LIST = "(`grader rubric list` lists the rubrics that come with the grader)"


class ReferenceSolution:
    """A rubric's own solution; no more is read than is needed.

    Properties raise InputError where it cannot be read.
    """

    def __init__(self, path: Path, lab: Lab, error: Callable[[str], InputError]) -> None:
        """`error` makes one of what is wrong with the reference, with the line that names it."""
        self._path = path
        self._lab = lab
        self._error = error
        self._others: dict[tuple[tuple[str, str], ...], ReferenceSolution] = {}

    @cached_property
    def submission(self) -> Submission:
        """The solution as a submission."""
        if not self._path.exists():
            raise self._error("does not exist")
        return open_submission(str(self._path), self._lab)

    @cached_property
    def reading(self) -> Reading:
        """Its URDF; the rest is not read where the URDF is known and is no xacro."""
        file = self._path / self._lab.urdf
        if file.suffix == ".urdf" and file.is_file():
            reading = read_urdf(read_capped(file), self._lab.urdf, self._lab.releases)
            if find_xacro(reading.source.text) is None:
                return reading
        try:
            return self.submission.needed_urdf()
        except LookupError as error:
            raise self._error(f"cannot be compared with: {error}") from None

    @cached_property
    def robot(self) -> Configuration:
        """Its robot, with the joints at 0."""
        if not self.reading.robot:
            raise self._error("cannot be compared with: it has no robot")
        return Configuration(self.reading.robot)

    def under(self, arguments: StringsByName) -> "ReferenceSolution":
        """Return the solution under launch arguments, which is read once."""
        key = tuple(sorted(arguments.items()))
        if key not in self._others:
            self._others[key] = ReferenceSolution(self._path, self._lab, self._error)
            self._others[key].submission = self.submission.under(arguments)
        return self._others[key]


class Rubric(Record):
    """A lab as data: which facts are checked, in which order, and what each is worth.

    `load_rubric` reads it from a TOML file, and refuses it with all mistakes at once. Grading runs
    its criteria in file order; reports, the gradebook and the commands on rubrics read the rest.

    >>> rubric = load_rubric("lab6")
    >>> [(part.id, part.needs) for part in rubric.parts][:2]
    [('task1', 'urdf'), ('task2', 'package')]
    >>> rubric.criteria[0].check.name, rubric.criteria[0].points
    ('urdf_loads', Decimal('3'))
    """

    id: str
    title: str
    parts: tuple[Part, ...]
    criteria: tuple[Criterion, ...]
    urdf: str  # the path of the graded URDF in its package
    reference: str  # the path of the reference solution; empty without one
    data: bytes  # of the file
    path: Path = field(compare=False)  # of the file
    package: str = ""  # the name of the graded package
    packages: tuple[
        str, ...
    ] = ()  # the names of all packages that criteria are about, if there are several
    evidence: tuple[Evidence, ...] = ()
    late: Late | None = None
    answers: str = ""  # the path of the file with the model answers, if any
    folders: Strings = ()  # the names of the lab's folder in a repository of several labs
    # what criteria are with evidence, but no URDF: "manual", or "failed", as where it is empty
    without_urdf: str = ""
    without_package: str = ""  # the same without a package
    hints: HintLevel = "cause"  # the most that hints tell
    ignored: tuple[Ignored, ...] = ()  # mutants that `grader rubric test` lets pass
    distro: Release = "jazzy"  # the release of ROS 2
    transforms: Strings = ()  # launch files whose static transforms are part of the robot
    solution: ReferenceSolution | None = field(default=None, compare=False)
    links: frozenset[str] = frozenset()  # that criteria name
    # the packages of other people whose programs criteria name
    installed: frozenset[str] = frozenset()
    _memory: Memory = field(default_factory=Memory, init=False, compare=False)  # of its submissions

    @property
    def lab(self) -> Lab:
        """What is searched in a submission."""
        return Lab(
            self.urdf,
            self.package,
            self.folders,
            self.links,
            self.packages,
            self._memory,
            self.installed,
            self.distro,
        )

    @property
    def compares_with_reference(self) -> bool:
        """Return whether a check compares submissions with the reference solution."""
        return any("reference" in criterion.check.examined for criterion in self.criteria)

    @cached_property
    def base(self) -> str:
        """The link that criteria measure in most often; empty if they name none."""
        names = (
            name for row in self.criteria for name in texts_in(row.arguments.get("relative_to", ()))
        )
        return max(sorted(Counter(names).items()), key=lambda pair: pair[1], default=("", 0))[0]

    @cached_property
    def sha256(self) -> str:
        """The hash of the file's bytes."""
        return hash_bytes(self.data)

    @cached_property
    def points(self) -> Decimal:
        """The maximum, without extra credit."""
        return sum((criterion.maximum for criterion in self.criteria), Decimal(0))

    @property
    def is_shipped(self) -> bool:
        """Return whether it comes with the grader and is named by its id."""
        return shipped_rubrics().get(self.id) == self.path

    @property
    def is_copy_of_shipped(self) -> bool:
        """Return whether its text is that of the rubric of this id that comes with the grader."""
        shipped = shipped_rubrics().get(self.id)
        return shipped is not None and self.data == shipped.read_bytes()

    @property
    def shown_by(self) -> str:
        """The command that shows its parts and criteria."""
        return f"grader rubric show {self.id if self.is_shipped else shell_quoted(self.path)}"

    def find_line(self, path: TomlPath) -> int:
        """Return the line of a key in the file, or of the innermost table around it."""
        return _line_in(self.data, self.path, path)

    def find_place(self, path: TomlPath) -> str:
        """Return the file and the line of a key: my_lab.toml:12."""
        return f"{printable_path(self.path)}:{self.find_line(path)}"

    def part(self, name: str) -> Part:
        """Return the part with this id; raise InputError, which lists the parts."""
        for part in self.parts:
            if part.id == name:
                return part
        known = [part.id for part in self.parts]
        guess = did_you_mean(name, known) or f"; it has: {', '.join(known)}"
        several = [word for word in name.replace(",", " ").split() if word in known]
        if len(several) > 1:
            guess = f"; repeat the option: --part {' --part '.join(several)}"
        raise InputError(
            f"the rubric {self.id} has no part {name!r}{guess} (see `{self.shown_by}`)"
        )


def _line_in(data: bytes, file: Path, path: TomlPath) -> int:
    return find_line(_list_lines(data, file), path)


@lru_cache(maxsize=1)
def _list_lines(data: bytes, file: Path) -> dict[TomlPath, int]:
    return key_lines(read_toml(data, file)[0])


@cache
def shipped_rubrics() -> Mapping[str, Path]:
    """Return the rubrics that come with the grader, by id."""
    return {
        path.parent.name: path
        for path in sorted(shipped_folder("rubrics").glob(f"*/{RUBRIC_FILE}"))
    }


def find_rubric(name: str) -> Path:
    """Return the file of a rubric that is named by its id or path; raise RubricError."""
    shipped = shipped_rubrics()
    if name in shipped:
        return shipped[name]
    if not name:
        raise RubricError((f"the name of the rubric is empty {_LIST}",))
    path = Path(name)
    if (
        path.suffix == ".toml" or path.name != name
    ):  # a bare word is an id, never a file of the submission
        _refuse_other_path(path)
        return path
    if path.name.lower().endswith(ROBOT_ENDINGS + ARCHIVES):
        advice = f"`grader grade {shell_quoted(path)}` grades it"
        raise RubricError((f"--rubric takes no submission such as {name!r}; {advice}",))
    guess = did_you_mean(name, shipped) or f"; write ./{printable_path(name)} for a file"
    raise RubricError((f"there is no rubric {name!r}{guess} {_LIST}",))


def _refuse_other_path(path: Path) -> None:
    """Raise RubricError for a path that is no rubric's, but names one that is known."""
    shown = printable_path(path)
    if path.is_dir():
        files = sorted(path.glob("*.toml"))
        names = [file for file in files if file.name == RUBRIC_FILE or len(files) == 1]
        guess = f"; did you mean --rubric {shell_quoted(names[0])}?" if names else ""
        raise RubricError((f"{shown} is a folder, not the .toml file of a rubric{guess}",))
    shipped = [name for name in shipped_rubrics() if name in (path.stem, *path.parts)]
    if shipped and not path.exists():
        raise RubricError((f"{shown} does not exist; did you mean --rubric {shipped[0]}?",))


def load_rubric(name: str | Path) -> Rubric:
    """Load a rubric by its id or path, without model answers (see `model_answers`).

    Raises RubricError with one line for each mistake in it, InputError if it cannot be read.

    >>> load_rubric("arm").points
    Decimal('100')
    """
    path = find_rubric(str(name))
    return read_rubric(read_capped(path, advice=""), path)


def read_rubric(data: bytes, path: Path, *, answers: bool = False) -> Rubric:
    """Return the rubric in the bytes of a file, with or without the model answers in it.

    Raise RubricError.
    """
    valid = _validate(data, path)
    return _made_rubric(valid, data, path, range(len(valid.criteria)), answers=answers)


def _made_rubric(
    valid: Validation, data: bytes, path: Path, positions: Sequence[int], *, answers: bool
) -> Rubric:
    """Return the rubric of validated rows, which are at these positions in the file."""
    rubric = valid.rubric
    adjusted = {name: Adjustment(**row) for name, row in valid.adjusted.items()}
    criteria = []
    rows = zip(positions, valid.criteria, valid.bound, valid.carried, strict=True)
    for position, row, bound, carried in rows:
        criterion = _make_criterion(position, row, bound, carried, answers=answers)
        criteria.append(_adjust(criterion, adjusted))
    parts = [Part(row["id"], row["title"], row.get("needs", "urdf")) for row in valid.parts]
    evidence = [Evidence(**row) for row in valid.evidence]
    ignored = [Ignored(**row) for row in valid.ignored]
    late = Late(**valid.late) if valid.late is not None else None
    given = {key: rubric[key] for key in _WITH_DEFAULTS if key in rubric}
    names = {rubric.get("package", ""), *rubric.get("packages", ())}
    return Rubric(
        id=rubric["id"],
        title=rubric["title"],
        parts=tuple(parts),
        criteria=tuple(criteria),
        urdf=rubric.get("urdf", _URDF),
        reference=rubric.get("reference", ""),
        data=data,
        path=path,
        evidence=tuple(evidence),
        late=late,
        ignored=tuple(ignored),
        solution=_reference_solution(rubric, path, data),
        links=frozenset(_links_named(valid.bound)),
        installed=frozenset(_packages_named(valid.bound)).difference(names),
        **given,
    )


@lru_cache(maxsize=2)
def _validate(data: bytes, path: Path) -> Validation:
    """Return the valid content of a file, which a command may need with and without answers."""
    text, table = read_toml(data, path)
    valid = Validation(table)
    raise_complaints(valid.complaints, text, path)
    return valid


def unknown_causes(rubric: Rubric) -> list[Complaint]:
    """Return the places of `carried` tables that name unknown criteria, and the names.

    They are ignored.
    """
    return Validation(read_toml(rubric.data, rubric.path)[1]).unknown_causes


def read_correct_rows(data: bytes, path: Path) -> Rubric | None:
    """Return a rubric without the criteria in which there are mistakes, and without its totals.

    It is None if there are other mistakes in it.
    """
    table = read_toml(data, path)[1]
    rows = table.get("criterion")
    if not isinstance(rows, list):
        return None
    table.pop("points", None)
    for part in table.get("part", ()):
        if isinstance(part, dict):
            part.pop("points", None)
    positions = list(range(len(rows)))
    while positions:
        table["criterion"] = [rows[position] for position in positions]
        valid = Validation(deepcopy(table))
        wrong = {place[1] for place, _ in valid.complaints if place[:1] == ("criterion",)}
        if not valid.complaints:
            return _made_rubric(valid, data, path, positions, answers=False)
        if not wrong or any(place[:1] != ("criterion",) for place, _ in valid.complaints):
            return None
        positions = [position for index, position in enumerate(positions) if index not in wrong]
    return None


def _links_named(bound: Iterable[BoundCheck]) -> Iterator[str]:
    """Yield the names of links in the arguments of checks."""
    for check, given in bound:
        # names_agree has another `of`
        arguments = LINK_ARGUMENTS if "robot" in check.examined else ("links",)
        for name in texts_in([value for key, value in given.items() if key in arguments]):
            if name and not is_selector(name):
                yield name


def _packages_named(bound: Iterable[BoundCheck]) -> Iterator[str]:
    """Yield the packages in the arguments of checks: that of controller_manager/spawner."""
    for check, given in bound:
        if check.name == "node_runs":
            for text in texts_in(given.get("nodes", ())):
                for name in text.split(" or "):
                    yield name.partition("/")[0]


def _reference_solution(rubric: TomlRow, path: Path, data: bytes) -> ReferenceSolution | None:
    if not rubric.get("reference"):
        return None
    place = path.parent / rubric["reference"]
    package = rubric.get("package", "")
    lab = Lab(
        rubric.get("urdf", _URDF),
        package,
        rubric.get("folders", ()),
        packages=rubric.get("packages", ()),
        memory=Memory(),
        distro=rubric.get("distro", "jazzy"),
    )

    def error(what: str) -> InputError:
        line = _line_in(data, path, ("reference",))
        name = rubric["id"]
        text = f"{printable_path(path)}:{line}: the reference {printable_path(place)} {what}"
        if name in shipped_rubrics() and not place.exists():
            text += f" (`grader rubric copy {name} FOLDER` copies a rubric with its reference)"
        return InputError(text)

    return ReferenceSolution(place, lab, error)


def _make_criterion(
    position: int,
    row: TomlRow,
    bound: BoundCheck,
    carried: Sequence[BoundCarried],
    *,
    answers: bool,
) -> Criterion:
    check = bound[0]
    arguments = dict(bound[1])
    # Nothing that lists or passes on a criterion's arguments may see the model answer.
    answer = arguments.pop("answer", "") if check.function is answered else ""
    fields = {key: value for key, value in row.items() if key not in ("check", "with", "carried")}
    fields |= {
        "check": check,
        "arguments": arguments,
        "position": position,
        "answer": answer if answers else "",
    }
    texts = texts_in((arguments, *(given for _, _, given, _ in carried)))
    fields["has_selectors"] = any(map(is_selector, texts))
    return Criterion(**fields, carried=tuple(starmap(Carried, carried)))


def _adjust(criterion: Criterion, adjustments: Mapping[str, Adjustment]) -> Criterion:
    """Return a criterion with its adjustment, if there is one."""
    adjustment = adjustments.get(criterion.id)
    if not adjustment:
        return criterion
    points = Decimal(0) if adjustment.action == "drop" else criterion.points
    return criterion._replace(points=points, adjustment=adjustment)
