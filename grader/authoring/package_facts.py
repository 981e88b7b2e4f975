"""The facts of the package of a reference: its name and type, its launch and RViz files, and what a build installs."""

import posixpath
from collections.abc import Iterator
from typing import Any

from grader.authoring.fact import THE_PACKAGE, Fact, Facts, Omission, Solution
from grader.package.launch.model import Launch
from grader.package.package import Package

_OWN_KINDS = (".urdf", ".xacro", ".rviz", ".py", ".xml")


def package_facts(solution: Solution) -> Facts:
    """Yield what may be true of the package that is graded; the other packages are omitted."""
    package, path = solution.submission.package, solution.submission.path
    for other in solution.submission.packages:
        if other is not package:
            yield Omission(f"the package {other.name}", "a rubric is about one package")
    if package is None:
        return
    yield _of("package_found", name=package.name)
    if package.manifest is not None and package.manifest.build_type:
        yield _of("package_type", build_type=package.manifest.build_type)
    yield from [] if package.is_cmake else [_of("setup_imports")]
    yield from _installs(package, path if path is not None and package.holds(path) else "")
    for launch in package.launch_files:
        yield from _launch_facts(posixpath.basename(launch), package.launch(launch))
    yield from _rviz_facts(package)


def _of(check: str, label: str = "", **arguments: Any) -> Fact:
    return Fact(THE_PACKAGE, check, arguments, f"{label} {check}".strip())


def _installs(package: Package, urdf: str) -> Iterator[Fact]:
    """Yield that a build installs the URDF, the launch and RViz files, and a file of each other folder."""
    kinds = {"urdf": [urdf] if urdf else [], "launch": package.launch_files, "rviz": package.rviz_files}
    for kind, paths in kinds.items():
        for name in map(posixpath.basename, paths):
            yield _of("build_installs", name, kind=kind, name=name)
    patterns = {
        f"{folder}/*{posixpath.splitext(path)[1]}": None
        for path in package.installed.values()
        if (folder := posixpath.dirname(path)) not in ("", "resource")
        and path not in package.launch_files
        and not path.endswith(_OWN_KINDS)
    }
    yield from (_of("installs_files", pattern, files=[pattern]) for pattern in patterns)


def _launch_facts(name: str, launch: Launch) -> Iterator[Fact]:
    yield _of("launch_found", name, name=name)
    if nodes := _nodes_that_start(launch):
        yield _of("launch_starts", name, name=name, nodes=nodes)
    if launch.named("urdf", "rviz", "include"):
        yield _of("launch_finds_files", name, name=name)


def _nodes_that_start(launch: Launch) -> list[str]:
    """Return the nodes that start, with what a condition replaces: joint_state_publisher for its GUI, for example."""
    names = {when: list(dict.fromkeys(it.name for it in launch.nodes if it.when is when)) for when in (True, False)}
    alike = {name: [it for it in names[False] if name.startswith(it) or it.startswith(name)] for name in names[True]}
    return [" or ".join(dict.fromkeys((name, *others))) for name, others in alike.items()]


def _rviz_facts(package: Package) -> Iterator[Fact]:
    """Yield what may be true of each RViz file, which is also found by the first launch file that opens it."""
    opened: dict[str, str] = {}
    for path in package.launch_files:
        opened.setdefault(package.rviz_opened(package.launch(path)) or "", posixpath.basename(path))
    for path in package.rviz_files:
        rviz, name = package.rviz(path), posixpath.basename(path)
        of = {"name": name, **({"launch": opened[path]} if path in opened else {})}
        yield _of("rviz_found", name, **of)
        if rviz.fixed_frame:
            yield _of("rviz_fixed_frame", name, **of, frame=rviz.fixed_frame)
        displays = dict.fromkeys((display.package, display.kind) for display in rviz.displays if display.enabled)
        for owner, kind in displays:
            if kind == "RobotModel":
                yield _of("rviz_shows_robot", name, **of)
            else:
                yield _of("rviz_display_on", f"{name} {kind}", **of, kind=f"{owner}/{kind}")
