"""The golden cases, run through the real command line."""

from pathlib import Path

import pytest

from tests.command_line import run, run_process
from tests.golden.cases import GOLDEN, Golden


@pytest.mark.parametrize("case", GOLDEN, ids=lambda case: case.name)
def test_output_is_unchanged(case: Golden) -> None:
    """Output and exit code are the approved ones; standard error is empty."""
    done = run(case.arguments, **case.variables)
    assert done.stdout.decode() == case.file.read_text(encoding="utf-8")
    assert (done.returncode, done.stderr) == (case.exit_code, b"")


def test_output_is_deterministic(tmp_path: Path) -> None:
    """Hash seeds, time zones and locales change nothing, and the process prints what it prints here."""
    kinds = ("json", "html", "svg")
    words = ["grade", "submissions/several-mistakes/my_robot.urdf"]
    found = []
    for seed, zone, locale in (("1", "UTC", "C"), ("2", "Asia/Tokyo", "C.UTF-8")):
        saves = [f"--save={kind}={tmp_path / seed}.{kind}" for kind in kinds]
        done = run_process([*words, *saves], variables={"PYTHONHASHSEED": seed, "TZ": zone, "LANG": locale})
        found.append((done.stdout, *((tmp_path / f"{seed}.{kind}").read_bytes() for kind in kinds)))
    assert found[0] == found[1]
    assert found[0][0] == run(words).stdout
