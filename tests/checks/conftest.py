"""What the checks find in the tests of this folder is approved: each wording once, with all its data.

`python tests/golden/update.py` runs the tests with `--approve`, which approves what they find now.
"""

from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.checks.outcomes import FOUND, wording

_GOLDEN = Path(__file__).parent.parent / "golden"
_FILE = _GOLDEN / "outcomes-of-tests.txt"
_APPROVED: dict[str, list[str]] = {}
for line in _FILE.read_text(encoding="utf-8").splitlines():
    _APPROVED.setdefault(line.partition(" | ")[0], []).append(line.partition(" | ")[2])
_NEW: dict[str, str] = {}
_MAX_LENGTH = 1000
_OF_PYTHON = "Python cannot read"  # what follows differs between its versions


@pytest.fixture(autouse=True)
def approved(request: pytest.FixtureRequest) -> Iterator[None]:
    """Compare what the checks found in a test with what is approved, but for examples that another version may not find."""
    FOUND.clear()
    yield
    name = request.node.nodeid.removeprefix("tests/checks/")
    if not request.config.getoption("--approve", default=False):
        assert [row for row in _APPROVED.get(name, ()) if row not in FOUND.values()] == []
    elif not hasattr(request.function, "hypothesis"):
        for key, row in FOUND.items():
            _NEW.setdefault(key, f"{name} | {row}")


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add --approve."""
    parser.addoption("--approve", action="store_true", help="approve what the checks find in their tests")


def pytest_sessionfinish(session: pytest.Session) -> None:
    """Write what fails or cannot be decided, and is not in the cases or samples."""
    if session.config.getoption("--approve", default=False):
        texts = [(_GOLDEN / f"outcomes-of-{name}.txt").read_text(encoding="utf-8") for name in ("cases", "samples")]
        known = {wording(row) for text in texts for row in text.splitlines()}
        new = [row for row in _NEW.values() if wording(row) not in known and len(row) < _MAX_LENGTH]
        rows = [row for row in new if (": status passed; " not in row or "; measured" in row) and _OF_PYTHON not in row]
        _FILE.write_text("".join(f"{row}\n" for row in sorted(rows)), encoding="utf-8")
