"""Write what the cases print now, and show what changed: `python -m tests.corpus [TEXT IN THE NAME]`."""

import re
import shutil
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.corpus.cases import Case, Expected, changed_lines, read_corpus

_GENERATED = re.compile(r"^(?:exit|stdout|stderr|written) = ", re.MULTILINE)
_ROW = "[[case]]\n"


def write(case: Case, found: Expected) -> None:
    """Replace what is expected: the files in the folder, or the last keys of the row."""
    if case.path.is_dir():
        shutil.rmtree(case.path / "expected", ignore_errors=True)
        for name, text in found.items():
            (case.path / "expected" / name).parent.mkdir(parents=True, exist_ok=True)
            (case.path / "expected" / name).write_bytes(text.encode())
        return
    head, *rows = case.path.read_text(encoding="utf-8").split(_ROW)
    given = _GENERATED.split(rows[case.index])[0].rstrip("\n")
    rows[case.index] = f"{given}\n{''.join(_generated(found))}" + "\n" * (
        case.index < len(rows) - 1
    )
    case.path.write_text(_ROW.join((head, *rows)), encoding="utf-8")


def _generated(found: Expected) -> Iterator[str]:
    """Yield the lines of a row that hold what is expected."""
    for key, text in found.items():
        if not key.startswith("files/"):
            yield f"{key} = {text if text.isdigit() and key == 'exit' else _quoted(text)}\n"
    written = [
        f"{_basic(key[6:])} = {_quoted(text)}"
        for key, text in found.items()
        if key.startswith("files/")
    ]
    if written:
        yield f"written = {{ {', '.join(written)} }}\n"


def _quoted(text: str) -> str:
    """Return a text as a value of TOML: lines as they are, and with escapes if they have control characters or ''' ."""
    if "\n" not in text:
        return _basic(text)
    if "'''" not in text and not re.search(r"[^\n\t -~\u00a0-\uffff]", text):
        return f"'''\n{text}'''"
    return '"""\n' + "\n".join(_basic(line)[1:-1] for line in text.split("\n")) + '"""'


def _basic(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"').replace("\r", "\\r")
    return (
        '"'
        + re.sub(r"[\x00-\x1f\x7f-\x9f]", lambda match: f"\\u{ord(match[0]):04x}", escaped)
        + '"'
    )


if __name__ == "__main__":
    for case in [one for one in read_corpus() if "".join(sys.argv[1:]) in one.name]:
        with TemporaryDirectory() as folder:
            found = case.outcome(Path(folder).resolve())
        if found != case.expected:
            print(f"== {case.name}", *changed_lines(case.expected, found), sep="\n")
            write(case, found)
