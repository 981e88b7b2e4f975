"""No test sees the variables that another one, or a fixture, has set in this process."""

import os

import pytest

from grader.workers.forks import worker_context

_OF_WORKERS = "PYTHONSAFEPATH"  # with it, Python imports nothing from the current folder


def _start_workers() -> str:
    worker_context()
    return os.environ[_OF_WORKERS]


@pytest.fixture(scope="module")
def shared() -> str:
    """Set a variable, as a fixture does that grades a class for several tests."""
    return _start_workers()


@pytest.fixture
def own() -> str:
    """Set it for one test."""
    return _start_workers()


def test_a_shared_fixture_leaves_no_variable(shared: str) -> None:
    """Neither for the tests that use it, nor for others."""
    assert shared == "1"
    assert _OF_WORKERS not in os.environ


def test_a_fixture_of_a_test_sets_a_variable(own: str) -> None:
    """The test itself still has it."""
    assert own == os.environ[_OF_WORKERS] == "1"


def test_the_next_test_has_no_such_variable() -> None:
    """The one before has ended, with all of its fixtures."""
    assert _OF_WORKERS not in os.environ
