"""Hostile documents are refused after bounded work: nothing runs, and nothing outside of the submission is read.

The documents are megabytes of text: they are made when a test needs them.
"""

import json
import sys
from contextlib import suppress
from pathlib import Path
from subprocess import run as run_program
from typing import Any

import pytest

from tests.command_line import HANG_TIMEOUT, clean_environment, run
from tests.examples import spread
from tests.work import TooMuchWork, limited_work
from tests.xacro.documents.document import part, robot

MAX_MEGABYTES = 64
Results = dict[str, dict[str, Any]]


@pytest.fixture(scope="module", params=spread((10, 1), 1), ids=["some", "all"])
def results(request: pytest.FixtureRequest) -> Results:
    """Return what happened to each document, by its name."""
    pytest.importorskip("resource")
    done = run_program(
        [sys.executable, "-m", "tests.xacro.hostile_run", str(request.param)],
        capture_output=True,
        text=True,
        check=False,
        timeout=HANG_TIMEOUT,
        cwd=Path(__file__).parents[2],
        env=clean_environment(),
    )
    found = dict(json.loads(line) for line in done.stdout.splitlines())
    assert (done.returncode, done.stderr) == (0, ""), f"stopped after {list(found)[-1:]}"
    return found


@pytest.mark.slow
def test_hostile_documents_are_refused_after_bounded_work(results: Results) -> None:
    """Each is refused, or cannot be determined, after a bounded number of lines of Python; none stops the process."""
    from tests.xacro.hostile import HOSTILE

    outcomes = {name: results[name]["outcome"] for name in HOSTILE.keys() & results.keys()}
    assert {name: outcome for name, outcome in outcomes.items() if outcome != "refused"} == {}
    assert outcomes.keys() == HOSTILE.keys() or len(outcomes) >= 5
    assert len(HOSTILE) >= 60


@pytest.mark.slow
def test_large_documents_take_bounded_work(results: Results) -> None:
    """A document that is only large is expanded or refused after a bounded number of lines."""
    from tests.xacro.hostile import LARGE

    outcomes = {name: results[name]["outcome"] for name in LARGE.keys() & results.keys()}
    assert {
        name: outcome
        for name, outcome in outcomes.items()
        if outcome not in {"refused", "expanded"}
    } == {}


@pytest.mark.slow
def test_costly_documents_take_bounded_work(results: Results) -> None:
    """What the budget of a submission allows takes a bounded number of calls, wherever a document wants the work to be done."""
    from tests.xacro.hostile_costs import COSTS

    outcomes = {
        name: results[f"cost-{name}"]["outcome"] for name in COSTS if f"cost-{name}" in results
    }
    assert {
        name: outcome
        for name, outcome in outcomes.items()
        if outcome not in {"refused", "expanded"}
    } == {}
    assert outcomes.keys() == COSTS.keys() or len(outcomes) >= 10
    assert len(COSTS) >= 100


@pytest.mark.slow
def test_memory_is_bounded(results: Results) -> None:
    """No document needs much memory."""
    used = {name: found["megabytes"] for name, found in results.items()}
    assert {name: megabytes for name, megabytes in used.items() if megabytes > MAX_MEGABYTES} == {}


@pytest.mark.slow
def test_nothing_runs(results: Results) -> None:
    """Python reports no open file, import, execution or process while a document is expanded; it would report one."""
    from tests.xacro.hostile_run import CONTROL

    events = {name: found["events"] for name, found in results.items()}
    assert any(event.startswith("open ") for event in events.pop(CONTROL))
    assert {name: found for name, found in events.items() if found} == {}


@pytest.mark.slow
def test_nothing_outside_is_read(results: Results) -> None:
    """Every file that is read is named by its path in the submission; the control reads two."""
    from tests.xacro.hostile_run import CONTROL

    paths = {name: found["paths"] for name, found in results.items()}
    assert len(paths[CONTROL]) > 2
    outside = {
        name: [path for path in found if path.startswith(("/", "..", "~"))]
        for name, found in paths.items()
    }
    assert {name: found for name, found in outside.items() if found} == {}


def test_a_document_that_hides_the_limit_is_too_much_work() -> None:
    """Code that catches every exception, also that of the limit, fails at its end."""

    def endless() -> None:
        with suppress(Exception):
            while True:
                len("")

    with pytest.raises(TooMuchWork), limited_work(1_000):
        endless()


@pytest.mark.parametrize("target", ["secret.xacro", "../../secret.xacro"])
def test_a_symlink_out_of_the_submission_is_not_read(tmp_path: Path, target: str) -> None:
    """A robot includes a symlink to a file outside; nothing of that file is printed."""
    (tmp_path / "secret.xacro").write_text(part('<link name="TOPSECRET"/>'))
    urdf = tmp_path / "submission" / "urdf"
    urdf.mkdir(parents=True)
    (urdf / "secret.xacro").symlink_to(tmp_path / "secret.xacro")
    (urdf / "robot.urdf.xacro").write_text(
        robot(f'<xacro:include filename="{target}"/><link name="base_link"/>')
    )
    for command in ("grade", "inspect"):
        done = run((command, tmp_path / "submission"))
        assert b"TOPSECRET" not in done.stdout + done.stderr
