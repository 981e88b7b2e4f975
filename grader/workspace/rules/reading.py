"""Read a workspace: what its files define and use, and what does not agree."""

from collections.abc import Callable, Collection, Iterator
from functools import cache, lru_cache
from importlib import import_module
from itertools import chain

from grader.base.errors import NotDecided
from grader.base.source import Location
from grader.ros.package.package import Package
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    DEFINED,
    Agreement,
    Definition,
    Fact,
    Facts,
    Mismatch,
    Use,
    agreement,
    uncompared,
)
from grader.workspace.rules.rule_table import AnyFamily, list_readers
from grader.workspace.rules.unused import unused_files

# The parts of a fact, and of a mismatch, for which similar names are searched.
_OF_FACT = 3
_OF_MISMATCH = 1_000


@cache
def _readers() -> "tuple[Callable[[Workspace], Facts], ...]":
    """Return the functions `..._facts` of the modules beside this one."""
    readers = []
    for place in list_readers():
        module, name = place.split(".")
        readers.append(getattr(import_module(f"{__package__}.{module}"), name))
    return tuple(readers)


@lru_cache(maxsize=2)
def read_agreement(workspace: Workspace) -> Agreement:
    """Return what does not agree in a workspace.

    If the budget of the workspace is spent, it is what is found before, and that the rest is not
    compared.
    """
    facts, error = facts_once(workspace)
    unused: tuple[Location, ...] = ()
    try:
        if error:
            raise error
        agreed = agreement(facts, workspace.charge)
        unused = tuple(unused_files(workspace))
    except NotDecided as reason:
        agreed = uncompared(facts, str(reason))
    # names_agree needs a package.
    families = agreed.families if workspace.packages else frozenset[AnyFamily]()
    return agreed._replace(families=families, unused=unused)


@lru_cache(maxsize=3)  # an editor also asks the last state without errors
def facts_once(workspace: Workspace) -> tuple[list[Fact], NotDecided | None]:
    """Return what files define and use, as far as the budget of the workspace allows.

    Without all of them there is the error of the budget.
    """
    facts: list[Fact] = []
    try:
        facts += read_facts(workspace)
    except NotDecided as error:
        return facts, error
    return facts, None


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


def read_facts(workspace: Workspace) -> Facts:
    """Yield what the files of a workspace define and use.

    Raises NotDecided where this takes too much work.
    """
    for fact in chain.from_iterable(reader(workspace) for reader in _readers()):
        workspace.charge(_OF_MISMATCH if isinstance(fact, Mismatch) else _OF_FACT)
        yield fact


def compared_facts(
    workspace: Workspace, families: Collection[AnyFamily]
) -> Iterator[Use | Definition]:
    """Yield the names of these families that files use or define."""
    for fact in read_facts(workspace):
        if isinstance(fact, Use | Definition) and DEFINED[fact.kind].family in families:
            yield fact
