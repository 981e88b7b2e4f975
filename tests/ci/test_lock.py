"""The versions and hashes that jobs of users install: complete for each Python and system, and those that pyproject.toml allows."""

import re
import tomllib
from collections.abc import Iterator
from importlib.metadata import PackageNotFoundError, distribution
from typing import NamedTuple

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from tests.command_line import ROOT

pytestmark = pytest.mark.slow

PYTHONS = ("3.11", "3.12", "3.13", "3.14")
SYSTEMS = {"linux": ("Linux", "posix"), "darwin": ("Darwin", "posix"), "win32": ("Windows", "nt")}
TEXT = (ROOT / "requirements.lock").read_text(encoding="utf-8")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


class Locked(NamedTuple):
    """One entry of the lock."""

    requirement: Requirement
    hashes: list[str]

    @property
    def version(self) -> str:
        """Return the only version."""
        [specifier] = self.requirement.specifier
        assert specifier.operator == "=="
        return specifier.version


def entries() -> Iterator[Locked]:
    """Yield the entries of the lock."""
    lines = re.sub(r"(?m)^\s*#.*$", "", TEXT).replace("\\\n", " ")
    for line in filter(str.strip, lines.splitlines()):
        requirement, *hashes = line.split("--hash=")
        yield Locked(Requirement(requirement.strip()), [text.strip() for text in hashes])


LOCKED = list(entries())


def wanted() -> list[Requirement]:
    """Return what the grader needs with the extra `documents`, and what builds it."""
    project = PROJECT["project"]
    texts = [
        *project["dependencies"],
        *project["optional-dependencies"]["documents"],
        *PROJECT["build-system"]["requires"],
    ]
    return [Requirement(text) for text in texts]


def test_every_entry_has_one_version_and_hashes() -> None:
    """pip refuses anything else with --require-hashes; a wheel and the source are two hashes at least."""
    for entry in LOCKED:
        assert entry.version
        assert len(entry.hashes) >= 2, entry.requirement
        assert all(re.fullmatch(r"sha256:[0-9a-f]{64}", text) for text in entry.hashes)


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("python", PYTHONS)
def test_the_lock_is_complete(python: str, system: str) -> None:
    """Each package is there once, in a version that is allowed, with all that it needs, as far as that is installed here."""
    name, family = SYSTEMS[system]
    environment = {
        "python_version": python,
        "python_full_version": f"{python}.1",
        "sys_platform": system,
        "platform_system": name,
        "os_name": family,
        "extra": "",
    }

    def counts(requirement: Requirement) -> bool:
        return requirement.marker is None or requirement.marker.evaluate(environment)

    here = [entry for entry in LOCKED if counts(entry.requirement)]
    versions = {canonicalize_name(entry.requirement.name): entry.version for entry in here}
    assert len(versions) == len(here)
    needed = wanted()
    for package, version in versions.items():
        try:
            installed = distribution(package)
        except PackageNotFoundError:
            continue
        if installed.version == version:
            needed += [Requirement(text) for text in installed.requires or ()]
    for requirement in filter(counts, needed):
        version = versions[canonicalize_name(requirement.name)]
        assert requirement.specifier.contains(version), (requirement, version)


def test_the_group_is_what_builds_the_grader() -> None:
    """The lock has the group `build`, because uv locks no [build-system]."""
    assert PROJECT["dependency-groups"]["build"] == PROJECT["build-system"]["requires"]


def test_the_documented_command_is_that_of_the_lock() -> None:
    """The command that renews it stands in CONTRIBUTING.md, too."""
    [command] = re.findall(r"(?m)^#\s+(uv pip compile .*)$", TEXT)
    assert f"\n{command}\n" in (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
