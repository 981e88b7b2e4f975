"""Checks of a launch file: that it is there, what it starts, and whether the files that it names are where a build puts them."""

import posixpath
from typing import TYPE_CHECKING

from grader.checks.outcome import Outcome, judged_as, passed
from grader.errors import MissingElement, NotDecided
from grader.names import closest
from grader.package.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER, is_launch_named, is_of_one_machine
from grader.package.package import Package

if TYPE_CHECKING:
    from grader.package.launch.model import Launch, Reference, StartedNode

_WORDS = {"urdf": "URDF", "rviz": "RViz file", "include": "launch file", "launch": "launch file"}
_ENDINGS = {"urdf": (".urdf", ".xacro"), "rviz": (".rviz",), "include": (".py", ".xml", ".yaml", ".yml")}


def launch_found(package: Package, *, name: str) -> Outcome:
    """The package has a launch file of this name; it may be written in Python, XML or YAML."""
    path = package.launch_file(name)
    if path is None:
        raise _no_file(package, "launch")
    if is_launch_named(path, name):
        return passed(f"the launch file is {path}")
    hint = (
        ""
        if posixpath.splitext(path)[1] in (".py", ".xml", ".yaml", ".yml")
        else ", which ros2 launch cannot start without an ending such as .launch.py"
    )
    return judged_as("failed", f"there is no launch file {name!r}; the package has {path}{hint}")


def launch_starts(package: Package, *, name: str, nodes: list[str]) -> Outcome:
    """The launch file starts these nodes, with the defaults of its arguments.

    A node is named `package/executable`, or by one name if both are the same; "a or b" leaves a choice. Launch files that it
    includes count, if they are part of the submission or of urdf_launch.
    """
    launch = _launch(package, name)
    if launch.faults and not launch.nodes:
        raise _stopped(package, name, launch)
    started = {_named(node) for node in launch.nodes if node.when}
    running = sorted(started)
    perhaps = {_named(node) for node in launch.nodes if node.when is None}
    choices = [wanted.split(" or ") for wanted in nodes]
    missing = [" or ".join(choice) for choice in choices if started.isdisjoint(choice)]
    if launch.faults:
        return judged_as("failed", _faults(launch), at=launch.faults[0].location)
    open_questions = [each for each in missing if not perhaps.isdisjoint(each.split(" or "))]
    if missing and (len(open_questions) == len(missing) or launch.unknown):
        reason = f": {launch.unknown[0].message}" if launch.unknown else ""
        return Outcome("pending", f"whether {_listed(missing)} is started is told only by a run{reason}")
    if not missing:
        return Outcome("passed", f"it starts {_listed(running)}", tuple(running), tuple(nodes))
    message = f"it does not start {_listed(missing)}; it starts {_listed(running) or 'nothing'}"
    forgotten = next((node for node in launch.forgotten if _named(node) in _words(missing)), None)
    off = next((node for node in launch.nodes if node.when is False and _named(node) in _words(missing)), None)
    wanted = {each for choice in choices for each in choice} - started
    near = next(
        (node for node in launch.nodes if node.when and not wanted.isdisjoint((node.package, node.executable))), None
    )
    at = near.location if near is not None else None
    if forgotten is not None:
        message += f". The node {forgotten.executable} is made, but not part of the LaunchDescription"
        at = forgotten.location
    elif off is not None:
        message += f". A condition keeps {off.executable} from being started, unless an argument is given"
        at = off.location
    return Outcome("failed", message, tuple(running), tuple(nodes), location=at)


def launch_finds_files(package: Package, *, name: str) -> Outcome:
    """The URDF and RViz files that the launch file names are where a build of the package puts them."""
    launch = _launch(package, name)
    references = launch.named("urdf", "rviz", "include")
    verdicts = [(_verdict(package, each), each) for each in references]
    wrong = [(text, each) for (status, text), each in verdicts if status == "failed"]
    if wrong:
        message = "; ".join(dict.fromkeys(text for text, _ in wrong))
        if any(each.path is not None and is_of_one_machine(each.path) for _, each in wrong):
            message += f": get_package_share_directory({package.name!r}) tells where it is installed"
        return judged_as("failed", message, at=wrong[0][1].location)
    for (status, text), each in verdicts:
        if status == "missing":
            raise _missing(package, each, text)
    if not any(each.purpose != "include" for each in references):
        if launch.faults:
            raise _stopped(package, name, launch)
        if launch.unknown:
            return Outcome("pending", f"which files it names is told only by a run: {launch.unknown[0].message}")
        raise MissingElement("named file", "", message="the launch file names neither a URDF nor an RViz file")
    pending = [text for (status, text), _ in verdicts if status == "pending"]
    if pending:
        return Outcome("pending", f"{pending[0]}: a person has to look")
    *most, last = dict.fromkeys(text for (_, text), _ in verdicts if text)
    return passed(f"the build puts {' and '.join(filter(None, [_listed(most), last]))} where it is looked for")


def _no_file(package: Package, kind: str) -> MissingElement:
    return MissingElement(f"{_WORDS[kind]} in the package", "", message=package.missing_message(kind))


def _launch(package: Package, name: str) -> "Launch":
    path = package.launch_file(name)
    if path is None:
        raise _no_file(package, "launch")
    launch = package.launch(path)
    if launch.unread:
        raise NotDecided(launch.unread)
    if launch.syntax is not None:
        raise MissingElement("launch file", path, message=launch.syntax.message, location=launch.syntax.location)
    return launch


def _stopped(package: Package, name: str, launch: "Launch") -> MissingElement:
    """A fault for which nothing at all is known of a launch file."""
    path = package.launch_file(name) or name
    return MissingElement("launch file", path, message=_faults(launch), location=launch.faults[0].location)


def _faults(launch: "Launch") -> str:
    messages = list(dict.fromkeys(fault.message for fault in launch.faults))
    return f"{messages[0]} (and {len(messages) - 1} more)" if len(messages) > 1 else messages[0]


def _named(node: "StartedNode") -> str:
    return node.executable if node.package == node.executable else f"{node.package}/{node.executable}"


def _missing(package: Package, named: "Reference", text: str) -> MissingElement:
    """What a named file is without, under the name that the checks of the package miss it by."""
    setup = package.setup
    what = _WORDS[named.purpose]
    if setup is None or setup.fault is not None:
        return MissingElement("setup.py", package.folder, message=text, location=named.location)
    if not setup.is_called:
        return MissingElement("call of setup", package.folder, message=text, location=named.location)
    if not any(path.lower().endswith(_ENDINGS[named.purpose]) for path in package.tree.files):
        return MissingElement(f"{what} in the package", "", message=text, location=named.location)
    return MissingElement(f"installed {named.purpose}", package.folder, message=text, location=named.location)


def _verdict(package: Package, named: "Reference") -> tuple[str, str]:
    """What becomes of a file that a launch file names: passed, failed, pending or, if it is never installed, missing."""
    what = _WORDS[named.purpose]
    if named.path is None or named.reason:
        return ("failed" if named.sure else "pending", named.reason)
    path = posixpath.normpath(named.path)
    if path.startswith(f"{SHARE}/"):
        owner, _, rest = path.removeprefix(f"{SHARE}/").partition("/")
        return _below_share(package, owner, rest, named)
    if is_of_one_machine(path):
        shown = path.replace(HOME, "~")
        return "failed", f"it looks for the {what} at {shown}, which exists on one machine only"
    if path.startswith(WORKING_FOLDER) or not path.startswith("/"):
        shown = path.removeprefix(WORKING_FOLDER + "/")
        if shown.startswith("~"):
            return "failed", f"it looks for the {what} at {shown}, but nothing puts the home folder in place of ~"
        return "failed", f"it looks for the {what} at {shown}, in whatever folder ros2 launch is started from"
    if not path.startswith(PREFIX) and posixpath.basename(path) in map(posixpath.basename, package.tree.files):
        return "failed", f"it looks for the {what} at {path}: a path that begins with / forgets the folders before it"
    return "pending", f"the {what} {path.removeprefix(PREFIX)} is not part of the package"


def _is_glued(package: Package, owner: str, rest: str) -> bool:
    """Whether a path goes on right behind the package's name, as in get_package_share_directory(...) + 'my_robot.urdf'."""
    tail = posixpath.basename(rest or owner.removeprefix(package.name))
    return owner.startswith(package.name) and tail in map(posixpath.basename, package.tree.files)


def _below_share(package: Package, owner: str, rest: str, named: "Reference") -> tuple[str, str]:
    what = _WORDS[named.purpose]
    other = package.find(owner)
    if other is None and _is_glued(package, owner, rest):
        return (
            "failed",
            f"it looks for the {what} at {posixpath.join('share', owner, rest).rstrip('/')}: a slash is missing behind {package.name!r}",
        )
    if other is None:
        if closest(owner, [package.name]):
            return "failed", f"it looks in a package {owner!r}, but this one is named {package.name!r}"
        return (
            ("passed", "")
            if what == "launch file"
            else ("pending", f"the {what} is in {owner!r}, which was not handed in")
        )
    setup = other.setup
    if other.is_cmake or (setup is not None and setup.fault is not None and not setup.fault.sure):
        return "pending", f"whether a build installs the {what} is not followed"
    if setup is None or setup.fault is not None:
        return "missing", f"without a setup.py that Python can read, no {what} is installed"
    installed = setup.installed()
    target = f"share/{owner}/{rest}"
    if target in installed:
        return "passed", target
    if setup.unknown:
        return "pending", f"whether the build installs {target} cannot be told"
    name = posixpath.basename(rest)
    put = next((each for each in installed if posixpath.basename(each) == name), None)
    if put is not None:
        return "failed", f"it looks for the {what} at {target}, but the build puts it at {put}"
    if any(posixpath.basename(path) == name for path in other.tree.files):
        return "missing", f"it looks for the {what} at {target}, but the build does not install {name}"
    endings, own = _ENDINGS[named.purpose], posixpath.basename(named.location.path)
    alike = sorted({posixpath.basename(path) for path in other.tree.files if path.lower().endswith(endings)} - {own})
    message = f"it looks for the {what} at {target}, but the package has no file {name!r}"
    if not alike and named.purpose != "include":
        return "missing", message
    similar = closest(name, alike) or (alike[0] if len(alike) == 1 and named.purpose != "include" else None)
    return "failed", f"{message}; there is {similar!r}" if similar else message


def _words(choices: list[str]) -> set[str]:
    return {each for choice in choices for each in choice.split(" or ")}


def _listed(names: list[str]) -> str:
    return ", ".join(names)
