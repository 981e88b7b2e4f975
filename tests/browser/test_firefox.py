"""The student's page in Firefox: it has no error, its controls work, and the robot is there without WebGL, too."""

import re
from pathlib import Path

import pytest

from tests.browser.firefox import Firefox
from tests.command_line import run
from tests.samples import SAMPLES

pytestmark = pytest.mark.exhaustive
# Firefox needs a display for WebGL. This context has every function, and draws nothing.
WITHOUT_DISPLAY = """<script>
const gl = new Proxy({}, { get: (_, name) => (/^[A-Z]/.test(name) ? 1 : /AttribLocation/.test(name) ? () => 0 : () => ({})) });
HTMLCanvasElement.prototype.getContext = () => gl;
</script>"""


@pytest.fixture(scope="module")
def page() -> str:
    """Return the page of a robot with several mistakes."""
    return run(("grade", SAMPLES["several-mistakes"].path, "--format", "html")).stdout.decode()


def opened(firefox: Firefox, file: Path, text: str) -> None:
    file.write_text(text, encoding="utf-8")
    firefox("WebDriver:Navigate", url=file.as_uri())


def test_page_has_no_error(firefox: Firefox, page: str, tmp_path: Path) -> None:
    """Its styles and scripts keep to its own policy; the three views are there, and a missing WebGL is said."""
    opened(firefox, tmp_path / "page.html", page)
    assert [one for one in firefox.messages() if "page.html" in one and "WebGL" not in one] == []
    assert firefox.run("return document.querySelector('.views svg').getBoundingClientRect().width") > 300
    shown = firefox.run(
        "return ['stage', 'no-webgl'].map((name) => !document.querySelector(`[data-part=${name}]`).hidden)"
    )
    assert shown in ([True, False], [False, True])


def test_controls_of_the_robot_work(firefox: Firefox, page: str, tmp_path: Path) -> None:
    """A slider moves its joint, `Reference` has no numbers of the submission, and no two labels overlap."""
    text = re.sub('<meta http-equiv="Content-Security-Policy"[^>]*>', "", page).replace(
        "<head>", f"<head>{WITHOUT_DISPLAY}"
    )
    opened(firefox, tmp_path / "drawn.html", text)
    counts = []
    for name in ("submission", "reference", "both"):
        firefox.run(f"document.querySelector('[data-mode={name}]').click()")
        firefox(
            "WebDriver:ExecuteAsyncScript", script="requestAnimationFrame(() => arguments[0]())", args=[], sandbox=None
        )
        counts.append(firefox.run("return document.querySelectorAll('.labels .callout:not([hidden])').length"))
    assert counts == [4, 0, 4]
    moved = firefox.run(
        "const slider = document.querySelector('input[type=range]'); slider.value = 90;"
        "slider.dispatchEvent(new Event('input')); return slider.parentElement.querySelector('output').textContent"
    )
    assert moved == "90 \u00b0"
    assert [one for one in firefox.messages() if "drawn.html" in one] == []
