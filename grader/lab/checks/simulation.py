"""The check of the world that Gazebo runs: the systems that it loads."""

from grader.base.errors import MissingElement, NotDecided
from grader.base.text import enumerated, quoted
from grader.lab.checks.check import About
from grader.lab.checks.outcome import Outcome, failed, passed
from grader.lab.submission.submission import Submission

ABOUT = {
    "world_has": About(
        causes={
            "file": "a plugin names a library that Gazebo does not have, so no system is loaded"
        }
    )
}


def world_has(submission: Submission, *, systems: list[str]) -> Outcome:
    """The world that a launch file starts has these systems of Gazebo, as has one without plugins
    the systems that Gazebo loads by default.

    A launch file that names the world has to start Gazebo. Plugins of robots and models count as
    well. Of a world that is not part of the submission, nothing is known.

    Args:
        systems: The names of the classes of systems, such as "UserCommands" or "Sensors".
    """
    from grader.workspace.api import started_worlds  # late: few rubrics ask for it

    submission.needed_package()
    workspace = submission.workspace
    worlds = started_worlds(workspace)
    if worlds.has_others:
        raise NotDecided("no file of the packages is known to be the world that is launched")
    if not worlds.files:
        raise MissingElement("world", "", message="the packages have no world")
    if not worlds.may_start:
        start = workspace.launches.roots[0][1].source.at(0)
        return failed("no launch file starts Gazebo", start, cause="start")
    missing = [name for name in systems if name not in worlds.systems | worlds.own_systems]
    for name in missing:
        if name in worlds.misnamed:
            library, at = worlds.misnamed[name]
            message = f"Gazebo has no library {quoted(library)}, so the system {name} is missing"
            return failed(message, at, cause="file")
    if missing:
        file = worlds.files[0]
        world = file.location(next(file.root.iterchildren("world")))
        noun = "system" if len(missing) == 1 else "systems"
        detail = f"; it has {enumerated(sorted(worlds.systems)) or 'none'}"
        return failed(f"the world has no {noun} {enumerated(missing)}", world, detail=detail)
    return passed(f"the world has {enumerated(systems)}")
