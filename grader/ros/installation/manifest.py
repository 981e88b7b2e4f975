"""package.xml: name, build type and problems of a package (REP 127, 140 and 149)."""

from collections.abc import Iterator, Mapping, Sequence

from grader.base.merge_conflicts import resolve_conflicts
from grader.base.problems import Problem
from grader.base.records import Named
from grader.base.reuse import reuse
from grader.base.source import Location, Source
from grader.ros.installation import package_problems as kinds
from grader.ros.installation.manifest_conditions import evaluate_condition
from grader.ros.installation.manifest_rules import find_refusals, read_email, read_tag, read_text
from grader.ros.xml.parsing import Element, XmlFault, XmlFile, recover_xml

_MAX_MISPLACED = 100  # dependencies in <export>


class DeclaredDependency(Named):
    """A dependency in package.xml, with its tag: exec_depend."""

    name: str
    tag: str
    location: Location
    is_conditional: bool


class Manifest(Named):
    """The content of a package.xml.

    `name` is None where it cannot be read; `build_type` is by default colcon's.

    Of a file that is not well-formed XML, both are what can still be read; the build type may then
    be empty.
    """

    source: Source
    name: str | None
    build_type: str
    problems: tuple[Problem, ...]
    name_location: Location
    type_location: Location
    unread: str = ""  # why the file was not read at all: too large, damaged
    dependencies: frozenset[str] = frozenset()  # the packages that it depends on, in any way
    groups: frozenset[str] = frozenset()  # of packages, of which it is a member
    misplaced: Mapping[str, Location] = {}  # dependencies in <export>, which do not count
    declared: tuple[DeclaredDependency, ...] = ()  # the dependencies, in their order
    version: str = ""
    has_build_type: bool = False
    loose_texts: tuple[tuple[str, Location], ...] = ()  # between elements, with these

    @property
    def refusals(self) -> tuple[Problem, ...]:
        """The problems for which the tools of ROS 2 do not take the package for one of ROS 2."""
        return tuple(
            problem
            for problem in self.problems
            if problem.kind in (kinds.BAD_MANIFEST, kinds.REFUSED_MANIFEST)
        )


@reuse
def read_manifest(data: bytes, path: str) -> Manifest:
    """Read a package.xml. It never raises: errors are among the problems."""
    resolved = resolve_conflicts(data)
    if resolved:
        manifest = read_manifest(resolved.data, path)
        problem = Problem(
            kinds.BAD_MANIFEST,
            f"package.xml has {resolved.message}",
            Location(path, resolved.line, 1),
        )
        return manifest._replace(problems=(problem, *manifest.problems))
    source = Source.decoded(path, data)
    try:
        file = XmlFile(data, source)
    except XmlFault as fault:
        problem = Problem(
            kinds.BAD_MANIFEST, f"package.xml is not readable as XML: {fault}", fault.location
        )
        return _read_broken(data, source, problem)
    root = file.root
    start = Location(path, 1, 1)
    if read_tag(root) != "package":
        problem = Problem(
            kinds.BAD_MANIFEST, f"the root of package.xml is <{root.tag}>, not <package>", start
        )
        return Manifest(source, None, "", (problem,), start, start)
    problems = list(_problems(file))
    try:
        data.decode()
    except UnicodeDecodeError:
        problems.append(_refused("the file is not UTF-8 text; save it as UTF-8", start))
    return _manifest_in(file, source, problems)


def _is_used_build_type(element: Element) -> bool:
    is_used = evaluate_condition(element.get("condition")) is not False
    return read_tag(element) == "build_type" and is_used


def _manifest_in(file: XmlFile, source: Source, problems: Sequence[Problem]) -> Manifest:
    """Return what a package.xml says that can be read."""
    root = file.root
    exports = _exports(root)
    build_types = [element for element in exports if _is_used_build_type(element)]
    names = []
    groups = set()
    for element in root.iterchildren("*"):
        tag = read_tag(element)
        if tag == "name":
            names.append(element)
        elif tag == "member_of_group":
            groups.add(read_text(element))
    declared = _declared_dependencies(file)
    name = read_text(names[0]) if names else ""
    build_type = " and ".join(map(read_text, build_types)) if build_types else "catkin"
    return Manifest(
        source,
        name or None,
        build_type,
        (*problems, *_condition_problems(file, exports)),
        file.location([*names, root][0]),
        file.location([*build_types, root][0]),
        dependencies=frozenset(dependency.name for dependency in declared),
        groups=frozenset(groups),
        misplaced=_misplaced_dependencies(file, exports),
        declared=declared,
        version=root.findtext("{*}version", "").strip(),
        has_build_type=bool(build_types),
        loose_texts=_loose_texts(file),
    )


def _declared_dependencies(file: XmlFile) -> tuple[DeclaredDependency, ...]:
    """Return the dependencies in a package.xml."""
    declared = []
    for element in file.root.iterchildren("*"):
        tag = read_tag(element)
        if tag.endswith("depend"):
            is_conditional = element.get("condition") is not None
            at = file.location(element)
            declared.append(DeclaredDependency(read_text(element), tag, at, is_conditional))
    return tuple(declared)


def _loose_texts(file: XmlFile) -> tuple[tuple[str, Location], ...]:
    """Return the texts between the elements of a package.xml, with the elements before them."""
    texts = []
    for element in file.root.iterchildren("*"):
        text = (element.tail or "").strip()
        if text:
            texts.append((text, file.location(element)))
    return tuple(texts)


def _read_broken(data: bytes, source: Source, problem: Problem) -> Manifest:
    """Return what can be read of a package.xml that is not XML.

    This is the first name, and the first build type.
    """
    root = recover_xml(data)
    start = Location(source.path, 1, 1)
    if root is None or read_tag(root) != "package":
        return Manifest(source, None, "", (problem,), start, start)
    name = root.findtext(".//{*}name") or ""
    build_type = root.findtext(".//{*}build_type") or ""
    location = problem.location
    return Manifest(
        source, name.strip() or None, build_type.strip(), (problem,), location, location
    )


def _misplaced_dependencies(file: XmlFile, exports: Sequence[Element]) -> dict[str, Location]:
    """Return the dependencies that stand in <export>, where no tool reads them."""
    exported = [element for element in exports if read_tag(element).endswith("depend")]
    return {read_text(element): file.location(element) for element in exported[:_MAX_MISPLACED]}


def _exports(root: Element) -> list[Element]:
    exports = (element for element in root.iterchildren("*") if read_tag(element) == "export")
    return [element for export in exports for element in export.iterchildren("*")]


def _refused(words: str, location: Location) -> Problem:
    return Problem(
        kinds.REFUSED_MANIFEST, f"the tools of ROS 2 refuse package.xml: {words}", location
    )


def _problems(file: XmlFile) -> Iterator[Problem]:
    root = file.root
    for words, element in find_refusals(root):
        yield _refused(words, file.location(element))
    for element in root.iterchildren("*"):
        tag = read_tag(element)
        email = element.get("email") or ""
        is_text = tag in ("license", "maintainer", "description")
        if is_text and "todo" in f"{element.text or ''} {email}".lower():
            yield Problem(
                kinds.STILL_TO_DO, f"<{tag}> of package.xml is still TODO", file.location(element)
            )
        if tag in ("maintainer", "author") and read_email(element) != email:
            message = (
                f"the email of <{tag}> in package.xml is in quotes, as git has it: delete the "
                "inner quotes"
            )
            yield Problem(kinds.QUOTED_EMAIL, message, file.location(element))
    version = root.get("format", "1")
    if version not in ("2", "3"):
        message = f"package.xml has format {version[:20]}; ROS 2 packages use format 3"
        yield Problem(kinds.OLD_FORMAT, message, file.location(root))


def _condition_problems(file: XmlFile, exports: Sequence[Element]) -> Iterator[Problem]:
    for element in (*file.root.iterchildren("*"), *exports):
        condition = element.get("condition")
        if condition is not None and evaluate_condition(condition) is None:
            words = f"condition '{condition[:100]}' failed to parse: write it as $ROS_VERSION == 2"
            yield _refused(words, file.location(element))
