"""Spawners: whether the controllers and the controller manager that they name exist, and each
controller is started.
"""

import re
from collections.abc import Iterator, Sequence
from functools import partial
from itertools import pairwise

from grader.base.names import near
from grader.base.text import enumerated, quoted
from grader.ros.config.yaml_nodes import YamlFault
from grader.ros.launch.launch_model import Launch, StartedNode
from grader.ros.launch.node_parameters import controllers_of, parameters_of
from grader.ros.package.installed_files import open_meant
from grader.ros.package.package import Package
from grader.ros.workspace.controllers import Controller, defined_controllers
from grader.ros.workspace.names import Fact, Mismatch, Open, Use, corrections, place_text
from grader.ros.workspace.workspace import MANAGER, SPAWNERS, Workspace

_OTHER_STARTS = re.compile(r"(load|switch|set)_controller|(Load|Switch)Controller")
_MAX_NAMED = 3


def spawner_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield the controllers that spawners load, and what keeps controllers from being loaded."""
    controllers = list(defined_controllers(workspace))
    if not controllers:
        return
    if any(isinstance(tree, YamlFault) for tree in workspace.yaml_files.values()):
        yield Open("controller", reason="a parameter file cannot be read")
    if (
        not workspace.has_controller_manager
    ):  # the robot's driver starts one, with controllers of its own
        yield Open("controller")
    for _, node in workspace.nodes:
        if (
            _is_spawner(node)
            and node.arguments is not None
            and _is_defined_by_files(workspace, node.arguments)
        ):
            for name in _named(node.arguments):
                yield Use("controller", name, node.location, "spawner")
            yield from _managers_named(workspace, node)
    for package, launch in workspace.roots:
        yield from _without_type(workspace, package, launch, controllers)
    yield from _not_started(workspace, controllers)


def _is_spawner(node: StartedNode) -> bool:
    return node.package == MANAGER and node.executable in SPAWNERS


def _named(words: Sequence[str | None]) -> Iterator[str]:
    """Yield the controllers before the options of a spawner."""
    for word in words:
        if word is None or word.startswith("-"):
            return
        yield from word.split()


def _is_defined_by_files(workspace: Workspace, words: Sequence[str | None]) -> bool:
    """Return whether the controllers of a spawner are defined by files that are submitted, and not
    by its arguments.
    """
    files = [path for option, path in pairwise(words) if option in ("-p", "--param-file")]
    return not _is_typed(words) and all(
        path is not None and workspace.source_of(path) is not None for path in files
    )


def _is_typed(words: Sequence[str | None]) -> bool:
    return any(word in ("-t", "--controller-type") for word in words)


def _managers_named(workspace: Workspace, spawner: StartedNode) -> Iterator[Fact]:
    """Yield the controller manager that a spawner waits for, where it surely stands for another
    one.
    """
    given = [
        word
        for option, word in pairwise(spawner.arguments or ())
        if option in ("-c", "--controller-manager")
    ]
    managers = {
        workspace.name_of(node): node.location for _, node in workspace.nodes if _is_manager(node)
    }
    for name in [(word or "").rpartition("/")[2] for word in given]:
        meant = near(name, [it for it in managers if it]) if name not in managers else None
        if meant is not None:
            at = managers[meant]
            message = (
                f"spawner: there is no controller manager {name!r}; did you mean {meant!r} "
                f"({place_text(at)})?"
            )
            either = corrections(name, spawner.location, meant)
            yield Mismatch("controllers", message, spawner.location, at, corrections=either)


def _is_manager(node: StartedNode) -> bool:
    return node.executable == "ros2_control_node"


def _without_type(
    workspace: Workspace, package: Package, launch: Launch, controllers: Sequence[Controller]
) -> Iterator[Fact]:
    """Yield the controllers whose types are in files, but in none that the controller manager or
    their spawner gets.
    """
    managers = [it for it in launch.nodes if _is_manager(it) and it.when]
    if len(managers) != 1:
        return
    opened = partial(open_meant, package)
    given = parameters_of(
        managers[0], opened, workspace.name_of(managers[0]) or "", is_python=False
    )
    # In later releases, spawners hand on their own parameters.
    spawners = [it for it in launch.nodes if _is_spawner(it) and it.when and it.parameters == ()]
    plain = [it for it in spawners if not _is_typed(it.arguments or ())]
    started = [it for spawner in plain for it in controllers_of(spawner) or ()]
    own = {it.node_name: parameters_of(it, opened, is_python=False) for it in started}
    typed = [
        name
        for name, it in own.items()
        if it.unknown or "type" in it.values or f"{name}.type" in given.values
    ]
    files = [workspace.source_of(it.path) for it in managers[0].parameters or () if it.path]
    lacking = [
        it for it in controllers if it.name in {*own} - {*typed} and it.location.path not in files
    ]
    if lacking and not given.unknown:
        names = enumerated(dict.fromkeys(quoted(it.name) for it in lacking), _MAX_NAMED)
        place = place_text(lacking[0].location)
        text = (
            f"the controller manager is not given the parameters with the type of {names} ({place})"
        )
        yield Mismatch("controllers", text, managers[0].location, lacking[0].location)


def _not_started(workspace: Workspace, controllers: Sequence[Controller]) -> Iterator[Fact]:
    """Yield the controllers that publish, or those that move joints, where no spawner starts one of
    them.
    """
    nodes = [node for _, node in workspace.nodes]
    spawned = [controllers_of(node) for node in nodes if _is_spawner(node)]
    texts = (*workspace.launch_texts, *workspace.python_texts)
    is_known = not workspace.unknown_nodes and not any(map(_OTHER_STARTS.search, texts))
    if not spawned or not is_known or not workspace.has_controller_manager:
        return
    names = {it.node_name for each in spawned for it in each or ()}
    files = {*workspace.parameter_files, *workspace.controller_files}
    own = [it for it in controllers if it.location.path in files]
    others = [
        it for it in nodes if it.package == MANAGER and not _is_manager(it) and not _is_spawner(it)
    ]
    if others or names - {it.name for it in controllers}:
        return  # a name may be misspelt
    publishing = [it for it in own if (it.type.text or "").endswith("Broadcaster")]
    for kind in (publishing, [it for it in own if it not in publishing]):
        if kind and names.isdisjoint(it.name for it in kind):
            text = (
                "no spawner starts "
                f"{enumerated(dict.fromkeys(quoted(it.name) for it in kind), _MAX_NAMED, 'or')}"
            )
            yield Mismatch("controllers", text, kind[0].location)
