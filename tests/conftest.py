"""Settings for all tests: they depend on no variable of the machine, and files with slow tests start first."""

import gc
import os
import re
import signal
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Generator, Iterator
from contextlib import contextmanager, nullcontext
from math import inf
from pathlib import Path
from random import Random

import pytest
from hypothesis import find, settings
from hypothesis.strategies import none

from tests.edits_rubric import copy_with_edits

# Examples have no time limit of their own. They are the same in every run: `--hypothesis-profile=random` searches for others.
# There are few of them where a test does not say how many; see tests/examples.py.
settings.register_profile(
    "repeatable", deadline=None, derandomize=True, database=None, max_examples=20
)
settings.register_profile(
    "random", deadline=None, derandomize=False, database=None, max_examples=100, print_blob=True
)
settings.load_profile("repeatable")

# A command that a shell starts with `&` ignores Ctrl-C, one that `nohup` starts a closed terminal, and so would the
# commands that the tests start and interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)
if sys.platform != "win32" and signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
    signal.signal(signal.SIGHUP, signal.SIG_DFL)

# On a CI system the grader annotates, and takes the checkout for the repository; a git hook sets variables for another
# repository; colours and widths change the output; pip may have another target. Tests that need a variable set it.
_NAMES = (
    "CI",
    "CI_PROJECT_DIR",
    "CLICOLOR_FORCE",
    "COLUMNS",
    "FORCE_COLOR",
    "NO_COLOR",
    "PYTHONDONTWRITEBYTECODE",
    "PYTHONHASHSEED",
    "PYTHONOPTIMIZE",
    "PYTHONPATH",
    "PYTHONSAFEPATH",
    "PYTHONWARNINGS",
    "TTY_COMPATIBLE",
    "TTY_INTERACTIVE",
)
_BEGINNINGS = ("GITHUB_", "GIT_", "GRADER_", "PIP_", "_TYPER_")
for name in [name for name in os.environ if name in _NAMES or name.startswith(_BEGINNINGS)]:
    del os.environ[name]
# The user's git settings are ignored as well.
os.environ |= {"GIT_CONFIG_GLOBAL": os.devnull, "GIT_CONFIG_NOSYSTEM": "1"}


_QUICK = "not exhaustive and not slow"  # the tests of README's command
_MARKED = re.compile(r"^pytestmark = (\[\s*)?pytest\.mark\.(exhaustive|slow)\b", re.MULTILINE)
_DECIDING = (  # what covers the code that decides a mark: see [tool.coverage] in pyproject.toml
    *("checks", "classroom/marks", "corpus", "driving", "grading", "labs", "rubric", "urdf"),
    "base/test_transforms.py",
    *("authoring/test_equivalents.py", "authoring/test_random_robots.py"),
    "classroom/test_typed_names.py",
    *("interfaces", "parameters", "workspace"),
    *("cli/test_plugin_checks.py", "cli/test_review_pages.py", "cli/test_review_server.py"),
    *("fuzz/test_harnesses.py", "test_api.py", "test_docstring_examples.py", "test_registry.py"),
)
_LONGEST = (  # minutes of one worker in .ci/run, or nearly
    *("browser/test_attacks.py", "browser/test_site.py", "classroom/test_batch_resume.py"),
    *("classroom/workers/test_pool.py", "cli/test_rubric_test.py", "faults/test_faults.py"),
    *("differential/test_differential.py", "grading/test_slip_hints.py", "hints/test_laws.py"),
    *("hints/test_mutants.py", "oracles/test_mujoco.py", "report/test_mistakes.py"),
    *("test_page_commands.py", "urdf/test_reader.py", "walks/test_walks.py"),
)
_FEW = 2  # cases of a test that README's command runs
_MANY = 40  # cases of a test of which `--share` leaves some out
_BEGAN = time.monotonic()


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the order of files, which no result may depend on, and how much of large tables is run."""
    parser.addoption("--order", default="", help="'reversed', or a seed: how files are ordered")
    parser.addoption(
        "--share",
        type=int,
        default=1,
        help=f"run one of so many cases of a test with more than {_MANY}; which ones depends on the seed",
    )
    parser.addoption(
        "--minutes", type=float, default=inf, help="skip what has not begun after so many minutes"
    )


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Do not import modules of which README's command runs nothing, unless they are named."""
    if collection_path.suffix != ".py" or config.option.markexpr != _QUICK:
        return None
    if any(Path(word.partition("::")[0]).suffix == ".py" for word in config.args):
        return None
    marked = _MARKED.search(collection_path.read_text(encoding="utf-8"))
    return True if marked is not None else None


@contextmanager
def _kept_variables(beginning: str = "") -> Iterator[None]:
    """Take back what becomes of the variables whose names begin so."""
    before = dict(os.environ)
    try:
        yield
    finally:
        for name in {*before, *os.environ}:
            if name.startswith(beginning) and os.environ.get(name) != before.get(name):
                os.environ.pop(name, None)
                os.environ.update({name: before[name]} if name in before else {})


def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a test that begins too late."""
    minutes = item.config.option.minutes
    if time.monotonic() - _BEGAN > 60 * minutes:
        pytest.skip(f"not run: {minutes:g} minutes are over")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call() -> Generator[None]:
    """Take back what the code under test does to the variables of the process, as starting workers does."""
    with _kept_variables():
        return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol() -> Generator[None, bool, bool]:
    """Do the same after the fixtures of a test, for those of Python: they may start workers as well.

    Then Python no longer imports from the current folder in any later test.
    """
    with _kept_variables("PYTHON"):
        return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_fixture_setup(fixturedef: pytest.FixtureDef[object]) -> Generator[None, object, object]:
    """Do the same for a fixture that several tests share."""
    is_shared = fixturedef.scope != "function"
    with _kept_variables("PYTHON") if is_shared else nullcontext():
        return (yield)


@pytest.hookimpl(tryfirst=True)  # before tests are selected by their marks
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark as slow all cases of a test but some from all over its table.

    One worker runs a file: those with slow tests or many cases come first, so that none is waited for at the end.
    """
    deciding = [Path(__file__).parent / name for name in _DECIDING]
    slow = {item.path for item in items if item.get_closest_marker("slow")}
    sizes = Counter(item.path for item in items)
    items.sort(key=lambda item: (item.path not in slow, -sizes[item.path]))
    cases = defaultdict[str, list[pytest.Item]](list)
    for item in items:
        if item.get_closest_marker("exhaustive") is None:
            cases[item.nodeid.partition("[")[0]].append(item)
    for item in items:
        if any(folder in (item.path, *item.path.parents) for folder in deciding):
            item.add_marker("deciding")
    for many in cases.values():
        kept = _of_each_kind(many) or many[:: max(1, len(many) // _FEW)]
        for item in many:
            if item not in kept:
                item.add_marker("slow")
    if config.option.share > 1:
        _leave_out(items, config)
    _reorder(items, config.option.order)


def _leave_out(items: list[pytest.Item], config: pytest.Config) -> None:
    """Take out of large tables what is not in the share that the seed names."""
    share = config.option.share
    cases = defaultdict[str, list[pytest.Item]](list)
    for item in items:
        cases[item.nodeid.partition("[")[0]].append(item)
    first = int(config.option.order) % share
    out = {
        item
        for many in cases.values()
        for place, item in enumerate(many)
        if len(many) > _MANY and place % share != first
    }
    config.hook.pytest_deselected(items=[*out])
    items[:] = [item for item in items if item not in out]


def _of_each_kind(cases: list[pytest.Item]) -> list[pytest.Item]:
    """Return the first case of each kind, if a mark says what the kind of a case is."""
    mark = cases[0].get_closest_marker("every")
    if mark is None:
        return []
    kinds: dict[object, pytest.Item] = {}
    for item in cases:
        assert isinstance(item, pytest.Function)
        kinds.setdefault(mark.kwargs["kind"](*item.callspec.params.values()), item)
    return [*kinds.values()]


def _reorder(items: list[pytest.Item], order: str) -> None:
    """Put the files into another order; the tests of a file share fixtures, and stay together.

    In a random order the longest files come first, so that no worker waits for the one that runs the last of them.
    """
    longest = [Path(__file__).parent / name for name in _LONGEST]
    files = [*dict.fromkeys(item.path for item in items)]
    if order == "reversed":
        files.reverse()
    elif order:
        Random(order).shuffle(files)
        files.sort(key=lambda path: path not in longest)
    places = {path: place for place, path in enumerate(files)}
    items.sort(key=lambda item: places[item.path])


def pytest_collection_finish() -> None:
    """Exclude the objects of ten thousand tests from the garbage collector, which would scan them again and again.

    Hypothesis runs an example before: it makes a generator of random numbers for the thread, and warns of one that
    nothing refers to. From Python 3.14 on, the collector tracks each dictionary, so that the one of the thread that refers
    to the generator is excluded with the others, and not found.
    """
    find(none(), lambda _: True)
    gc.collect()
    gc.freeze()


@pytest.fixture
def shows_edits(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch) -> None:
    """Grade by a copy of lab6 whose hints may show edits, unless another rubric is named."""
    monkeypatch.setenv(
        "GRADER_RUBRIC", str(copy_with_edits(tmp_path_factory.mktemp("edits") / "lab6"))
    )
