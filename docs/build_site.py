"""Build the site of the documentation: `python docs/build_site.py [FOLDER]`. A warning is an error.

The pages are written for GitHub. Here, what they link to outside of the site leads to the
repository.
"""

import re
import shutil
import sys
import tomllib
from collections.abc import Iterator
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

from sphinx.application import Sphinx
from sphinx.errors import SphinxError

ROOT = Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
REPOSITORY = PROJECT["urls"]["Repository"]
OUTSIDE = [ROOT / name for name in ("CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md")]
OFF_SITE = DOCS / "decisions.md"  # for contributors
PAGES = {page: page.name for page in [*DOCS.glob("*.md"), *OUTSIDE] if page != OFF_SITE}
PAGES[DOCS / "schemas/README.md"] = "json.md"
FOLDERS = [DOCS, DOCS / "screenshots", ROOT / "tests/corpus/reports/drawings/expected/files"]
PICTURES = {
    picture: picture.name
    for folder in FOLDERS
    for picture in folder.iterdir()
    if picture.suffix in (".svg", ".png")
}
SETTINGS = {
    "project": "grader",
    "html_title": "grader",
    "extensions": ["myst_parser"],
    "html_theme": "furo",
    "html_copy_source": False,
    "html_show_copyright": False,
    "html_show_sphinx": False,
    "highlight_language": "text",
    "myst_heading_anchors": 4,
    "nitpicky": True,
    "smartquotes": False,  # ROS 2 rejects typographic ones
    "suppress_warnings": ["misc.highlighting_failure"],  # the wrong examples are wrong
}
_SKIPPED = re.compile(r"^( *)```.*?^\1```$|`[^`\n]+`", re.DOTALL | re.MULTILINE)
_LINK = re.compile(r"(?<=\]\()(?!https?://|#)([^)#\s]+)")


def build(output: Path) -> None:
    """Build the site into a folder.

    Raises:
        sphinx.errors.SphinxError: There is a warning, such as a link without a target or a page in
        no section.
    """
    with TemporaryDirectory() as work:
        source = Path(work, "source")
        source.mkdir()
        for page, text in sources():
            (source / page).write_text(text, encoding="utf-8")
        for picture, name in PICTURES.items():
            shutil.copyfile(picture, source / name)
        folders = (str(source), None, str(output), str(Path(work, "doctrees")))
        warnings = StringIO()
        Sphinx(*folders, "html", SETTINGS, None, warnings).build()
    if warnings.getvalue():
        raise SphinxError(warnings.getvalue())


def sources() -> Iterator[tuple[str, str]]:
    """Yield the name and the text of each page of the site."""
    for page, name in PAGES.items():
        text = with_links(page, page.read_text(encoding="utf-8"))
        yield name, with_contents(text) if name == "index.md" else text


def with_links(page: Path, text: str) -> str:
    """Return the text of a page with links that work on the site."""
    pieces, end = [], 0
    for code in _SKIPPED.finditer(text):
        pieces += [_LINK.sub(lambda link: target(page, link[1]), text[end : code.start()]), code[0]]
        end = code.end()
    return "".join([*pieces, _LINK.sub(lambda link: target(page, link[1]), text[end:])])


def target(page: Path, link: str) -> str:
    """Return where a relative link of a page leads to: a page or a picture of the site, or a file
    of the repository.
    """
    path = (page.parent / link).resolve(strict=True)
    kind = "tree" if path.is_dir() else "blob"
    return {**PAGES, **PICTURES}.get(
        path
    ) or f"{REPOSITORY}/{kind}/main/{path.relative_to(ROOT).as_posix()}"


def with_contents(text: str) -> str:
    """Return the start page with its sections, and the pages that they link to, as the table of
    contents.
    """
    for section in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        pages = dict.fromkeys(re.findall(r"\]\(([\w-]+)\.md\)", section))
        lines = [
            "",
            "```{toctree}",
            ":hidden:",
            f":caption: {section.splitlines()[0]}",
            "",
            *pages,
            "```",
            "",
        ]
        text += "\n".join(lines)
    return text


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if sys.argv[1:] else ROOT / "build" / "site"
    shutil.rmtree(folder, ignore_errors=True)
    build(folder)
    print(folder / "index.html")
