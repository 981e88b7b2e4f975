"""Every harness holds on its seeds, on the inputs that once failed, and on a few mutated ones, without atheris."""

import tempfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from random import Random

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.examples import examples
from tests.fuzz.harness import FOLDER, GUARD, Guard, files_of, mutated, packed
from tests.fuzz.harnesses import HARNESSES
from tests.samples import ROOT

_SLOW = ("grade-",)  # harnesses whose inputs take a tenth of a second
_MOST = 20  # seeds of each harness
_CRASHES = [path for path in sorted((FOLDER / "crashes").glob("*/*"))]


@pytest.fixture(autouse=True)
def scratch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """Give the harnesses a folder, the only one that they may write in."""
    monkeypatch.setattr(GUARD, "folder", str(tmp_path))
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    yield


@cache
def inputs(name: str) -> list[bytes]:
    """Return some seeds of a harness."""
    found = HARNESSES[name].inputs(name)
    return found[:: 1 + len(found) // (4 if name.startswith(_SLOW) else _MOST)]


@pytest.mark.every(kind=str)
@pytest.mark.parametrize("name", HARNESSES)
def test_a_harness_holds_on_its_seeds(name: str) -> None:
    """Also on those that are changed, up to the size of its inputs."""
    harness = HARNESSES[name]
    assert inputs(name)
    for data in inputs(name):
        with GUARD.watching():
            harness.run(data)


@pytest.mark.slow
@pytest.mark.parametrize("path", _CRASHES, ids=lambda path: f"{path.parent.name}-{path.name}")
def test_what_once_failed_holds(path: Path) -> None:
    """Each file in `crashes` is an input with which a harness once found a fault."""
    with GUARD.watching():
        HARNESSES[path.parent.name].run(path.read_bytes())


@pytest.mark.parametrize("name", HARNESSES)
def test_a_harness_holds_on_mutated_seeds(name: str) -> None:
    """The mutations are those of the long search, and the same in every run."""

    @settings(examples(1 if name.startswith(_SLOW) else 15), suppress_health_check=[*HealthCheck])
    @given(chance=st.randoms(use_true_random=False), which=st.integers(0))
    def hold(chance: Random, which: int) -> None:
        harness, seeds = HARNESSES[name], inputs(name)
        data = mutated(seeds[which % len(seeds)], chance, harness.words, harness.size)
        with GUARD.watching():
            harness.run(data)

    hold()


def test_a_folder_is_one_input(tmp_path: Path) -> None:
    """The files of a folder are read from one input as they are."""
    folder = ROOT / "rubrics" / "sensors"
    files = files_of(packed(folder))
    assert files
    assert all((folder / path).read_bytes() == data for path, data in files.items())


@pytest.mark.parametrize(
    "act",
    [
        lambda folder: (folder / "a").write_text("a"),
        lambda folder: (folder / "b").mkdir(),
        lambda _: __import__("os").system("true"),
    ],
)
def test_the_guard_finds_what_no_harness_may_do(act: object, tmp_path: Path) -> None:
    """Writing outside of the folder and starting a process are findings."""
    assert isinstance(GUARD, Guard)
    assert callable(act)
    GUARD.folder = str(tmp_path / "inside")
    with pytest.raises(AssertionError), GUARD.watching():
        act(tmp_path)
