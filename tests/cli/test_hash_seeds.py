"""A report does not depend on Python's hash seed: what differs between runs of Python is undetermined, never a value."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT, clean_environment, run
from tests.samples import ROOT, SAMPLES

SEEDS = 20
HINT_GROUPS = 7  # of samples; with each seed the hints of one are searched

PACKAGE = ROOT / "rubrics/lab6/my_robot"
GREEN = "0 0.6 0 1"
NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
SET = f"python.set(['{GREEN}', '1 0 0 1'])"
UNORDERED = {
    "the order of a set differs between runs": (
        f"python.list({SET})[0]",
        f"[colour for colour in {SET}][0]",
        f"[*{SET}][0]",
        f"' '.join({SET})[:9]",
        f"min({SET}, key=len)",
        f"dict([(1, colour) for colour in {SET}])[1]",
        f"python.list(python.zip({SET}, [1]))[0][0]",
        f"(lambda a, b: a)(*{SET})",
        f"dict(**python.set([('a', '{GREEN}'), ('a', '1 0 0 1')]))['a']",
    ),
    "the text of this value differs between runs": (
        f"str({SET})[2:11]",
        f"str([{SET}])[3:12]",
        f"('%s' % {SET})[2:11]",
        f"python.repr({SET})[2:11]",
        "str([len])",
        "str([python.enumerate([])])",
        "'%s' % [len]",
    ),
}
ORDERED = (
    f"sorted({SET})[0]",
    f"min({SET})",
    f"'{GREEN}' if '{GREEN}' in {SET} else ''",
    f"python.list({SET}.intersection(['{GREEN}']))[0]",
)


def robot(expression: str, text: str = "") -> str:
    """Return the reference as xacro, whose green is an expression."""
    reference = (PACKAGE / "urdf/my_robot.urdf").read_text()
    assert reference.count(GREEN) == 1
    return (
        reference.replace(GREEN, f"${{{expression}}}")
        .replace("<robot ", f"<robot {NAMESPACE} ")
        .replace("</robot>", text + "</robot>")
    )


def graded(path: Path, **variables: str) -> tuple[bytes, int, float, dict[str, str]]:
    """Return the report on a submission, the exit code, the score, and each criterion's status."""
    done = run(("grade", path, "--format", "json"), **variables)
    report = json.loads(done.stdout)
    return (
        done.stdout,
        done.returncode,
        report["score"],
        {result["id"]: result["status"] for result in report["results"]},
    )


@pytest.mark.parametrize(
    ("reason", "expression"), [(reason, expression) for reason, group in UNORDERED.items() for expression in group]
)
def test_what_differs_between_runs_needs_manual_grading(reason: str, expression: str, tmp_path: Path) -> None:
    """An expression whose value depends on the order of a set or on an address has no value."""
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(robot(expression))
    report, code, score, statuses = graded(path)
    assert (code, score, statuses["base-green"]) == (1, 61, "pending")
    assert reason in report.decode()


@pytest.mark.parametrize("expression", ORDERED)
def test_a_use_of_a_set_that_does_not_depend_on_its_order_has_a_value(expression: str, tmp_path: Path) -> None:
    """The least item of a set, its members and a set of one item are the same in every run."""
    path = tmp_path / "my_robot.urdf.xacro"
    path.write_text(robot(expression))
    assert graded(path)[1:3] == (0, 70)


@pytest.mark.slow
def test_reports_are_the_same_with_every_hash_seed(tmp_path: Path) -> None:
    """A package whose URDF, setup.py and launch file use the order of sets, and refuse values with them, has one report."""
    folder = tmp_path / "my_robot"
    shutil.copytree(PACKAGE, folder)
    refused = "".join(
        f'<xacro:property name="p{number}" value="${{{expression}}}"/><link name="l{number}" x="${{p{number}}}"/>'
        for number, expression in enumerate(
            (
                f"[].index({SET})",
                f"dict()[python.frozenset({SET})]",
                f"xacro.fatal({SET})",
                "[].index(len)",
                "sorted(python.set(['a', 1]))",
            )
        )
    )
    (folder / "urdf/my_robot.urdf").write_text(robot(UNORDERED["the order of a set differs between runs"][0], refused))
    for name, old, new in (
        ("setup.py", "from setuptools", "names = list({'urdf/*', 'rviz/*'})[:1]\nfrom setuptools"),
        ("setup.py", "glob('urdf/*')", "glob(names[0])"),
        ("launch/my_robot_rviz.launch.py", "share, 'my_robot.rviz'", "share, list({'my_robot.rviz', 'other.rviz'})[0]"),
    ):
        path = folder / name
        assert old in path.read_text()
        path.write_text(path.read_text().replace(old, new))
    reports = {graded(folder, PYTHONHASHSEED=seed)[0] for seed in "012"}
    assert len(reports) == 1
    statuses = graded(folder)[3]
    assert [statuses[name] for name in ("base-green", "setup-installs-urdf", "launch-finds-files")] == ["pending"] * 3


@pytest.mark.slow
def test_every_sample_has_one_report_over_twenty_hash_seeds() -> None:
    """All samples are graded with each seed, in one process; hints, which take longer, are searched with two or three seeds."""
    digests: dict[str, list[str]] = {}
    for seed in range(SEEDS):
        words = [sys.executable, "-m", "tests.report_digests", str(seed % HINT_GROUPS), str(HINT_GROUPS)]
        environment = {**clean_environment(), "PYTHONHASHSEED": str(seed)}
        done = subprocess.run(words, cwd=ROOT, env=environment, capture_output=True, check=True, timeout=HANG_TIMEOUT)
        for line in done.stdout.decode().splitlines():
            name, _, digest = line.rpartition(" ")
            digests.setdefault(name, []).append(digest)
    assert {len(digests[name]) for name in SAMPLES} == {SEEDS}
    assert {len(found) for name, found in digests.items() if name not in SAMPLES} == {2, 3}
    assert [name for name, found in digests.items() if len({*found}) > 1] == []
