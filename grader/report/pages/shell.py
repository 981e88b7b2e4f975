"""The common parts of all pages.

These are templates that escape all text, one file without requests, and a policy.
"""

import hashlib
import json
import re
from base64 import b64encode
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from grader.base.patterns import on_use
from grader.base.text import printable

_FILES = Path(__file__).parent / "files"  # templates, styles and scripts of several pages
# The scripts of a page with `robot.html` and the data of a robot, each after those that it needs.
SPACE_SCRIPTS = "transforms.js kinematics.js shapes.js ghost.js drive.js robot3d.js"
_NOTHING = "'none'"
_STRICT = '"use strict";'  # at the beginning of each script, and of all together
# A literal of JavaScript: a text, which keeps what looks like a comment, or a regular expression,
# which stands where a value begins.
_LITERAL = r"""(?P<literal>
    "(?:\\.|[^"\\\n])*" | '(?:\\.|[^'\\\n])*'
    | `(?:\\. | \$\{(?:[^`{}]|`[^`]*`)*\} | [^`\\])*`
    | (?<=[(,=:!&|?\[]) \s* /(?![*/])(?:\\. | \[(?:\\.|[^\]\\\n])*\] | [^/\[\\\n])+/
)"""
_COMMENTS = on_use(rf"{_LITERAL} | /\*.*?\*/ | //[^\n]*", re.DOTALL | re.VERBOSE)
# White space beside punctuation and operators; a line may end a statement after a bracket, or
# before one.
_SPACES = on_use(
    rf"{_LITERAL} | \s+(?=[)\]}},;?:&|=>*]) | [ ]+(?=[(\[{{])"
    r"| (?<=[{(\[,;=>?:&|*])\s+ | (?<=[)\]}])[ ]+ | (?P<end>\s*\n\s*)"
    r"| (?<![-+])[ ](?=[-+/<%!]=*[ ]) | (?<=[-+/<%])[ ](?![-+/!])",
    re.VERBOSE,
)
_LITERAL_OF_STYLES = r"""(?P<literal> "(?:\\.|[^"\\])*" | '(?:\\.|[^'\\])*' )"""
# A colon after white space begins a pseudo-class of any element.
_SPACES_OF_STYLES = on_use(
    rf"{_LITERAL_OF_STYLES} | /\*.*?\*/ | \s+(?=[{{}},;>]) | (?<=[{{}},;:>])\s+ | (?P<space>\s+)",
    re.DOTALL | re.VERBOSE,
)
_UNSAFE = str.maketrans({character: f"\\u{ord(character):04x}" for character in "<>&\u2028\u2029"})


class Assets(NamedTuple):
    """The styles and scripts of a page."""

    styles: str = ""  # besides base.css; names between spaces
    scripts: str = ""  # names between spaces
    rules: str = ""  # more CSS rules, from the grader only
    sources: str = ""  # directives for the policy of a page that is served: "img-src 'self'"
    folder: Path = _FILES  # the templates, styles and scripts, besides those of all pages


def render_page(
    template: str, values: Mapping[str, object], data: Mapping[str, Any], assets: Assets
) -> str:
    """Return a page as one HTML file.

    Args:
        template: The name of the template. It extends base.html and gets the `values`. Text is
            escaped and printable.
        values: The values of the template; markup only as `Markup`.
        data: The data of the script, as JSON:
            `JSON.parse(document.getElementById("data").textContent)`.
        assets: The styles and scripts.
    """
    styles = [_style(assets.folder, name) for name in ("base.css", *assets.styles.split())]
    style = "".join([*styles, assets.rules])
    script = "".join(_script(assets.folder, name) for name in assets.scripts.split())
    if script:
        script = _STRICT + script
    policy = [
        f"default-src {_NOTHING}",
        f"style-src {_source_hash(style)}",
        f"script-src {_source_hash(script) if script else _NOTHING}",
        f"base-uri {_NOTHING}",
        f"form-action {_NOTHING}",
    ]
    if assets.sources:
        policy.append(assets.sources)
    shell = {
        "policy": "; ".join(policy),
        "style": Markup(style),  # noqa: S704  our own files
        "script": Markup(script),  # noqa: S704
        "data": _json(data),
    }
    return _environment(assets.folder).get_template(template).render(**values, **shell)


@cache
def _environment(folder: Path) -> Environment:
    return Environment(
        loader=FileSystemLoader([folder, _FILES]),
        autoescape=True,
        undefined=StrictUndefined,
        finalize=_printable,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )


def _printable(value: object) -> object:
    """Return a text in one line, without control characters."""
    if isinstance(value, str) and not isinstance(value, Markup):
        return printable(value)
    return value


@cache
def _file(folder: Path, name: str) -> str:
    path = folder / name
    return (path if path.exists() else _FILES / name).read_text(encoding="utf-8")


@cache
def _style(folder: Path, name: str) -> str:
    return shortened_style(_file(folder, name))


@cache
def _script(folder: Path, name: str) -> str:
    return shortened(_file(folder, name)).removeprefix(_STRICT)


def shortened(script: str) -> str:
    """Return a script as pages have it.

    It has no comments, and no indentation and spaces beside punctuation.

    Literals keep each character. Statements end with a semicolon or a brace, as prettier writes
    them.
    """
    code = _COMMENTS.sub(lambda match: match["literal"] or "", script)
    return _SPACES.sub(_shortened_space, code).strip() + "\n"


def shortened_style(style: str) -> str:
    """Return a style without comments, indentation and spaces beside punctuation, as pages have it.

    Literals keep each character.
    """
    short = _SPACES_OF_STYLES.sub(
        lambda match: match["literal"] or (" " if match["space"] else ""), style
    )
    return short.strip().replace(";}", "}")


def _shortened_space(match: re.Match[str]) -> str:
    if match["end"] is not None:
        return "\n"
    return match["literal"] or ""


def _source_hash(text: str) -> str:
    """Return the source expression that allows one inline script or style."""
    return f"'sha256-{b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def _json(data: Mapping[str, Any]) -> Markup:
    """Return JSON that cannot close its script element.

    Raises ValueError for NaN, which is no JSON.
    """
    text = json.dumps(data, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return Markup(text.translate(_UNSAFE))  # noqa: S704  no character of it is markup
