"""The student's page in Firefox has no error."""

from pathlib import Path

import pytest

from tests.browser.firefox import Firefox
from tests.command_line import run
from tests.samples import SAMPLES

pytestmark = pytest.mark.exhaustive


def test_page_has_no_error(firefox: Firefox, tmp_path: Path) -> None:
    """Its styles and script keep to its own policy, and the three views are there."""
    file = tmp_path / "page.html"
    file.write_bytes(run(("grade", SAMPLES["several-mistakes"].path, "--format", "html")).stdout)
    firefox("WebDriver:Navigate", url=file.as_uri())
    assert [one for one in firefox.messages() if "page.html" in one] == []
    assert firefox.run("return document.querySelector('.views svg').getBoundingClientRect().width") > 300
