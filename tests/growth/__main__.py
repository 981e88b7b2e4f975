"""Search texts of two sizes with each pattern that the grader compiles while the corpus runs; fail where the time grows too fast.

The one stage of CI that looks at times: each is the shortest of several, and only what is slow at all counts.
"""

import importlib
import pkgutil
import re
import signal
import sys
from collections import defaultdict
from collections.abc import Iterator
from math import log
from multiprocessing import get_context
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

from tests.growth.pumped import pumped

FACTOR = 4  # how many times as long the next text is
SIZES = tuple(60 * FACTOR**step for step in range(5))  # letters
LIMIT = 1.4  # the power of the length with which the time may grow
SLOW, ENOUGH = 0.004, 0.5  # seconds: what takes less is never slow; no longer text is tried
LONGEST = 10.0  # seconds after which a use is ended
REPEATS = 3

METHODS = {
    "match": "match",
    "fullmatch": "fullmatch",
    **dict.fromkeys(("search", "finditer", "findall", "sub", "subn", "split", "scanner"), "search"),
}

# Patterns that may be slow, by their module and how they begin: why their texts are never long.
BOUNDED = {
    ("base.toml_file", r"\{[^}]*"): "_MAX_WIDTH letters on each side of a mistake",
    ("report.pages.shell", ""): "scripts and styles of our own",
    ("report.written_files", ""): "_MAX_START bytes",
    ("ros.installation.manifest_conditions", r"(\$[A-Z"): "_MAX_LENGTH",
    ("ros.package.trees", ""): "paths of entries in a rubric",
    ("ros.python.parse", r"\b[rR]?[fF][rR]?"): "_MAX_SEARCHED characters of a line",
    ("ros.python.python_slips", "((?:[^#"): "_MAX_LENGTH of a line",
    ("ros.xacro.rewriting", ""): "_MAX_LENGTH of a text",
    ("ros.xml.repair", "<!--"): "what was read before, between two tags",
}

_Key = tuple[str | bytes, int]


class _Recorded:
    """A pattern that remembers how it is used."""

    def __init__(self, pattern: "re.Pattern[Any]", module: str) -> None:
        self.compiled, self.module = pattern, module
        self.uses: set[str] = set()

    def __getattr__(self, name: str) -> Any:
        method = getattr(self.compiled, name)
        if name not in METHODS:
            return method

        def call(*arguments: Any, **options: Any) -> Any:
            self.uses.add(METHODS[name])
            return method(*arguments, **options)

        return call


def recorded() -> dict[_Key, _Recorded]:
    """Return the patterns that the grader compiles and uses while it is imported and the corpus runs."""
    known: dict[_Key, _Recorded] = {}
    functions = {name: getattr(re, name) for name in ("compile", *METHODS) if hasattr(re, name)}

    def recorder(name: str) -> Any:
        def call(pattern: Any, *arguments: Any, **options: Any) -> Any:
            module = sys._getframe(1).f_globals["__name__"]
            if isinstance(pattern, _Recorded):
                pattern = pattern.compiled
            if module.partition(".")[0] == "grader":
                flags = options.get("flags", 0) if name != "compile" else [*arguments, 0][0]
                made = functions["compile"](pattern, flags)
                row = known.setdefault((made.pattern, made.flags), _Recorded(made, module))
                if name == "compile":
                    return row
                row.uses.add(METHODS[name])
            return functions[name](pattern, *arguments, **options)

        return call

    for name in functions:
        setattr(re, name, recorder(name))
    try:
        import grader
        from grader.base import patterns

        patterns.on_use = recorder("compile")  # before the modules take it
        for module in pkgutil.walk_packages(grader.__path__, "grader."):
            if "on_gradescope" not in module.name and not module.name.endswith("__main__"):
                importlib.import_module(module.name)
        from tests.corpus.cases import read_corpus

        for case in read_corpus():
            with TemporaryDirectory() as folder:
                case.outcome(Path(folder))
        _add_written_uses()
    finally:
        for name, function in functions.items():
            setattr(re, name, function)
    return known


def _add_written_uses() -> None:
    """Add to patterns that have names in modules how the code uses them, which the corpus may not do."""
    for name, module in [*sys.modules.items()]:
        if name.partition(".")[0] != "grader" or not module.__file__:
            continue
        code = Path(module.__file__).read_text()
        uses = defaultdict[str, set[str]](set)
        for constant, method in re.findall(rf"\b([A-Z_]{{2,}})\.({'|'.join(METHODS)})\b", code):
            uses[constant].add(METHODS[method])
        for constant, value in vars(module).items():
            if isinstance(value, _Recorded):
                value.uses |= uses[constant]


_ROWS: list[tuple[_Key, _Recorded]] = []


def slow_texts(pattern: _Recorded) -> Iterator[tuple[float, float, str]]:
    """Yield the power with which the time of a use grows, the time of the longest text in seconds, and how the text begins."""
    for texts in zip(*(pumped(pattern.compiled, size) for size in SIZES), strict=True):
        for use in sorted(pattern.uses or {"search"}):
            power = _power(pattern.compiled, use, texts)
            if power is not None:
                yield (*power, texts[0][:60])


def _power(
    pattern: "re.Pattern[Any]", use: str, texts: tuple[str, ...]
) -> tuple[float, float] | None:
    """Return the power with which the time grows at the longest text that is tried, and its time, if the power is too large.

    Below that length a pattern with `.{0,600}` grows with the square, until its bound is reached.
    """
    before = power = seconds = 0.0
    for text in texts:
        data = text.encode("latin-1", "replace") if isinstance(pattern.pattern, bytes) else text
        seconds = _time(pattern, use, data)
        if seconds >= SLOW:
            seconds = min(seconds, *(_time(pattern, use, data) for _ in range(REPEATS)))
        power = log(max(seconds, 1e-6) / max(before, 1e-6)) / log(FACTOR)
        if seconds > ENOUGH:
            break
        before = seconds
    return (power, seconds) if seconds >= SLOW and power > LIMIT else None


def _time(pattern: "re.Pattern[Any]", use: str, text: Any) -> float:
    """Return the processor time of a use in seconds, which is ended at the limit."""
    signal.setitimer(signal.ITIMER_REAL, LONGEST)
    start = process_time()
    try:
        if use == "search":
            for _ in pattern.finditer(text):
                pass
        else:
            getattr(pattern, use)(text)
    except TimeoutError:
        pass
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
    return process_time() - start


def _end(*_: object) -> None:
    raise TimeoutError


def _worst(number: int) -> str:
    """Return what to say of a pattern that is too slow, else nothing."""
    (source, _), pattern = _ROWS[number]
    if any(
        pattern.module == f"grader.{name}" and str(source).startswith(start)
        for name, start in BOUNDED
    ):
        return ""
    worst = max(slow_texts(pattern), default=None)
    if worst is None:
        return ""
    power, seconds, text = worst
    uses = "/".join(sorted(pattern.uses)) or "no use seen"
    return (
        f"{pattern.module} ({uses}): {source!r:.160} grows with power {power:.1f} "
        f"({seconds:.2f} s): {text!r}\n"
    )


def main() -> int:
    """Print the patterns that are too slow, the worst text of each, and return whether there is one."""
    known = recorded()
    signal.signal(signal.SIGALRM, _end)
    print(f"{len(known)} patterns")
    assert any(slow_texts(_Recorded(re.compile("a*b"), ""))), "nothing is slow"
    _ROWS.extend(sorted(known.items(), key=lambda row: (row[1].module, str(row[0]))))
    with get_context(
        "fork"
    ).Pool() as pool:  # which inherits the rows: patterns that are recorded cannot be sent
        said = pool.map(_worst, range(len(_ROWS)), chunksize=20)
    # What seems slow is measured again, alone: beside other work one measurement may be too long.
    again = [_worst(number) for number, text in enumerate(said) if text]
    print("".join(again), end="")
    return int(any(again))


if __name__ == "__main__":
    sys.exit(main())
