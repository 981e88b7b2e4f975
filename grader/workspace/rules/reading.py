"""Read a workspace: what its files define and use, and what does not agree."""

from collections.abc import Collection, Iterator
from functools import lru_cache
from itertools import chain
from typing import NamedTuple

from grader.base.errors import NotDecided
from grader.base.source import Location
from grader.ros.package.package import Package
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.arguments import argument_facts
from grader.workspace.rules.bridges import bridge_facts
from grader.workspace.rules.classic_plugins import classic_plugin_facts
from grader.workspace.rules.code import code_facts
from grader.workspace.rules.companions import companion_facts
from grader.workspace.rules.component_names import component_facts
from grader.workspace.rules.controllers import controller_facts
from grader.workspace.rules.dependencies import dependency_facts
from grader.workspace.rules.files import file_facts
from grader.workspace.rules.footprint_values import footprint_facts
from grader.workspace.rules.frames import frame_facts
from grader.workspace.rules.gains import gain_facts
from grader.workspace.rules.gazebo import gazebo_facts
from grader.workspace.rules.gazebo_hardware import gazebo_hardware_facts
from grader.workspace.rules.headers import header_facts
from grader.workspace.rules.interfaces import interface_facts
from grader.workspace.rules.known_ends import known_end_facts
from grader.workspace.rules.known_parameters import known_parameter_facts
from grader.workspace.rules.launch_tables import launch_table_facts
from grader.workspace.rules.limit_values import limit_facts
from grader.workspace.rules.link_bodies import body_facts
from grader.workspace.rules.listed_plugins import listed_plugin_facts
from grader.workspace.rules.looked_up_transforms import lookup_facts
from grader.workspace.rules.mass_values import mass_facts
from grader.workspace.rules.meeting_ends import meeting_facts
from grader.workspace.rules.message_stamps import message_stamp_facts
from grader.workspace.rules.mimic_interfaces import mimic_facts
from grader.workspace.rules.missing_ends import missing_end_facts
from grader.workspace.rules.moveit import moveit_facts
from grader.workspace.rules.names import (
    Agreement,
    Definition,
    Fact,
    Mismatch,
    Use,
    agreement,
    uncompared,
)
from grader.workspace.rules.namespaces import namespace_facts
from grader.workspace.rules.nested_packages import nested_package_facts
from grader.workspace.rules.older_gazebo import older_gazebo_facts
from grader.workspace.rules.one_machine import machine_facts
from grader.workspace.rules.package_forms import package_form_facts
from grader.workspace.rules.parameter_lists import list_facts
from grader.workspace.rules.parameters import parameter_facts
from grader.workspace.rules.plugin_classes import plugin_class_facts
from grader.workspace.rules.programs import program_facts
from grader.workspace.rules.provided_packages import provision_facts
from grader.workspace.rules.published_transforms import transform_facts
from grader.workspace.rules.rate_values import rate_facts
from grader.workspace.rules.received_messages import received_message_facts
from grader.workspace.rules.remapped_names import remapping_facts
from grader.workspace.rules.renamed_nodes import renamed_node_facts
from grader.workspace.rules.repeated_interfaces import repeated_interface_facts
from grader.workspace.rules.rule_table import DEFINED, AnyFamily
from grader.workspace.rules.side_values import side_facts
from grader.workspace.rules.simulated_joints import simulated_joint_facts
from grader.workspace.rules.simulated_nodes import simulated_node_facts
from grader.workspace.rules.simulated_topics import simulated_topic_facts
from grader.workspace.rules.spawners import spawner_facts
from grader.workspace.rules.srdf import srdf_facts
from grader.workspace.rules.terminal_programs import terminal_facts
from grader.workspace.rules.topic_wiring import topic_wiring_facts
from grader.workspace.rules.unmet_topics import unmet_topic_facts
from grader.workspace.rules.unread_parameters import unread_parameter_facts
from grader.workspace.rules.unused import unused_files
from grader.workspace.rules.unused_arguments import unused_argument_facts
from grader.workspace.rules.used_libraries import library_facts
from grader.workspace.rules.wheel_values import wheel_value_facts

_READERS = (
    file_facts,
    frame_facts,
    controller_facts,
    plugin_class_facts,
    mimic_facts,
    spawner_facts,
    parameter_facts,
    known_parameter_facts,
    launch_table_facts,
    argument_facts,
    program_facts,
    component_facts,
    meeting_facts,
    missing_end_facts,
    remapping_facts,
    gazebo_facts,
    bridge_facts,
    simulated_topic_facts,
    srdf_facts,
    moveit_facts,
    dependency_facts,
    interface_facts,
    code_facts,
    wheel_value_facts,
    limit_facts,
    rate_facts,
    footprint_facts,
    transform_facts,
    lookup_facts,
    companion_facts,
    namespace_facts,
    renamed_node_facts,
    machine_facts,
    topic_wiring_facts,
    unmet_topic_facts,
    received_message_facts,
    message_stamp_facts,
    gain_facts,
    known_end_facts,
    provision_facts,
    list_facts,
    header_facts,
    mass_facts,
    library_facts,
    nested_package_facts,
    classic_plugin_facts,
    simulated_node_facts,
    repeated_interface_facts,
    package_form_facts,
    older_gazebo_facts,
    side_facts,
    gazebo_hardware_facts,
    listed_plugin_facts,
    simulated_joint_facts,
    terminal_facts,
    unread_parameter_facts,
    unused_argument_facts,
    body_facts,
)


# The parts of a fact, and of a mismatch, for which similar names are searched.
_OF_FACT, _OF_MISMATCH = 3, 1_000


class _Facts(NamedTuple):
    facts: list[Fact]
    why_not_all: NotDecided | None = None


@lru_cache(maxsize=2)
def read_agreement(workspace: Workspace) -> Agreement:
    """Return what does not agree in a workspace.

    If the budget of the workspace is spent, it is what is found before, and that the rest is not
    compared.
    """
    facts, error = facts_once(workspace)
    unused: tuple[Location, ...] = ()
    try:
        if error is not None:
            raise error
        agreed = agreement(facts, workspace.charge)
        unused = tuple(unused_files(workspace))
    except NotDecided as reason:
        agreed = uncompared(facts, str(reason))
    # names_agree needs a package.
    families = agreed.families if workspace.packages else frozenset[AnyFamily]()
    return agreed._replace(families=families, unused=unused)


@lru_cache(maxsize=2)
def facts_once(workspace: Workspace) -> _Facts:
    """Return what files define and use, as far as the budget of the workspace allows.

    It is what is read before the budget is spent.
    """
    facts: list[Fact] = []
    try:
        facts += read_facts(workspace)
    except NotDecided as error:
        return _Facts(facts, error)
    return _Facts(facts)


def wrong_names(
    workspace: Workspace, family: AnyFamily, packages: Collection[Package]
) -> list[Mismatch]:
    """Return what certainly does not agree in some packages of a workspace."""
    wrong = []
    for mismatch in read_agreement(workspace).mismatches:
        is_wrong = mismatch.family == family and mismatch.is_certain
        if is_wrong and any(package.holds(mismatch.location.path) for package in packages):
            wrong.append(mismatch)
    return wrong


def read_facts(workspace: Workspace) -> Iterator[Fact]:
    """Yield what the files of a workspace define and use.

    Raises NotDecided where this takes too much work.
    """
    for fact in chain.from_iterable(reader(workspace) for reader in _READERS):
        workspace.charge(_OF_MISMATCH if isinstance(fact, Mismatch) else _OF_FACT)
        yield fact


def compared_facts(
    workspace: Workspace, families: Collection[AnyFamily]
) -> Iterator[Use | Definition]:
    """Yield the names of these families that files use or define."""
    for fact in read_facts(workspace):
        if isinstance(fact, Use | Definition) and DEFINED[fact.kind].family in families:
            yield fact
