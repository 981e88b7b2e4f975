"""The facts of the packages of a reference.

They are about files, builds, launch and RViz files, names and parameters.
"""

import posixpath
import re
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any

from grader.base.errors import MissingElement, NotDecided
from grader.base.text import counted, enumerated, first_lines
from grader.base.toml_file import toml_literal
from grader.lab.authoring.facts import (
    CarriedFact,
    Fact,
    Facts,
    Omission,
    Solution,
    are_joints_free,
)
from grader.lab.authoring.graph_facts import LaunchConnections
from grader.lab.checks.parameters import measures
from grader.lab.checks.started_nodes import LIFECYCLE_MANAGER, managed_nodes
from grader.lab.submission.edited import content
from grader.lab.submission.submission import Submission
from grader.ros.installation.places import PREFIX, is_of_one_machine
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.package.package import Package
from grader.ros.python.values import Unknown
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.link_tree import JOINT_OF
from grader.workspace.api import (
    looked_up_transforms,
    opened_by_bridge,
    parameter_callbacks,
    spawned_by,
    started_worlds,
)
from grader.workspace.graph.code_ends import opened_by
from grader.workspace.rules.reading import read_agreement, wrong_names
from grader.workspace.rules.rule_table import FAMILIES, Family

_THE_PACKAGE, _THE_NAMES, _THE_VALUES = "The package", "The names", "The values"  # headings
_NAME_TITLES: Mapping[Family, str] = {
    "files": "a build installs every file that is named",
    "frames": "every frame, link and joint that is named exists",
    "controllers": "all spawners, controllers and interfaces fit together",
    "parameters": "every parameter file has parameters of the nodes that get it",
    "arguments": "every launch and xacro argument that is passed is declared",
    "programs": "every program, entry point and node that is named exists",
    "topics": "topics have the same names, types and quality of service in all nodes",
    "dependencies": "each package.xml declares the packages that the files use",
    "services": "services and actions have the same names and types in all nodes",
    "interfaces": "every message, service, action and field that is used exists",
    "code": "nothing in the code certainly stops a node, or keeps it from working",
    "values": "no number that the files say of the robot contradicts it",
    "transforms": "the frames that are published are one tree",
}
# What is odd in a reference, and so is no criterion: a text, and what is counted in it.
_ODD: Mapping[Family, tuple[str, str]] = {
    "files": ("{} where no build installs a file", "path"),
    "frames": ("{} of frames, links and joints that do not exist", "use"),
    "controllers": ("{} in spawners, controllers and interfaces", "fault"),
    "parameters": ("{} in parameters and the nodes that get them", "fault"),
    "arguments": ("{} of launch and xacro arguments that are not declared", "use"),
    "programs": ("{} of programs, entry points and nodes that do not exist", "use"),
    "topics": ("{} in the names, types and quality of service of topics", "fault"),
    "dependencies": ("package.xml does not declare {} that the files use", "package"),
    "services": ("{} in the names and types of services and actions", "fault"),
    "interfaces": ("{} in messages, services, actions and their fields", "fault"),
    "code": ("{} in the code of nodes", "fault"),
    "values": ("{} in what files say of the robot", "number"),
    "transforms": ("{} in the transforms that are published", "fault"),
}
# Where one mistake is of two families, by the words of the facts that pay for it.
_SAME_PLACE: Mapping[Family, Sequence[tuple[tuple[str, ...], tuple[str, ...]]]] = {
    "files": [(("urdf_loads",), ("robot",))],
    "dependencies": [
        (("files names_agree", "programs names_agree"), ("files", "programs")),
    ],
}
_WHEEL = re.compile("wheel|axle|tire|tyre")
_DISTANCE = re.compile("separation|wheel_?base|wheel_?track|track_?width")
_NAMING = re.compile("joint|link|frame|wheel")
_EXACT = 1e-6
# What keeps launch files from starting, and nodes from their parameters.
_STOPPING = ("files names_agree", "arguments names_agree", "programs names_agree")
_OF_PARAMETERS = (*_STOPPING, "controllers names_agree", "parameters names_agree")
_OF_NAMING = (*_OF_PARAMETERS, "frames names_agree", "values names_agree")
_OF_CODE = ("code names_agree", "interfaces names_agree")
_OF_CONNECTIONS = (
    *_OF_NAMING,
    "topics names_agree",
    "services names_agree",
    "transforms names_agree",
)
# What of the nodes of a lab is seen from outside, by what they open.
_OPENING = {
    "publisher": "publishes",
    "service": "serves",
    "action server": "serves",
    "client": "calls",
    "action client": "calls",
}
_COMPARED = {
    "publishes": ("topics names_agree",),
    "subscribes": ("topics names_agree",),
    "serves": ("services names_agree",),
    "calls": ("services names_agree",),
}
_DONE = {
    "publishes": "publish",
    "subscribes": "subscribe to",
    "serves": "serve",
    "calls": "call",
}
# Warnings of `grader inspect` that mean that something does not work: of builds of C++, and of the
# code of nodes.
_CPP = (".cpp", ".cc", ".cxx")
_OF_TARGETS = ("PKG020", "PKG021", "own-header", "header-installed")
_OF_GOALS = ("goal-state", "callback-wait")
# The programs that publish a transform, in place of which any other node may.
_STATIC = ("tf2_ros/static_transform_publisher",)
_TURNED: Mapping[str, str | bool] = {"true": False, "false": True, "True": "False", "False": "True"}
_OWN_KINDS = (".urdf", ".xacro", ".rviz", ".py", ".xml", ".msg", ".srv", ".action")
_OF_BUILDS: tuple[Family, ...] = ("files", "programs")
_MEASURING = ("shows_cylinder", "shows_sphere", "frame_at")
_MOTION = "kinematics_match_reference"
_MAX_TEXT = 80  # characters of a value
_MAX_TITLE, _MAX_IN_TITLE = 95, 3  # characters; names
_MAX_ODD = 10  # mistakes of one family


def package_facts(submission: Submission) -> Facts:
    """Yield what may be true of the packages that are graded, first of the main one."""
    agreement = read_agreement(submission.workspace) if submission.lab_packages else None
    named = agreement.files if agreement is not None and agreement.holds("files") else frozenset()
    for package, prefix in _packages(submission):
        facts = _list_package_facts(submission, package, named, prefix)
        about = f"{_THE_PACKAGE} {package.name}" if prefix else _THE_PACKAGE
        of = package.name if prefix else ""
        for fact in facts:
            yield fact._replace(about=about, package=of, words=f"{prefix}{fact.words}")
    yield from _warning_facts(submission)
    yield from _simulation_facts(submission)
    yield from _lookup_facts(submission)
    yield from _callback_facts(submission)
    yield from _passed_facts(submission)


def _warning_facts(submission: Submission) -> Iterator[Fact]:
    """Yield that there are no warnings of what certainly does not work."""
    codes = submission.workspace.code.by_package.values()
    kinds = {end.kind for code in codes for node in code.nodes for end in node.endpoints}
    has_cpp = any(
        path.endswith(_CPP)
        for package in submission.lab_packages.values()
        for path in package.tree.files
    )
    if has_cpp:
        fact = _package_fact("without_problems", "targets", problems=[*_OF_TARGETS])
        yield fact._replace(
            title="the targets of builds find their headers and libraries, and these are installed",
            carried=_after(submission, *_builds(submission)),
        )
    if "action server" in kinds:
        fact = _package_fact("without_problems", "goals", problems=[*_OF_GOALS])
        yield fact._replace(
            title="each goal of an action ends, and gets a state",
            about=_THE_NAMES,
            carried=_after(submission, *_OF_CODE),
        )


def _after(submission: Submission, *causes: str) -> tuple[CarriedFact, ...]:
    """Return what counts instead of a fact if others fail: that there is a package."""
    if submission.package is None:
        return ()
    return (CarriedFact(causes, "package_found", {"name": submission.package.name}),)


def _simulation_facts(submission: Submission) -> Iterator[Fact]:
    """Yield which systems the world has that is launched."""
    worlds = started_worlds(submission.workspace)
    systems = sorted(worlds.systems) if worlds.files else []
    if systems:
        fact = _package_fact("world_has", systems=systems)
        title = f"the world has {enumerated(systems, _MAX_IN_TITLE)}"
        yield fact._replace(title=title, about=_THE_NAMES)


def _lookup_facts(submission: Submission) -> Iterator[Fact]:
    """Yield the transforms that nodes look up, where both frames are known."""
    seen = set()
    lookups, _ = looked_up_transforms(submission.workspace)
    for lookup in lookups:
        frames = lookup.target, lookup.source
        if None not in frames and frames not in seen:
            seen.add(frames)
            target, source = frames
            label = f"{target} {source}"
            fact = _package_fact("looks_up", label, target=target, source=source)
            title = f"a node looks up the pose of {source} in {target}"
            if lookup.inverts != "no":
                fact = fact._replace(arguments={**fact.arguments, "either_way": True})
                title += ", or its inverse"
            yield fact._replace(title=title, about=_THE_NAMES, carried=_after_names(submission))


def _callback_facts(submission: Submission) -> Iterator[Fact]:
    """Yield that a node is told of its parameters, or refuses values of them."""
    callbacks = parameter_callbacks(submission.workspace)
    carried = _after(submission, *_builds(submission), *_OF_CODE)
    if callbacks.refuses is not None:
        fact = _package_fact("takes_parameters", "refused", refuses=True)
        title = "a node refuses values of its parameters"
        yield fact._replace(title=title, about=_THE_NAMES, carried=carried)
    elif callbacks.told is not None:
        fact = _package_fact("takes_parameters", "set")
        title = "a node is told when its parameters are set"
        yield fact._replace(title=title, about=_THE_NAMES, carried=carried)


def _passed_facts(submission: Submission) -> Iterator[Fact]:
    """Yield the parameters that nodes get by arguments that launch files pass to others.

    What an argument does is asked, and not its name: a submission may divide its launch files in
    other ways.
    """
    passed: list[tuple[str, Any]] = []
    for package in submission.lab_packages.values():
        for path in package.launch_files:
            passed += _changed_by_passing(submission, package.launch(path))
    for fact in value_facts(submission):
        given = fact.arguments["parameter"], fact.arguments["value"]
        if given in passed:
            arguments = {**fact.arguments, "where_given": True}
            arguments.pop("or_default", None)
            yield fact._replace(about=_THE_NAMES, arguments=arguments)


def _changed_by_passing(submission: Submission, launch: Launch) -> Iterator[tuple[str, Any]]:
    """Yield the parameters of nodes in files that a launch file includes, with their values.

    These are other ones than under the defaults of the arguments of those files.
    """
    own_files = {}
    for package in submission.lab_packages.values():
        for target, path in package.installed.items():
            own_files[target] = package, path
    for passed in launch.passed:
        if not passed.when or not passed.values or passed.path not in own_files:
            continue
        package, path = own_files[passed.path]
        defaults = [_list_parameters(node) for node in package.launch(path).nodes]
        for node in launch.nodes:
            if node.included_by and node.location.path == package.path(path):
                for name, value in _list_parameters(node).items():
                    if not any(repr(each.get(name)) == repr(value) for each in defaults):
                        yield name, value


def _list_parameters(node: StartedNode) -> dict[str, Any]:
    """Return the values that a launch file itself gives the parameters of a node."""
    values: dict[str, Any] = {}
    for given in node.parameters or ():
        for name, parameter in given.values.items():
            values[name] = parameter.value
    return values


def _after_names(submission: Submission) -> tuple[CarriedFact, ...]:
    """Return what counts instead of what nodes do, if they do not run or get no parameters."""
    causes = (*_builds(submission), *_OF_PARAMETERS, *_OF_CODE, *words_of_launches(submission))
    return _after(submission, *causes)


def _packages(submission: Submission) -> Iterator[tuple[Package, str]]:
    """Yield the packages, the main one first.

    Each comes with what the words of its facts begin with.
    """
    for package in sorted(
        submission.lab_packages.values(),
        key=lambda lab_package: lab_package is not submission.package,
    ):
        yield package, "" if package is submission.package else f"{package.name} "


def words_of_launches(
    submission: Submission, wanted: Collection[str] | None = None
) -> Iterator[str]:
    """Yield the words of what the launch files start and find, or of those of the wanted names."""
    for package, prefix in _packages(submission):
        for name in map(posixpath.basename, package.launch_files):
            if wanted is None or name in wanted:
                for check in ("node_runs", "launch_complete"):
                    yield f"{prefix}{name} {check}"


def _builds(submission: Submission) -> tuple[str, ...]:
    """Return the words of the builds of the packages."""
    return tuple(f"{prefix}setup_imports" for _, prefix in _packages(submission))


def _list_package_facts(
    submission: Submission, package: Package, named: Collection[str], prefix: str
) -> Iterator[Fact]:
    """Yield what may be true of a package.

    That the files are installed which are `named` somewhere is a fact about names.
    """
    path = submission.path or ""
    yield _package_fact("package_found", name=package.name)
    if package.manifest is not None:
        of_type = _package_fact("package_type")
        yield of_type._replace(title="the build type in package.xml is that of the package's files")
    yield _package_fact("setup_imports")._replace(title="`colcon build` of the package succeeds")
    yield from _installs(
        package, path.removeprefix(package.path("")) if package.holds(path) else "", named
    )
    included = _included_launches(submission)
    for launch in (file for file in package.launch_files if not file.startswith("test/")):
        is_part = package.path(launch) in included
        for fact in _launch_facts(submission, package, launch, prefix):
            yield fact._replace(is_detail=fact.is_detail or is_part)
    yield from _rviz_facts(package)


def _included_launches(submission: Submission) -> set[str]:
    """Return the paths of the launch files that others of the lab certainly include.

    How a solution divides its launch files is its own matter.
    """
    packages = [*submission.lab_packages.values()]
    included: set[str] = set()
    for package in packages:
        for path in package.launch_files:
            included.update(passed.path for passed in package.launch(path).passed if passed.when)
    paths = set()
    for package in packages:
        for target, path in package.installed.items():
            if target in included:
                paths.add(package.path(path))
    return paths


def measure_facts(solution: Solution) -> Iterator[Fact]:
    """Yield the parameters of nodes that are measures of the robot.

    A measure is a radius in the robot, or a distance between two links.
    """
    links = [link.name for link in solution.robot.robot.links]
    for node, name, value in _given(solution.submission):
        words = {*name.split("_")}
        alike = sorted(
            links,
            key=lambda link_name: (
                not _WHEEL.search(link_name),
                -len(words & {*link_name.split("_")}),
            ),
        )
        sizes = _sizes_meant(name, alike)
        if sizes is None or not isinstance(value, float):
            continue
        measure, candidates = sizes
        fits = (
            candidate
            for candidate in candidates
            if _is_measured(solution.robot, measure, candidate, value)
        )
        if (fitting := next(fits, None)) is not None:
            of = enumerated([repr(link) for link in fitting])
            fact = _parameter_fact(node, name, measure=measure, links=[*fitting])
            known = [f"{link} {check}" for link in fitting for check in _MEASURING]
            same = CarriedFact(
                (*known, _MOTION), "parameter_is", {"node": node, "parameter": name, "value": value}
            )
            title = f"the parameter {name} of {node} is the {measure} of {of} in the robot"
            yield fact._replace(title=title, carried=(*fact.carried, same))


def naming_facts(solution: Solution) -> Iterator[Fact]:
    """Yield the parameters of nodes that name joints or links of the robot.

    A node without the parameter passes, as a node may have another name, or a default.
    """
    package = solution.submission.package
    main = package.name if package is not None else ""
    names = _names_in_rubric(solution)
    for node, name, value in _given(solution.submission):
        items = value if isinstance(value, list) else [value]
        is_naming = _NAMING.search(name.rpartition(".")[2]) is not None
        if not items or not is_naming:
            continue
        if not all(isinstance(word, str) and word in names for word in items):
            continue
        meant = [names[word] for word in items]
        asked = {"has": meant} if isinstance(value, list) else {"value": meant[0]}
        shown = enumerated([repr(word) for word in items], _MAX_IN_TITLE)
        fact = _parameter_fact(node, name, **asked, where_given=True)
        elsewhere = CarriedFact(_OF_NAMING, "package_found", {"name": main})
        title = f"the parameter {name} of {node} names {shown}"
        yield fact._replace(title=title, carried=(elsewhere,))


def _names_in_rubric(solution: Solution) -> dict[str, str]:
    """Return what a rubric writes for the name of each link and joint of the robot."""
    robot = solution.robot.robot
    links = {link.name for link in robot.links}
    names = {name: name for name in links}
    for joint in robot.joints:
        is_by_link = are_joints_free(solution) and joint.name not in links
        names.setdefault(joint.name, f"{JOINT_OF}{joint.child}" if is_by_link else joint.name)
    return names


def value_facts(submission: Submission) -> Iterator[Fact]:
    """Yield the values of parameters that nodes get, as files and launch files write them.

    A node without a parameter passes if its default is the same value.
    """
    for node, name, value in _given(submission):
        texts = [
            text
            for text in (value if isinstance(value, list) else [value])
            if isinstance(text, str)
        ]
        if isinstance(value, Unknown) or any(
            PREFIX in text or is_of_one_machine(text) or len(text) > _MAX_TEXT for text in texts
        ):
            continue
        title = f"the parameter {name} of {node} is {toml_literal(value)}"
        fact = _parameter_fact(node, name, value=value)._replace(about=node, title=title)
        default = submission.default_value(node, name)
        if default is not None and repr(default.value) == repr(value):
            fact = fact._replace(arguments={**fact.arguments, "or_default": True})
        yield fact


def _given(submission: Submission) -> Iterator[tuple[str, str, Any]]:
    """Yield the values of the parameters that nodes get.

    Each comes after the name of the node and its own.
    """
    for node, given in submission.workspace.parameters.owners.items():
        for name, parameter in {
            name: parameter for one in given for name, parameter in one.values.items()
        }.items():
            yield node, name, parameter.value


def _parameter_fact(node: str, name: str, **arguments: Any) -> Fact:
    """Return a fact about a parameter.

    It costs nothing if a mistake of names keeps the parameter from the node.
    """
    where_given = {"node": node, "parameter": name, **arguments, "where_given": True}
    carried = (CarriedFact(_OF_PARAMETERS, "parameter_is", where_given),)
    fact = _package_fact("parameter_is", f"{node} {name}", node=node, parameter=name, **arguments)
    return fact._replace(about=_THE_NAMES, carried=carried)


def _sizes_meant(name: str, links: Sequence[str]) -> tuple[str, Iterable[tuple[str, ...]]] | None:
    """Return what a parameter measures by its name, and of which links it may be.

    None for any other parameter.
    """
    if "radius" in name:
        return "radius", ((link,) for link in links)
    if _DISTANCE.search(name):
        return ("distance", combinations(links, 2))
    return None


def _is_measured(robot: Configuration, measure: str, links: tuple[str, ...], value: float) -> bool:
    """Return whether a value is a measure of links."""
    try:
        measured_length = measures(robot, [*links]).get(measure)
        return measured_length is not None and abs(measured_length() - value) <= _EXACT
    except (MissingElement, NotDecided):
        return False


def name_facts(submission: Submission) -> Facts:
    """Yield that the names of each family that the packages use agree, or what is odd in them."""
    if submission.package is None:
        return
    agreement = read_agreement(submission.workspace)
    unbuilt = CarriedFact(_builds(submission), "package_found", {"name": submission.package.name})
    for family in (known_family for known_family in FAMILIES if known_family in agreement.families):
        fact = _package_fact("names_agree", family, of=family)
        carried: tuple[CarriedFact, ...] = (unbuilt,) if family in _OF_BUILDS else ()
        if family == "values":
            carried = (unbuilt._replace(causes=_measured_words(submission)),)
        for causes, places in _SAME_PLACE.get(family, ()):
            elsewhere = {"of": family, "not_at": [*places]}
            carried += (CarriedFact(causes, "names_agree", elsewhere),)
        fact = fact._replace(about=_THE_NAMES, title=_NAME_TITLES[family], carried=carried)
        yield _odd(submission, family, fact) or fact


def _measured_words(submission: Submission) -> tuple[str, ...]:
    """Return the words of the parameters that may be measures of the robot.

    Each of these is a fact of its own.
    """
    words = []
    for node, name, _ in _given(submission):
        if _sizes_meant(name, ()) is not None:
            words.append(f"{node} {name} parameter_is")
    return tuple(words)


def _odd(submission: Submission, family: Family, fact: Fact) -> Omission | None:
    """Return what certainly does not agree in a family, in one line; None if nothing does not.

    It has the fact that would be a criterion of the family.
    """
    mismatches = wrong_names(submission.workspace, family, submission.lab_packages.values())
    wrong = {mismatch.message: mismatch for mismatch in mismatches}
    if not wrong:
        return None
    text, noun = _ODD[family]
    shown = [f"{each.location.file_and_line}: {message}" for message, each in wrong.items()]
    faults = "; ".join(first_lines(shown, _MAX_ODD))
    more = (
        f"{text.format(counted(len(wrong), noun))}: {faults}; correct the reference and draft "
        "again, or use the criterion among the comments"
    )
    return Omission(f"{family} names_agree", more, fact)


def _package_fact(check: str, label: str = "", **arguments: Any) -> Fact:
    return Fact(_THE_PACKAGE, check, arguments, f"{label} {check}".strip(), package="")


def _installs(package: Package, urdf: str, named: Collection[str]) -> Iterator[Fact]:
    """Yield that a build installs the URDF, the RViz files, and a file of each other ending."""
    installed = []
    elsewhere = set()  # what other facts are about
    for target, path in package.installed.items():
        if not target.startswith(package.share):
            continue
        if any(f"{target}/".startswith(f"{folder}/") for folder in named):
            elsewhere.add(path)
        installed.append(path)
    rest = [path for path in installed if path not in elsewhere]
    named_files = [("urdf", urdf)] if urdf in rest else []
    named_files += [("rviz", path) for path in package.rviz_files if path not in elsewhere]
    for kind, path in named_files:
        name = posixpath.basename(path)
        yield _package_fact(
            "build_installs", name, kind=kind, name=name, despite_errors=True
        )._replace(title=f"a build installs {name}")
    yield from _install_facts(package, rest, {posixpath.splitext(file)[1] for file in elsewhere})


def _install_facts(
    package: Package, paths: Sequence[str], known: Collection[str]
) -> Iterator[Fact]:
    """Yield that a build installs a file of each ending, from whatever folder.

    Not of the `known` endings, of which others are installed anyway.
    """
    endings: dict[str, None] = {}
    for path in paths:
        ending = posixpath.splitext(path)[1]
        is_own_kind = path in package.launch_files or path.endswith(_OWN_KINDS)
        if posixpath.dirname(path) not in ("", "resource") and not is_own_kind and ending:
            endings[ending] = None
    with_named = (CarriedFact(("files names_agree",), "package_found", {"name": package.name}),)
    for ending in endings:
        if ending not in known:
            pattern = f"*{ending}"
            fact = _package_fact("installs_files", pattern, files=[pattern], despite_errors=True)
            yield fact._replace(title=f"a build installs a {ending} file", carried=with_named)


def _launch_facts(
    submission: Submission, package: Package, path: str, prefix: str
) -> Iterator[Fact]:
    """Yield what may be true of a launch file.

    It costs nothing if the file starts nothing by a mistake of others.
    """
    name, launch = posixpath.basename(path), package.launch(path)
    included = {posixpath.basename(file.path) for file in launch.passed} - {name}
    causes = (*_builds(submission), *_STOPPING, *words_of_launches(submission, included))
    installed = {"kind": "launch", "name": name, "despite_errors": True}
    there = CarriedFact(causes, "build_installs", installed)
    after = there._replace(causes=(*there.causes, f"{prefix}{name} node_runs"))
    yield _complete_fact(launch, name, _launch_text(package, name))._replace(
        carried=(after._replace(causes=(*after.causes, "parameters names_agree")),)
    )
    connections = LaunchConnections(submission, package, path)
    # Of a lab with a robot, what nodes open may have other names.
    started, are_ends_asked = _nodes_that_start(launch), not submission.path
    needed = connections.needed(launch, started, are_ends_asked=are_ends_asked)
    nodes = [node for node in needed if node not in _STATIC]
    active = _lifecycle_nodes(submission, launch)
    managers = [node for node in launch.nodes if node.executable == LIFECYCLE_MANAGER]
    managed, _ = managed_nodes(submission.workspace, managers)
    if managed <= {*active}:  # something else may activate own nodes
        programs = {node.name for node in managers}
        nodes = [node for node in nodes if node not in programs]
    if nodes:
        title = _title_of_nodes(_launch_text(package, name), nodes)
        fact = _package_fact("node_runs", name, launch=name, nodes=nodes)
        yield fact._replace(title=title, carried=(there,))
    unrun = after._replace(causes=(*after.causes, *_OF_CODE))
    if active:
        fact = _package_fact("node_runs", f"{name} active", launch=name, active=active)
        nodes_named = "the node" if len(active) == 1 else "each of the nodes"
        title = f"{nodes_named} {enumerated(active, _MAX_IN_TITLE)} becomes active"
        yield fact._replace(title=title, carried=(unrun,))
    for fact in _opened_facts(submission, launch, name):
        [compared] = fact.carried  # the names that pay for a mistake in them
        yield fact._replace(carried=(unrun._replace(causes=(*unrun.causes, *compared.causes)),))
    misnamed = unrun._replace(causes=(*unrun.causes, *_OF_CONNECTIONS))
    for fact in connections.facts():
        yield fact._replace(about=_THE_PACKAGE, carried=(misnamed,))
    for fact in _turned_facts(package, path):
        yield fact._replace(carried=(after,))


def _lifecycle_nodes(submission: Submission, launch: Launch) -> list[str]:
    """Return the names of the own nodes with a lifecycle that a launch file starts."""
    code, names = submission.workspace.code, []
    for node in launch.nodes:
        facts = code.own_node(node) if node.when else None
        data = content(submission, facts.location.path) if facts is not None else None
        name = code.find_name(node)
        if data is not None and name and b"LifecycleNode" in data:
            names.append(name)
    return names


def _complete_fact(launch: Launch, name: str, shown: str) -> Fact:
    """Return that a launch file is there, installed, and finds the files that it names.

    Of one of which not all files are known, that none is in a wrong place.
    """
    fact = _package_fact("launch_complete", name, name=name)
    title = f"a build installs {shown}"
    if launch.named("urdf", "rviz", "include", "read"):
        title += ", which finds the files that it names"
    as_known = _package_fact("launch_complete", name, name=name, started=False)
    return fact._replace(title=title, otherwise=(as_known._replace(title=title),))


def _title_of_nodes(shown: str, nodes: Sequence[str]) -> str:
    """Return which nodes a launch file starts, as many as a title has room for."""
    names = []
    for node in nodes:
        names.append(node.partition(" or ")[0].rpartition("/")[2])
    for most in range(len(names), 0, -1):
        title = f"{shown} starts {enumerated(names, most)}"
        if len(title) <= _MAX_TITLE:
            return title
    return f"{shown} starts its {counted(len(nodes), 'node')}"


def _launch_text(package: Package, name: str) -> str:
    """Return what a title calls a launch file: by its name, if there are several."""
    launches = [file for file in package.launch_files if not file.startswith("test/")]
    return "the launch file" if len(launches) == 1 else f"the launch file {name}"


def _opened_facts(submission: Submission, launch: Launch, name: str) -> Iterator[Fact]:
    """Yield what nodes and bridges publish, serve and call, and which controllers are spawned.

    What own nodes subscribe to is asked if none of them publishes it: then others do. Of a lab with
    a robot, what nodes open may have other names: only bridges are asked.
    """
    asked: dict[str, dict[str, str]] = {verb: {} for verb in _DONE}
    workspace = submission.workspace
    for node in launch.nodes:
        bridged = opened_by_bridge(workspace, node)
        ends = [*bridged[0]] if bridged is not None else []
        if bridged is None and not submission.path:
            ends += opened_by(workspace, node)
        for end in ends if node.when else ():
            verb, kind = _OPENING.get(end.kind), end.type
            if bridged is None and end.kind == "subscription":
                verb = "subscribes"
            is_named = bool(end.name) and end.is_known and not end.endpoint.is_unused
            if verb is not None and kind is not None and is_named:
                asked[verb][end.name] = kind.replace(".", "/")
    for topic in asked["publishes"]:
        asked["subscribes"].pop(topic, None)
    for verb, names in asked.items():
        if names:
            fact = _package_fact("node_runs", f"{name} {verb}", launch=name, **{verb: names})
            title = f"the nodes {_DONE[verb]} {enumerated([*names], _MAX_IN_TITLE)}"
            yield fact._replace(title=title, carried=(CarriedFact(_COMPARED[verb], ""),))
    controllers = [*spawned_by(launch).names]
    if controllers:
        fact = _package_fact("node_runs", f"{name} spawns", launch=name, spawns=controllers)
        title = f"spawners start {enumerated(controllers, _MAX_IN_TITLE)}"
        yield fact._replace(title=title, carried=(CarriedFact(("controllers names_agree",), ""),))


def _turned_facts(package: Package, path: str) -> Iterator[Fact]:
    """Yield what a launch file starts if one of its boolean arguments is turned round.

    This is what it starts in addition, and no more.
    """
    launch, name = package.launch(path), posixpath.basename(path)
    before = _started(launch)
    for argument, value in dict(launch.values).items():
        turned = _TURNED.get(value)
        if turned is None:
            continue
        text = str(turned).lower() if isinstance(turned, bool) else turned
        after = _started(package.under({argument: text}).launch(path))
        nodes = [node for node in after if node not in before]
        absent = [node for node in before if node not in after]
        given = {}
        starts = ""
        if absent:
            given["not"] = absent
            starts = f"does not start {enumerated(absent, _MAX_IN_TITLE)}"
        if nodes:
            given = {"nodes": nodes, **given}
            starts = f"starts {enumerated(nodes, _MAX_IN_TITLE)}"
        if given:
            fact = _package_fact("node_runs", f"{name} {argument}", launch=name, **given)
            title = f"with {argument}:={text}, {_launch_text(package, name)} {starts}"
            yield fact._replace(args={argument: turned}, title=title)


def _started(launch: Launch) -> list[str]:
    return list(dict.fromkeys(node.name for node in launch.nodes if node.when))


def _nodes_that_start(launch: Launch) -> list[str]:
    """Return the nodes that start, with what a condition replaces.

    An example is joint_state_publisher, which is replaced by its GUI.
    """
    starting = _started(launch)
    replaced = dict.fromkeys(node.name for node in launch.nodes if node.when is False)
    names = []
    for name in starting:
        alike = [other for other in replaced if name.startswith(other) or other.startswith(name)]
        names.append(" or ".join(dict.fromkeys((name, *alike))))
    return names


def _rviz_facts(package: Package) -> Iterator[Fact]:
    """Yield what may be true of each RViz file.

    It is also found by the first launch file that opens it.
    """
    opened: dict[str, str] = {}
    for path in package.launch_files:
        opened.setdefault(package.rviz_opened(package.launch(path)) or "", posixpath.basename(path))
    for path in package.rviz_files:
        rviz, name = package.rviz(path), posixpath.basename(path)
        of = {"name": name}
        if path in opened:
            of["launch"] = opened[path]
        fact = _package_fact("rviz_found", name, **of)
        is_opened = "launch" in of
        shown = (
            "the launch file opens an RViz file" if is_opened else f"there is an RViz file {name}"
        )
        yield fact._replace(title=shown)
        if rviz.fixed_frame:
            fixed = _package_fact("rviz_fixed_frame", name, **of, frame=rviz.fixed_frame)
            yield fixed._replace(title=f"the Fixed Frame of RViz is {rviz.fixed_frame!r}")
        displays = dict.fromkeys(
            (display.package, display.kind) for display in rviz.displays if display.enabled
        )
        yield from _display_facts(displays, of)


def _display_facts(displays: Iterable[tuple[str, str]], of: Mapping[str, str]) -> Iterator[Fact]:
    """Yield that displays, by package and kind, are on; `of` says in which RViz file."""
    for owner, kind in displays:
        if kind == "RobotModel":
            robot_shown = _package_fact("rviz_shows_robot", of["name"], **of)
            yield robot_shown._replace(title="a RobotModel display shows the robot")
        else:
            on = _package_fact(
                "rviz_display_on", f"{of['name']} {kind}", **of, kind=f"{owner}/{kind}"
            )
            yield on._replace(title=f"RViz shows a {kind} display")
