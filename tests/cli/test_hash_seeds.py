"""A report does not depend on Python's hash seed: what differs between runs of Python is undetermined, never a value."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.command_line import HANG_TIMEOUT, clean_environment, run, run_process
from tests.samples import ROOT, SAMPLES

SEEDS = 2
HINT_STEP = 8  # the hints of every eighth sample are searched

PACKAGE = ROOT / "rubrics/lab6/my_robot"
GREEN = "0 0.6 0 1"
NAMESPACE = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
SET = f"python.set(['{GREEN}', '1 0 0 1'])"


@pytest.mark.slow
def test_reports_are_the_same_with_every_hash_seed(tmp_path: Path) -> None:
    """A package whose files use the order of sets, and refuse values with them, has one report, also in other zones and locales."""
    folder = tmp_path / "my_robot"
    shutil.copytree(PACKAGE, folder)
    for name, old, new in (
        ("urdf/my_robot.urdf", GREEN, f"${{sorted({SET})[0]}}"),
        ("urdf/my_robot.urdf", "<robot ", f"<robot {NAMESPACE} "),
        ("urdf/my_robot.urdf", "</robot>", f'<link name="${{xacro.fatal({SET})}}"/></robot>'),
        ("setup.py", "from setuptools", "names = list({'urdf/*', 'rviz/*'})[:1]\nfrom setuptools"),
        ("setup.py", "glob('urdf/*')", "glob(names[0])"),
        (
            "launch/my_robot_rviz.launch.py",
            "share, 'my_robot.rviz'",
            "share, list({'my_robot.rviz', 'other.rviz'})[0]",
        ),
    ):
        path = folder / name
        assert old in path.read_text()
        path.write_text(path.read_text().replace(old, new))
    saved = {}
    for seed, zone, locale in (("1", "UTC", "C"), ("2", "Asia/Tokyo", "C.UTF-8")):
        files = [tmp_path / f"{seed}.{kind}" for kind in ("html", "svg")]
        words = (
            "grade",
            str(folder),
            "--format=json",
            *(f"--save={file.suffix[1:]}={file}" for file in files),
        )
        done = run_process(words, variables={"PYTHONHASHSEED": seed, "TZ": zone, "LANG": locale})
        saved[seed] = (done.stdout, *(file.read_bytes() for file in files))
    assert saved["1"] == saved["2"]
    assert saved["1"][0] == run(("grade", folder, "--format", "json")).stdout
    statuses = {row["id"]: row["status"] for row in json.loads(saved["1"][0])["results"]}
    assert [
        statuses[name] for name in ("base-green", "setup-installs-urdf", "launch-finds-files")
    ] == ["pending"] * 3


@pytest.mark.exhaustive
def test_every_sample_has_one_report_over_two_hash_seeds() -> None:
    """All samples are graded with each seed, in one process; hints take longer, and are searched for some."""
    digests: dict[str, list[str]] = {}
    for seed in range(SEEDS):
        words = [sys.executable, "-m", "tests.report_digests", str(HINT_STEP)]
        environment = {**clean_environment(), "PYTHONHASHSEED": str(seed)}
        done = subprocess.run(
            words, cwd=ROOT, env=environment, capture_output=True, check=True, timeout=HANG_TIMEOUT
        )
        for line in done.stdout.decode().splitlines():
            name, _, digest = line.rpartition(" ")
            digests.setdefault(name, []).append(digest)
    assert {len(found) for found in digests.values()} == {SEEDS}
    assert digests.keys() > set(SAMPLES)
    assert [name for name, found in digests.items() if len({*found}) > 1] == []
