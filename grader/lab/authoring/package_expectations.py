"""The expectations of the packages of a reference.

They are about files, builds, launch and RViz files, names and parameters.
"""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from functools import partial
from itertools import combinations
from posixpath import basename, dirname, splitext
from typing import Any

from grader.base.errors import MissingElement, NotDecided
from grader.base.grouping import Strings, as_list
from grader.base.names import last_part
from grader.base.patterns import on_use
from grader.base.text import counted, enumerated, first_lines
from grader.base.toml_file import toml_literal
from grader.lab.authoring.expectations import (
    CarriedExpectation,
    Expectation,
    Expectations,
    Omission,
    Solution,
    are_joints_free,
    longest_title,
)
from grader.lab.authoring.graph_expectations import LaunchConnections
from grader.lab.checks.parameters import measures
from grader.lab.submission.submission import Submission
from grader.ros.installation.places import PREFIX, is_of_one_machine
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.package.package import Package
from grader.ros.python.values import Unknown
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.link_tree import JOINT_OF
from grader.workspace.api import (
    LIFECYCLE_MANAGERS,
    End,
    find_parameter_use,
    frames_published,
    has_lifecycle,
    lack_of_goals,
    launch_files,
    launch_graph,
    looked_up_transforms,
    managed_nodes,
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
# Where one mistake is of two families, by the words of the expectations that pay for it.
_SAME_PLACE: Mapping[Family, Sequence[tuple[Strings, Strings]]] = {
    "files": [(("urdf_loads",), ("robot",))],
    "dependencies": [
        (("files names_agree", "programs names_agree"), ("files", "programs")),
    ],
}
_WHEEL = on_use("wheel|axle|tire|tyre")
_DISTANCE = on_use("separation|wheel_?base|wheel_?track|track_?width")
_FRAME = on_use(r"(^|[._])frame(_id)?$")
_NAMING = on_use("joint|link|frame|wheel")
_EXACT = 1e-6
# What keeps launch files from starting, and nodes from their parameters.
_STOPPING = ("files names_agree", "arguments names_agree", "programs names_agree")
_OF_PARAMETERS = (*_STOPPING, "controllers names_agree", "parameters names_agree")
_OF_NAMING = (
    *_OF_PARAMETERS,
    "frames names_agree",
    "values names_agree",
    "transforms names_agree",
)
_OF_CODE = ("code names_agree", "interfaces names_agree")
_OF_CONNECTIONS = (*_OF_NAMING, "topics names_agree", "services names_agree")
_OF_WAYS = (*_OF_PARAMETERS, "topics names_agree")  # of messages, unless the robot opens ends
# What of the nodes of a lab is seen from outside, by what they open.
_OPENING = {
    "publisher": "publishes",
    "service": "serves",
    "action server": "serves",
    "client": "calls",
    "action client": "calls",
}
_COMPARED = {
    "publishes": "topics names_agree",
    "subscribes": "topics names_agree",
    "serves": "services names_agree",
    "calls": "services names_agree",
}
_DONE = {
    "publishes": "publish",
    "subscribes": "subscribe to",
    "serves": "serve",
    "calls": "call",
}
# What the server of an action does with goals, by the argument of serves_action.
_HANDLED = {
    "feedback": "publishes feedback",
    "cancel": "cancels goals",
    "rejects": "rejects some goals",
}
# What nodes that are not submitted have at the other end of such a topic.
_QUALITIES: Mapping[tuple[str, str | None, str | None], str] = {
    ("subscription", "best_effort", "volatile"): "sensor_data",
    ("publisher", "reliable", "transient_local"): "transient_local",
}
# Warnings of `grader inspect` that mean that something does not work: of builds of C++, and of the
# code of nodes.
_CPP = (".cpp", ".cc", ".cxx")
_OF_WARNINGS = ("goals without_problems", "markers without_problems")
# The programs that publish a transform, in place of which any other node may.
_STATIC = ("tf2_ros/static_transform_publisher",)
_TURNED: Mapping[str, str | bool] = {"true": False, "false": True, "True": "False", "False": "True"}
_OWN_KINDS = (".urdf", ".xacro", ".rviz", ".py", ".xml", ".msg", ".srv", ".action")
_MAX_TEXT = 80  # characters of a value
_MAX_TITLE, _MAX_IN_TITLE = 95, 3  # characters; names
_MAX_ODD = 10  # mistakes of one family
_Expected = Iterator[Expectation]
_Arguments = dict[str, Any]  # of a check


def package_expectations(submission: Submission) -> Expectations:
    """Yield what may be true of the packages that are graded, first of the main one."""
    agreement = read_agreement(submission.workspace) if submission.lab_packages else None
    named = agreement.files if agreement and agreement.holds("files") else frozenset()
    for package, prefix in _packages(submission):
        expectations = _list_package_expectations(submission, package, named, prefix)
        about = f"{_THE_PACKAGE} {package.name}" if prefix else _THE_PACKAGE
        of = package.name if prefix else ""
        for expectation in expectations:
            yield expectation._replace(
                about=about, package=of, words=f"{prefix}{expectation.words}"
            )
    yield from _warning_expectations(submission)
    yield from _simulation_expectations(submission)
    yield from _lookup_expectations(submission)
    yield from _callback_expectations(submission)
    yield from _interface_expectations(submission)
    if not submission.path:
        yield from _code_expectations(submission)
    yield from _passed_expectations(submission)


def _warning_expectations(submission: Submission) -> _Expected:
    """Yield that there are no warnings of what certainly does not work."""
    ends = [end for node in submission.workspace.code.nodes for end in node.endpoints]
    kinds = {end.kind for end in ends}
    types = {end.type for end in ends}
    packages = submission.lab_packages.values()
    if any(map(_has_cpp, packages)):
        yield _package_expectation(
            "without_problems",
            "targets",
            title="the targets of builds find their headers and libraries, and these are installed",
            carried=_after(submission, *_builds(submission)),
            problems=["PKG020", "PKG021", "own-header", "header-installed"],
        )
    if "action server" in kinds:
        yield _name_expectation(
            "without_problems",
            "goals",
            title="each goal of an action ends, and gets a state",
            carried=_after(submission, *_OF_CODE),
            problems=["goal-state", "callback-wait"],
        )
    if not types.isdisjoint(
        ("visualization_msgs.msg.Marker", "visualization_msgs.msg.MarkerArray")
    ):
        yield _name_expectation(
            "without_problems",
            "markers",
            title="the markers that are published have a frame",
            carried=_after(submission, *_OF_CODE),
            problems=["message-frame"],
        )


def _has_cpp(package: Package) -> bool:
    """Return whether a package has sources in C++."""
    return any(path.endswith(_CPP) for path in package.tree.files)


def _after(submission: Submission, *causes: str) -> list[CarriedExpectation]:
    """Return what counts instead of an expectation if others fail: that there is a package."""
    if not submission.package:
        return []
    return [CarriedExpectation(causes, "package_found", {"name": submission.package.name})]


def _simulation_expectations(submission: Submission) -> _Expected:
    """Yield which systems the world has that is launched."""
    worlds = started_worlds(submission.workspace)
    systems = sorted(worlds.systems) if worlds.files else []
    if systems:
        title = f"the world has {enumerated(systems, _MAX_IN_TITLE)}"
        yield _name_expectation("world_has", title=title, systems=systems)


def _lookup_expectations(submission: Submission) -> _Expected:
    """Yield the transforms that nodes look up, where both frames are known."""
    seen = set()
    lookups, _ = looked_up_transforms(submission.workspace)
    for lookup in lookups:
        frames = lookup.target, lookup.source
        if None not in frames and frames not in seen:
            seen.add(frames)
            target, source = frames
            arguments: _Arguments = {"target": target, "source": source}
            title = f"a node looks up the pose of {source} in {target}"
            if lookup.inverts != "no":
                arguments["either_way"] = True
                title += ", or its inverse"
            label = f"{target} {source}"
            carried = _after_names(submission)
            yield _name_expectation("looks_up", label, title=title, carried=carried, **arguments)


def _interface_expectations(submission: Submission) -> _Expected:
    """Yield the fields of the messages, services and actions that the packages define."""
    for package, interfaces in submission.workspace.code.interfaces.items():
        for name, defined in interfaces.types.items():
            fields = {key: field.type.written for key, field in defined.interface.fields.items()}
            if fields:
                full = f"{package}/{name.replace('.', '/')}"
                yield _name_expectation(
                    "interface_has",
                    full,
                    title=f"{full} has {enumerated(fields, _MAX_IN_TITLE)}",
                    carried=_after_names(submission),
                    interface=full,
                    fields=fields,
                )


def _code_expectations(submission: Submission) -> _Expected:
    """Yield the frames of messages, what is done with goals, and the parameters that count."""
    workspace = submission.workspace
    causes = (*_builds(submission), *_OF_CODE, *_OF_CONNECTIONS, *_OF_WARNINGS)
    carried = _after(submission, *causes)
    expectations = {}
    for node in workspace.launches.nodes:
        is_own = node.when and workspace.find_package(node) is not None
        for end in opened_by(workspace, node) if is_own else ():
            for expectation in _end_expectations(submission, node, end) if end.is_known else ():
                expectations[end.name] = expectation._replace(carried=carried)
    names = {facts.name for facts in workspace.code.nodes}  # those of launch files are free
    for owner, name, _ in _given(submission):
        if owner in names and find_parameter_use(workspace, owner, name).is_used:
            label = f"{owner} {name}"
            title = f"the code of {owner} uses the parameter {name}"
            expectations[label] = _name_expectation(
                "uses_parameter", label, title=title, carried=carried, node=owner, parameter=name
            )
    yield from expectations.values()


def _end_expectations(submission: Submission, node: StartedNode, end: End) -> _Expected:
    """Yield the frame of the data of a sensor, and what the server of an action does with goals."""
    is_of_sensor = end.kind == "publisher" and (end.type or "").startswith("sensor_msgs.")
    frames = dict(frames_published(submission.workspace, node, end.name)) if is_of_sensor else {}
    if len(frames) == 1 and "" not in frames:
        [frame] = frames
        title = f"the messages of {end.name} have the frame {frame}"
        yield _name_expectation("publishes", end.name, title=title, topic=end.name, frame_id=frame)
    elif end.kind == "action server":
        handled: _Arguments = {}
        for argument in _HANDLED:
            with suppress(NotDecided):
                if not lack_of_goals(submission.workspace, end.location, argument):
                    handled[argument] = True
        does = enumerated([_HANDLED[argument] for argument in handled])
        title = f"the server of {end.name} {does}" if handled else ""
        yield _name_expectation("serves_action", end.name, title=title, action=end.name, **handled)


def _callback_expectations(submission: Submission) -> _Expected:
    """Yield that a node is told of its parameters, or refuses values of them."""
    callbacks = parameter_callbacks(submission.workspace)
    carried = _after(submission, *_builds(submission), *_OF_CODE)
    if callbacks.refuses:
        title = "a node refuses values of its parameters"
        yield _name_expectation(
            "takes_parameters", "refused", title=title, carried=carried, refuses=True
        )
    elif callbacks.told:
        title = "a node is told when its parameters are set"
        yield _name_expectation("takes_parameters", "set", title=title, carried=carried)


def _passed_expectations(submission: Submission) -> _Expected:
    """Yield the parameters that nodes get by arguments that launch files pass to others.

    What an argument does is asked, and not its name: a submission may divide its launch files in
    other ways. Of a lab without a robot, parameters that name a frame are asked, too.
    """
    frames = set() if submission.path else set(_list_frames(submission))
    passed: list[tuple[str, Any]] = []
    for package in submission.lab_packages.values():
        for path in package.launch_files:
            passed += _changed_by_passing(submission, package.launch(path))
    for expectation in value_expectations(submission):
        name = expectation.arguments["parameter"]
        value = expectation.arguments["value"]
        is_frame = _FRAME.search(name) is not None and value in frames
        if (name, value) in passed or is_frame:
            arguments = {**expectation.arguments, "where_given": True}
            arguments.pop("or_default", None)
            yield expectation._replace(about=_THE_NAMES, arguments=arguments)


def _list_frames(submission: Submission) -> Iterator[str]:
    """Yield the frames between which the launch files certainly publish transforms."""
    for path in launch_files(submission.workspace):
        for transform in launch_graph(submission.workspace, path).transforms:
            if transform.is_certain:
                yield from (transform.parent, transform.child)


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


def _list_parameters(node: StartedNode) -> _Arguments:
    """Return the values that a launch file itself gives the parameters of a node."""
    values = {}
    for given in node.parameters or ():
        for name, parameter in given.values.items():
            values[name] = parameter.value
    return values


def _after_names(submission: Submission) -> list[CarriedExpectation]:
    """Return what counts instead of what nodes do, if they do not run or get no parameters."""
    causes = (*_builds(submission), *_OF_PARAMETERS, *_OF_CODE, *words_of_launches(submission))
    return _after(submission, *causes)


def _packages(submission: Submission) -> Iterator[tuple[Package, str]]:
    """Yield the packages, the main one first.

    Each comes with what the words of its expectations begin with.
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
        for name in map(basename, package.launch_files):
            if wanted is None or name in wanted:
                for check in ("node_runs", "launch_complete"):
                    yield f"{prefix}{name} {check}"


def _builds(submission: Submission) -> Sequence[str]:
    """Return the words of the builds of the packages."""
    return [f"{prefix}setup_imports" for _, prefix in _packages(submission)]


def _list_package_expectations(
    submission: Submission, package: Package, named: Collection[str], prefix: str
) -> _Expected:
    """Yield what may be true of a package.

    That the files are installed which are `named` somewhere is an expectation about names.
    """
    path = submission.path or ""
    yield _package_expectation("package_found", name=package.name)
    if package.manifest:
        title = "the build type in package.xml is that of the package's files"
        yield _package_expectation("package_type", title=title)
    yield _package_expectation("setup_imports", title="`colcon build` of the package succeeds")
    yield from _installs(
        package, path.removeprefix(package.path("")) if package.holds(path) else "", named
    )
    included = _included_launches(submission)
    for launch in (file for file in package.launch_files if not file.startswith("test/")):
        is_part = package.path(launch) in included
        for expectation in _launch_expectations(submission, package, launch, prefix):
            yield expectation._replace(is_detail=expectation.is_detail or is_part)
    yield from _rviz_expectations(package)


def _included_launches(submission: Submission) -> set[str]:
    """Return the paths of the launch files that others of the lab certainly include.

    How a solution divides its launch files is its own matter.
    """
    packages = list(submission.lab_packages.values())
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


def measure_expectations(solution: Solution) -> _Expected:
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
            of = enumerated(map(repr, fitting))
            expectation = _parameter_expectation(node, name, measure=measure, links=list(fitting))
            known = [
                f"{link} {check}"
                for link in fitting
                for check in ("shows_cylinder", "shows_sphere", "frame_at")
            ]
            same = CarriedExpectation(
                (*known, "kinematics_match_reference"),
                "parameter_is",
                {"node": node, "parameter": name, "value": value},
            )
            title = f"the parameter {name} of {node} is the {measure} of {of} in the robot"
            yield expectation._replace(title=title, carried=[*expectation.carried, same])


def naming_expectations(solution: Solution) -> _Expected:
    """Yield the parameters of nodes that name joints or links of the robot.

    A node without the parameter passes, as a node may have another name, or a default.
    """
    package = solution.submission.package
    main = package.name if package else ""
    names = _names_in_rubric(solution)
    for node, name, value in _given(solution.submission):
        items = as_list(value)
        is_naming = _NAMING.search(name.rpartition(".")[2]) is not None
        if not items or not is_naming:
            continue
        if not all(isinstance(word, str) and word in names for word in items):
            continue
        meant = [names[word] for word in items]
        asked = {"has": meant} if isinstance(value, list) else {"value": meant[0]}
        shown = enumerated(map(repr, items), _MAX_IN_TITLE)
        yield _name_expectation(
            "parameter_is",
            f"{node} {name}",
            title=f"the parameter {name} of {node} names {shown}",
            carried=[CarriedExpectation(_OF_NAMING, "package_found", {"name": main})],
            node=node,
            parameter=name,
            **asked,
            where_given=True,
        )


def _names_in_rubric(solution: Solution) -> dict[str, str]:
    """Return what a rubric writes for the name of each link and joint of the robot."""
    robot = solution.robot.robot
    links = {link.name for link in robot.links}
    names = {name: name for name in links}
    for joint in robot.joints:
        is_by_link = are_joints_free(solution) and joint.name not in links
        names.setdefault(joint.name, f"{JOINT_OF}{joint.child}" if is_by_link else joint.name)
    return names


def value_expectations(submission: Submission) -> _Expected:
    """Yield the values of parameters that nodes get, as files and launch files write them.

    A node without a parameter passes if its default is the same value.
    """
    for node, name, value in _given(submission):
        texts = [text for text in as_list(value) if isinstance(text, str)]
        if isinstance(value, Unknown) or any(
            PREFIX in text or is_of_one_machine(text) or len(text) > _MAX_TEXT for text in texts
        ):
            continue
        title = f"the parameter {name} of {node} is {toml_literal(value)}"
        expectation = _parameter_expectation(node, name, value=value)
        default = submission.default_value(node, name)
        if default and repr(default.value) == repr(value):
            expectation = expectation.with_arguments(or_default=True)
        yield expectation._replace(about=node, title=title)


def _given(submission: Submission) -> Iterator[tuple[str, str, Any]]:
    """Yield the values of the parameters that nodes get.

    Each comes after the name of the node and its own.
    """
    for node, given in submission.workspace.parameters.owners.items():
        for name, parameter in {
            name: parameter for one in given for name, parameter in one.values.items()
        }.items():
            yield node, name, parameter.value


def _parameter_expectation(node: str, name: str, **arguments: Any) -> Expectation:
    """Return an expectation about a parameter.

    It costs nothing if a mistake of names keeps the parameter from the node.
    """
    asked = {"node": node, "parameter": name, **arguments}
    carried = [CarriedExpectation(_OF_PARAMETERS, "parameter_is", {**asked, "where_given": True})]
    return _name_expectation("parameter_is", f"{node} {name}", carried=carried, **asked)


def _sizes_meant(name: str, links: Sequence[str]) -> tuple[str, Iterable[Strings]] | None:
    """Return what a parameter measures by its name, and of which links it may be.

    It is None for any other parameter.
    """
    if "radius" in name:
        return "radius", ((link,) for link in links)
    if _DISTANCE.search(name):
        return ("distance", combinations(links, 2))
    return None


def _is_measured(robot: Configuration, measure: str, links: Sequence[str], value: float) -> bool:
    """Return whether a value is a measure of links."""
    try:
        measured_length = measures(robot, list(links)).get(measure)
        return measured_length is not None and abs(measured_length() - value) <= _EXACT
    except (MissingElement, NotDecided):
        return False


def name_expectations(submission: Submission) -> Expectations:
    """Yield that the names of each family that the packages use agree, or what is odd in them."""
    if not submission.package:
        return
    agreement = read_agreement(submission.workspace)
    unbuilt = CarriedExpectation(
        _builds(submission), "package_found", {"name": submission.package.name}
    )
    for family in FAMILIES:
        if family not in agreement.families:
            continue
        carried = [unbuilt] if family in ("files", "programs") else []
        if family == "values":
            carried = [unbuilt._replace(causes=_measured_words(submission))]
        for causes, places in _SAME_PLACE.get(family, ()):
            elsewhere = {"of": family, "not_at": list(places)}
            carried.append(CarriedExpectation(causes, "names_agree", elsewhere))
        title = _NAME_TITLES[family]
        expectation = _name_expectation(
            "names_agree", family, title=title, carried=carried, of=family
        )
        yield _odd(submission, family, expectation) or expectation


def _measured_words(submission: Submission) -> Sequence[str]:
    """Return the words of the parameters that may be measures of the robot.

    Each of these is an expectation of its own.
    """
    words = []
    for node, name, _ in _given(submission):
        if _sizes_meant(name, ()) is not None:
            words.append(f"{node} {name} parameter_is")
    return words


def _odd(submission: Submission, family: Family, expectation: Expectation) -> Omission | None:
    """Return what certainly does not agree in a family, in one line; None if nothing does not.

    It has the expectation that would be a criterion of the family.
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
    return Omission(f"{family} names_agree", more, expectation)


def _package_expectation(
    check: str,
    label: str = "",
    *,
    about: str = _THE_PACKAGE,
    title: str = "",
    carried: Sequence[CarriedExpectation] = (),
    **arguments: Any,
) -> Expectation:
    words = f"{label} {check}".strip()
    return Expectation(about, check, arguments, words, "", carried, title=title)


_name_expectation = partial(_package_expectation, about=_THE_NAMES)


def _installs(package: Package, urdf: str, named: Collection[str]) -> _Expected:
    """Yield that a build installs the URDF, the RViz files, and a file of each other ending."""
    installed = []
    elsewhere = set()  # what other expectations are about
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
        name = basename(path)
        yield _package_expectation(
            "build_installs",
            name,
            title=f"a build installs {name}",
            kind=kind,
            name=name,
            despite_errors=True,
        )
    yield from _install_expectations(package, rest, {splitext(file)[1] for file in elsewhere})


def _install_expectations(
    package: Package, paths: Sequence[str], known: Collection[str]
) -> _Expected:
    """Yield that a build installs a file of each ending, from whatever folder.

    The `known` endings, of which others are installed anyway, are not among these.
    """
    endings: dict[str, None] = {}
    for path in paths:
        ending = splitext(path)[1]
        is_own_kind = path in package.launch_files or path.endswith(_OWN_KINDS)
        if dirname(path) not in ("", "resource") and not is_own_kind and ending:
            endings[ending] = None
    with_named = CarriedExpectation(("files names_agree",), "package_found", {"name": package.name})
    for ending in endings:
        if ending not in known:
            pattern = f"*{ending}"
            yield _package_expectation(
                "installs_files",
                pattern,
                title=f"a build installs a {ending} file",
                carried=[with_named],
                files=[pattern],
                despite_errors=True,
            )


def _launch_expectations(
    submission: Submission, package: Package, path: str, prefix: str
) -> _Expected:
    """Yield what may be true of a launch file.

    It costs nothing if the file starts nothing by a mistake of others.
    """
    name = basename(path)
    launch = package.launch(path).with_components()
    included = {basename(file.path) for file in launch.passed} - {name}
    causes = (*_builds(submission), *_STOPPING, *words_of_launches(submission, included))
    installed = {"kind": "launch", "name": name, "despite_errors": True}
    there = CarriedExpectation(causes, "build_installs", installed)
    after = there.after(f"{prefix}{name} node_runs")
    shown = _launch_text(package, name)
    without_parameters = after.after("parameters names_agree")
    yield _complete_expectation(launch, name, shown)._replace(carried=[without_parameters])
    connections = LaunchConnections(submission, package, path)
    # Of a lab with a robot, what nodes open may have other names.
    started = _nodes_that_start(launch)
    are_ends_asked = not submission.path
    needed = connections.needed(launch, started, are_ends_asked=are_ends_asked)
    nodes = [node for node in needed if node not in _STATIC]
    active = _lifecycle_nodes(submission, launch)
    managers = [node for node in launch.nodes if node.executable in LIFECYCLE_MANAGERS]
    managed, _ = managed_nodes(submission.workspace, managers)
    if managed <= {*active}:  # something else may activate own nodes
        programs = {node.name for node in managers}
        nodes = [node for node in nodes if node not in programs]
    if nodes:
        title = _title_of_nodes(shown, nodes)
        yield _package_expectation(
            "node_runs", name, title=title, carried=[there], launch=name, nodes=nodes
        )
    unrun = after.after(*_OF_CODE)
    if active:
        nodes_named = "the node" if len(active) == 1 else "each of the nodes"
        title = f"{nodes_named} {enumerated(active, _MAX_IN_TITLE)} becomes active"
        words = f"{name} active"
        yield _package_expectation(
            "node_runs", words, title=title, carried=[unrun], launch=name, active=active
        )
    yield from _opened_expectations(submission, launch, name, unrun)
    misnamed = unrun.after(*_OF_CONNECTIONS)
    disconnected = misnamed if connections.has_ends_of_robot else unrun.after(*_OF_WAYS)
    for expectation in connections.expectations():
        carried = disconnected if expectation.check == "connects" else misnamed
        yield expectation._replace(about=_THE_PACKAGE, carried=[carried])
    for expectation in _turned_expectations(package, path):
        yield expectation._replace(carried=[after])
    for expectation in _recording_expectations(package, path):
        yield expectation._replace(carried=[misnamed])


def _lifecycle_nodes(submission: Submission, launch: Launch) -> list[str]:
    """Return the names of the own nodes with a lifecycle that a launch file starts."""
    workspace = submission.workspace
    names = []
    for node in launch.nodes:
        is_own = node.when and workspace.find_package(node) is not None
        name = workspace.code.find_name(node)
        if is_own and name and has_lifecycle(workspace, node):
            names.append(name)
    return names


def _complete_expectation(launch: Launch, name: str, shown: str) -> Expectation:
    """Return that a launch file is there, installed, and finds the files that it names.

    Of one of which not all files are known, return that none is in a wrong place.
    """
    title = f"a build installs {shown}"
    if launch.named("urdf", "rviz", "include", "read"):
        title += ", which finds the files that it names"
    complete = partial(_package_expectation, "launch_complete", name, title=title, name=name)
    return complete()._replace(otherwise=[complete(started=False)])


def _title_of_nodes(shown: str, nodes: Sequence[str]) -> str:
    """Return which nodes a launch file starts, as many as a title has room for."""
    names = []
    for node in nodes:
        names.append(last_part(node.partition(" or ")[0]))
    otherwise = f"{shown} starts its {counted(len(nodes), 'node')}"
    return longest_title(f"{shown} starts", names, _MAX_TITLE, otherwise)


def _launch_text(package: Package, name: str) -> str:
    """Return what a title calls a launch file: by its name, if there are several."""
    launches = [file for file in package.launch_files if not file.startswith("test/")]
    return "the launch file" if len(launches) == 1 else f"the launch file {name}"


def _opened_expectations(
    submission: Submission, launch: Launch, name: str, unrun: CarriedExpectation
) -> _Expected:
    """Yield what nodes and bridges publish, serve and call, and which controllers are spawned.

    What own nodes subscribe to is asked if none of them publishes it: then others do. Of a lab with
    a robot, what nodes open may have other names: only bridges are asked.

    `unrun` is what counts if they do not run; the names that pay for a mistake in them are added.
    """
    asked = _list_opened(submission, launch)
    both = asked["publishes"].keys() & asked["subscribes"].keys()
    for topic in both:
        del asked["subscribes"][topic]
    for verb, opened in asked.items():
        given: _Arguments = {}
        for end in opened.values():
            given.setdefault(verb, {})[end.name] = (end.type or "").replace(".", "/")
            qos = end.endpoint.qos
            quality = _QUALITIES.get((end.kind, qos.reliability, qos.durability))
            if quality is not None and end.name not in both:
                given.setdefault("qos", {})[end.name] = quality
        if given:
            yield _package_expectation(
                "node_runs",
                f"{name} {verb}",
                title=f"the nodes {_DONE[verb]} {enumerated(opened, _MAX_IN_TITLE)}",
                carried=[unrun.after(_COMPARED[verb])],
                launch=name,
                **given,
            )
    controllers = list(spawned_by(launch).names)
    if controllers:
        yield _package_expectation(
            "node_runs",
            f"{name} spawns",
            title=f"spawners start {enumerated(controllers, _MAX_IN_TITLE)}",
            carried=[unrun.after("controllers names_agree")],
            launch=name,
            spawns=controllers,
        )


def _list_opened(submission: Submission, launch: Launch) -> dict[str, dict[str, End]]:
    """Return what nodes and bridges open, by what they do with it and by its name."""
    asked: dict[str, dict[str, End]] = {verb: {} for verb in _DONE}
    for node in launch.nodes:
        bridged = opened_by_bridge(submission.workspace, node)
        ends = list(bridged[0]) if bridged is not None else []
        if bridged is None and not submission.path:
            ends += opened_by(submission.workspace, node)
        for end in ends if node.when else ():
            verb = _OPENING.get(end.kind)
            if bridged is None and end.kind == "subscription":
                verb = "subscribes"
            is_named = bool(end.name) and end.is_known and not end.endpoint.is_unused
            if verb is not None and end.type is not None and is_named:
                asked[verb][end.name] = end
    return asked


def _turned_launches(package: Package, path: str) -> Iterator[tuple[str, str | bool, str, Launch]]:
    """Yield a launch file with each of its boolean arguments turned round.

    Each comes after the argument, and its other value as a rubric and as a command line write it.
    """
    for argument, value in dict(package.launch(path).values).items():
        turned = _TURNED.get(value)
        if turned is not None:
            text = str(turned).lower() if isinstance(turned, bool) else turned
            yield argument, turned, text, package.under({argument: text}).launch(path)


def _turned_expectations(package: Package, path: str) -> _Expected:
    """Yield what a launch file starts if one of its boolean arguments is turned round.

    This is what it starts in addition, and no more.
    """
    name = basename(path)
    before = _started(package.launch(path))
    for argument, turned, text, launch in _turned_launches(package, path):
        after = _started(launch)
        nodes = [node for node in after if node not in before]
        absent = [node for node in before if node not in after]
        given: _Arguments = {}
        starts = ""
        if absent:
            given["not"] = absent
            starts = f"does not start {enumerated(absent, _MAX_IN_TITLE)}"
        if nodes:
            given = {"nodes": nodes, **given}
            starts = f"starts {enumerated(nodes, _MAX_IN_TITLE)}"
        if given:
            title = f"with {argument}:={text}, {_launch_text(package, name)} {starts}"
            expectation = _package_expectation(
                "node_runs", f"{name} {argument}", title=title, launch=name, **given
            )
            yield expectation._replace(args={argument: turned})


def _recording_expectations(package: Package, path: str) -> _Expected:
    """Yield which topics a launch file records, and with which boolean argument alone it does."""
    name = basename(path)
    now = _list_recorded(package.launch(path))
    if now:
        yield _recording_expectation(package, name, now)
        return
    for argument, turned, text, launch in _turned_launches(package, path):
        then = _list_recorded(launch)
        if then:
            expectation = _recording_expectation(package, name, then)
            title = f"with {argument}:={text}, {expectation.title}"
            yield expectation._replace(args={argument: turned}, title=title)
            never = _recording_expectation(package, name, [])
            yield never._replace(title=f"without {argument}:={text}, {never.title}")


def _list_recorded(launch: Launch) -> list[str]:
    """Return the topics that a launch file certainly records."""
    commands = [command for command in launch.commands if command.when]
    return [topic for command in commands for topic in command.recorded_topics]


def _recording_expectation(package: Package, name: str, topics: Sequence[str]) -> Expectation:
    """Return that a launch file records topics; with none, that it does not record."""
    asked = {"words": list(topics)} if topics else {"absent": True}
    words = f"{name} {'records' if topics else 'records nothing'}"
    command = ["ros2", "bag", "record"]
    what = enumerated(topics, _MAX_IN_TITLE) if topics else "nothing"
    title = f"{_launch_text(package, name)} records {what}"
    return _package_expectation("starts", words, title=title, launch=name, command=command, **asked)


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


def _rviz_expectations(package: Package) -> _Expected:
    """Yield what may be true of each RViz file.

    It is also found by the first launch file that opens it.
    """
    opened: dict[str, str] = {}
    for path in package.launch_files:
        opened.setdefault(package.rviz_opened(package.launch(path)) or "", basename(path))
    for path in package.rviz_files:
        rviz = package.rviz(path)
        name = basename(path)
        of: _Arguments = {"name": name}
        title = f"there is an RViz file {name}"
        if path in opened:
            of["launch"] = opened[path]
            title = "the launch file opens an RViz file"
        yield _package_expectation("rviz_found", name, title=title, **of)
        if rviz.fixed_frame:
            title = f"the Fixed Frame of RViz is {rviz.fixed_frame!r}"
            yield _package_expectation(
                "rviz_fixed_frame", name, title=title, **of, frame=rviz.fixed_frame
            )
        displays = dict.fromkeys(
            (display.package, display.kind) for display in rviz.displays if display.enabled
        )
        yield from _display_expectations(displays, of)


def _display_expectations(displays: Iterable[tuple[str, str]], of: Mapping[str, Any]) -> _Expected:
    """Yield that displays, by package and kind, are on; `of` says in which RViz file."""
    for owner, kind in displays:
        if kind == "RobotModel":
            title = "a RobotModel display shows the robot"
            yield _package_expectation("rviz_shows_robot", of["name"], title=title, **of)
        else:
            yield _package_expectation(
                "rviz_display_on",
                f"{of['name']} {kind}",
                title=f"RViz shows a {kind} display",
                **of,
                kind=f"{owner}/{kind}",
            )
