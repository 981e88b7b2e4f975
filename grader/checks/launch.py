"""Checks of a launch file: that it is there, what it starts, and whether the files that it names are where a build puts them."""

import posixpath
from typing import TYPE_CHECKING

from grader.checks.outcome import Outcome, judged_as, passed
from grader.errors import MissingElement
from grader.robot.names import closest
from grader.submission.launch.places import HOME, PREFIX, SHARE, WORKING_FOLDER
from grader.submission.package import Package, is_launch_named

if TYPE_CHECKING:
    from grader.submission.launch.model import Launch, Reference

_WORDS = {"urdf": "URDF", "rviz": "RViz file", "include": "launch file"}


def launch_found(package: Package, *, name: str) -> Outcome:
    """The package has a launch file of this name; it may be written in Python, XML or YAML."""
    path = package.launch_file(name)
    if path is None:
        raise _no_launch_file(package)
    if is_launch_named(path, name):
        return passed(f"the launch file is {path}")
    hint = (
        ""
        if posixpath.splitext(path)[1] in (".py", ".xml", ".yaml", ".yml")
        else ", which ros2 launch cannot start without an ending such as .launch.py"
    )
    return judged_as("failed", f"there is no launch file {name!r}; the package has {path}{hint}")


def launch_starts(package: Package, *, name: str, nodes: list[str]) -> Outcome:
    """The launch file starts these nodes, with the defaults of its arguments; "a or b" leaves a choice.

    Launch files that it includes count, if they are part of the submission or of urdf_launch.
    """
    launch = _launch(package, name)
    started = {node.executable for node in launch.nodes if node.when and node.package == _home(node.executable)}
    perhaps = {node.executable for node in launch.nodes if node.when is None}
    choices = [wanted.split(" or ") for wanted in nodes]
    missing = [" or ".join(choice) for choice in choices if started.isdisjoint(choice)]
    if launch.faults:
        more = f" (and {len(launch.faults) - 1} more)" if len(launch.faults) > 1 else ""
        return judged_as("failed", f"{launch.faults[0].message}{more}", at=launch.faults[0].location)
    open_questions = [each for each in missing if not perhaps.isdisjoint(each.split(" or "))]
    if missing and (len(open_questions) == len(missing) or launch.unknown):
        reason = f": {launch.unknown[0].message}" if launch.unknown else ""
        return Outcome("pending", f"whether {_listed(missing)} is started is told only by a run{reason}")
    if not missing:
        return Outcome("passed", f"it starts {_listed(sorted(started))}", tuple(sorted(started)), tuple(nodes))
    message = f"it does not start {_listed(missing)}; it starts {_listed(sorted(started)) or 'nothing'}"
    forgotten = next((node for node in launch.forgotten if node.executable in " ".join(missing)), None)
    off = next((node for node in launch.nodes if node.when is False and node.executable in " ".join(missing)), None)
    at = None
    if forgotten is not None:
        message += f". The node {forgotten.executable} is made, but not part of the LaunchDescription"
        at = forgotten.location
    elif off is not None:
        message += f". A condition keeps {off.executable} from being started, unless an argument is given"
        at = off.location
    return Outcome("failed", message, tuple(sorted(started)), tuple(nodes), location=at)


def launch_finds_files(package: Package, *, name: str) -> Outcome:
    """The URDF and RViz files that the launch file names are where a build of the package puts them."""
    launch = _launch(package, name)
    references = launch.named("urdf", "rviz", "include")
    if not any(each.purpose != "include" for each in references):
        if launch.unknown:
            return Outcome("pending", f"which files it names is told only by a run: {launch.unknown[0].message}")
        raise MissingElement("named file", "", message="the launch file names neither a URDF nor an RViz file")
    verdicts = [(_verdict(package, each), each) for each in references]
    wrong = [(text, each) for (status, text), each in verdicts if status == "failed"]
    if wrong:
        message = "; ".join(dict.fromkeys(text for text, _ in wrong))
        return judged_as("failed", message, at=wrong[0][1].location)
    for (status, text), each in verdicts:
        if status == "missing":
            kind = (
                f"installed {each.purpose}" if package.setup is not None and package.setup.fault is None else "setup.py"
            )
            raise MissingElement(kind, package.folder, message=text, location=each.location)
    pending = [text for (status, text), _ in verdicts if status == "pending"]
    if pending:
        return Outcome("pending", f"{pending[0]}: a person has to look")
    return passed(
        f"the build puts {' and '.join(dict.fromkeys(text for (_, text), _ in verdicts if text))} where it is looked for"
    )


def _no_launch_file(package: Package) -> MissingElement:
    message = "the package has no launch file: none ends in .launch.py, .launch.xml or .launch.yaml"
    if not any(posixpath.basename(folder) == "launch" for folder in package.tree.folders):
        message += ", and there is no folder launch"
    return MissingElement("launch file in the package", "", message=message)


def _launch(package: Package, name: str) -> "Launch":
    path = package.launch_file(name)
    if path is None:
        raise _no_launch_file(package)
    launch = package.launch(path)
    if launch.syntax is not None:
        raise MissingElement("launch file", path, message=launch.syntax.message, location=launch.syntax.location)
    return launch


def _home(executable: str) -> str:
    """The package that a well-known program is in: all of these are called as it is."""
    return executable


def _verdict(package: Package, named: "Reference") -> tuple[str, str]:
    """What becomes of a file that a launch file names: passed, failed, pending or, if it is never installed, missing."""
    what = _WORDS[named.purpose]
    if named.path is None:
        return ("failed" if named.sure else "pending", named.reason)
    path = posixpath.normpath(named.path)
    if path.startswith(f"{SHARE}/"):
        owner, _, rest = path.removeprefix(f"{SHARE}/").partition("/")
        return _below_share(package, owner, rest, what)
    if path.startswith((HOME, "/home/", "/Users/", "/root/", "/mnt/", "/media/")) or path[1:3] in (":\\", ":/"):
        shown = path.replace(HOME, "~")
        advice = f"get_package_share_directory({package.name!r}) tells where it is installed"
        return "failed", f"it looks for the {what} at {shown}, which exists on one machine only: {advice}"
    if path.startswith(WORKING_FOLDER) or not path.startswith("/"):
        shown = path.removeprefix(WORKING_FOLDER + "/")
        return "failed", f"it looks for the {what} at {shown}, in whatever folder ros2 launch is started from"
    return "pending", f"the {what} {path.removeprefix(PREFIX)} is not part of the package"


def _below_share(package: Package, owner: str, rest: str, what: str) -> tuple[str, str]:
    other = package.known.get(owner)
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
    similar = closest(name, {posixpath.basename(path) for path in other.tree.files})
    there = f"; there is {similar!r}" if similar else ""
    return "failed", f"it looks for the {what} at {target}, but the package has no file {name!r}{there}"


def _listed(names: list[str]) -> str:
    return ", ".join(names)
