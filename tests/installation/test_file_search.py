"""A search in a list of files finds what Python's own glob, pathlib and os find in a real folder."""

import glob
import os
import re
import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import assume, example, given
from hypothesis import strategies as st

from grader.files.tree import File, Tree, make_tree
from grader.ros.installation.file_search import ORDERS, PackageListing, file_functions
from grader.ros.python.interpreter import Interpreter
from grader.ros.python.library import standard_functions
from grader.ros.python.parse import Code, parse
from grader.ros.python.values import Undetermined, Unknown, Value
from tests.examples import examples, spread
from tests.work import limited_work

pytestmark = pytest.mark.slow

_NAMES = st.sampled_from(
    ["a", "b", "c", "ab", ".h", ".a", "[a]", "a*", "a.urdf", "b.urdf", "A", "a b"]
)
_PATHS = st.lists(_NAMES, min_size=1, max_size=4).map("/".join)
_PARTS = st.sampled_from(
    [
        "*",
        "**",
        "?",
        "[a-c]",
        "[!a]",
        "[a-c]*",
        "*.urdf",
        "a*",
        ".*",
        ".h",
        "a",
        "b",
        "ab",
        "[a]",
        "[[]a]",
        "[",
        "[]",
        ".",
        "..",
        "",
        "***",
        "a**",
        "*?",
        "[!.]*",
        "a.urdf",
        "[b-a]",
        "[^a]",
    ]
)
_PATTERNS = (
    st.lists(_PARTS, min_size=1, max_size=4)
    .map("/".join)
    .filter(lambda pattern: not pattern.startswith("/"))
)
_FOLDERS = st.sampled_from([".", "a", "a/b", "./a/", "b", "[a]", "c/../a", "nowhere"])


def read_nothing(limit: int, *, first: bool = False) -> bytes:
    """Return the bytes of any file of a generated file tree."""
    return b""


@st.composite
def trees(draw: st.DrawFn) -> Tree:
    """Draw a few files and folders, some of them hidden, some of them empty."""
    folders = set(draw(st.lists(_PATHS, max_size=5)))
    tree = make_tree("made", [], folders)
    files = {path for path in draw(st.lists(_PATHS, max_size=8)) if path not in tree.folders}
    files -= {
        parent
        for path in files
        for parent in make_tree("", [File(path, 0, read_nothing)], []).folders
    }
    files = {path for path in files if not any(path.startswith(other + "/") for other in files)}
    assume(not any(path.startswith(file + "/") for file in files for path in tree.folders))
    return make_tree("made", [File(path, 0, read_nothing) for path in files], folders)


def is_unusual(pattern: str) -> bool:
    """Return whether nobody writes such a pattern: its result is unknown."""
    parts = re.sub(r"//+([^/]*[*?\[][^/]*)$", r"/\1", pattern.removeprefix("./")).split("/")
    has_odd = ".." in parts or "." in parts or "" in parts[:-1]
    return has_odd or (
        "**" in parts and (parts.count("**") > 1 or any(part.startswith(".") for part in parts))
    )


@contextmanager
def on_disk(tree: Tree) -> Iterator[str]:
    """Yield a temporary folder with the files and folders of a file tree."""
    with TemporaryDirectory() as folder, warnings.catch_warnings():
        warnings.simplefilter("ignore", FutureWarning)  # of sets in brackets
        for path in sorted(tree.folders):
            os.makedirs(os.path.join(folder, path), exist_ok=True)
        for path in tree.files:
            Path(folder, path).touch()
        yield folder


def value_of(expression: str, tree: Tree, root: str = "/root", order: str = ORDERS[0]) -> Value:
    """Return the value of an expression in a file of a package with these files; assert that it is no error."""
    code = parse(
        f"import os\nfrom glob import glob\nfrom pathlib import Path\nvalue = {expression}\n".encode(),
        "setup.py",
    )
    assert isinstance(code, Code)
    interpreter = Interpreter(
        {**standard_functions(root), **file_functions(PackageListing(tree, order=order), root)}, {}
    )
    value = interpreter.run(code).names.get("value")
    if interpreter.errors:
        return interpreter.errors[0]
    return interpreter.doubt if value is None and interpreter.doubt else value


def pythons_glob(pattern: str, root: str, *, recursive: bool = True) -> list[str]:
    """Return what Python 3.12 finds; before, ** in a missing folder found that folder."""
    found = set(glob.glob(pattern, root_dir=root, recursive=recursive))
    return sorted(path for path in found if os.path.lexists(os.path.join(root, path)))


@examples(30)
@given(tree=trees(), pattern=_PATTERNS, recursive=st.booleans())
@example(tree=make_tree("", [], ["a/.h", "a/b/c"]), pattern="**", recursive=True)
@example(tree=make_tree("", [], ["a/.h", "a/b/c"]), pattern="a/**/", recursive=True)
@example(tree=make_tree("", [], ["a"]), pattern="b/**", recursive=True)
@example(tree=make_tree("", [], ["a"]), pattern="a/", recursive=False)
@example(tree=make_tree("", [], ["a/b"]), pattern="./*/b", recursive=False)
def test_glob_finds_what_pythons_glob_finds(tree: Tree, pattern: str, recursive: bool) -> None:
    """The same paths in the same spelling, for any pattern that stays inside the file tree."""
    try:
        reported = [
            PackageListing(tree, order=order).glob(pattern, recursive=recursive) for order in ORDERS
        ]
    except Undetermined:
        assert is_unusual(pattern)
        return
    with on_disk(tree) as folder:
        real = pythons_glob(pattern, folder, recursive=recursive)
    assert [sorted(found) for found in reported] == [real] * len(ORDERS)


@examples(30)
@given(tree=trees(), pattern=_PATTERNS)
@example(tree=make_tree("", [], []), pattern="**")
@example(tree=make_tree("", [], ["a"]), pattern="./**")
def test_glob_with_an_absolute_path(tree: Tree, pattern: str) -> None:
    """A pattern with an absolute path finds the file."""
    with on_disk(tree) as root:
        found = value_of(
            f"glob(os.path.join(os.getcwd(), {pattern!r}), recursive=True)", tree, root
        )
        if isinstance(found, Unknown):
            assert is_unusual(pattern)
        else:
            assert sorted(found) == pythons_glob(os.path.join(root, pattern), root)


@examples(30)
@given(tree=trees(), pattern=_PATTERNS, folder=_FOLDERS, method=st.sampled_from(["glob", "rglob"]))
@example(tree=make_tree("", [], ["a/.h", "a/b/c"]), pattern="*", folder="a", method="rglob")
@example(tree=make_tree("", [], ["a"]), pattern="**", folder=".", method="glob")
@example(tree=make_tree("", [], ["a/b"]), pattern="**/*", folder=".", method="rglob")
def test_paths_find_what_pathlib_finds(tree: Tree, pattern: str, folder: str, method: str) -> None:
    """The same paths in the same spelling, as in Python 3.12; what differs between versions is unknown."""
    assume(sys.version_info < (3, 13) or not pattern.endswith("**"))
    found = value_of(f"[str(path) for path in Path({folder!r}).{method}({pattern!r})]", tree)
    if isinstance(found, Unknown):
        parts = pattern.split("/")
        assert (
            ".." in [*parts, *folder.split("/")]
            or parts[-1] in ("", ".")
            or any("**" in p and p != "**" for p in parts)
            or is_unusual(
                "/".join(
                    part for part in ["**" * (method == "rglob"), *parts] if part not in ("", ".")
                )
            )
        )
        return
    with on_disk(tree) as root:
        real = {
            str(path.relative_to(root)) for path in getattr(Path(root, folder), method)(pattern)
        }
    assert sorted(found) == sorted(real)


@examples(30)
@given(tree=trees(), parts=st.lists(_PARTS | _NAMES, min_size=1, max_size=5))
def test_paths_are_resolved_like_the_system(tree: Tree, parts: list[str]) -> None:
    """Dots, slashes and files used as folders mean what they mean to the system."""
    path = "/".join(parts).lstrip("/")
    reported = [
        value_of(f"os.path.{function}({path!r})", tree)
        for function in ("exists", "isfile", "isdir")
    ]
    with on_disk(tree) as root:
        inside = os.path.join(root, "")
        real = [
            getattr(os.path, function)(inside + path if path else "")
            for function in ("exists", "isfile", "isdir")
        ]
    if any(isinstance(path, Unknown) for path in reported):
        assert not path or ".." in parts or any(part.startswith(".") for part in parts)
    else:
        assert reported == real


@examples(20)
@given(tree=trees(), folder=_FOLDERS)
def test_listing_folders(tree: Tree, folder: str) -> None:
    """os.listdir, os.walk and iterdir name the entries; a missing folder is an error, or has nothing to walk through."""
    expressions = (
        f"os.listdir({folder!r})",
        f"[str(path) for path in Path({folder!r}).iterdir()]",
        f"[os.path.join(path, name) for path, _, names in os.walk({folder!r}) for name in names]",
        f"[os.path.join(path, name) for path, names, _ in os.walk({folder!r}) for name in names]",
    )
    with on_disk(tree) as root:
        second = os.path.join(root, folder)
        is_folder = os.path.isdir(second)
        names = os.listdir(second) if is_folder else []
        walked = list(os.walk(second))
    for order in ORDERS:
        reported = [value_of(expression, tree, order=order) for expression in expressions]
        if is_folder:
            assert sorted(reported[0]) == sorted(names)
            assert sorted(reported[1]) == sorted(str(Path(folder) / name) for name in names)
        else:
            assert not isinstance(reported[0], list)
            assert not isinstance(reported[1], list)
        for found, index in ((reported[2], 2), (reported[3], 1)):
            real = [os.path.join(step[0], name) for step in walked for name in step[index]]
            assert sorted(os.path.normpath(path) for path in found) == sorted(
                os.path.relpath(path, root) for path in real
            )


@pytest.mark.parametrize(
    "pattern", ["/etc/*", "../*", "a/../../*", "*" * 5000, "**/../" * 20 + "*"]
)
def test_patterns_that_lead_out_are_unknown(pattern: str) -> None:
    """A pattern that leads out of the file tree, or that nobody writes, is unknown."""
    with pytest.raises(Undetermined):
        PackageListing(make_tree("", [], ["a/b/c", "a/d", "b/c"])).glob(pattern, recursive=True)


@pytest.mark.parametrize(
    "expression",
    spread(
        [
            "[glob(f'**/**/**/*{n}*', recursive=True) for n in range(10000)]",
            "[glob('*/../' * 12 + '*') for n in range(10000)]",
            "[list(Path('.').rglob(f'**/**/*{n}')) for n in range(10000)]",
            "[list(os.walk('.')) for n in range(10000)]",
            "[os.listdir('f0') for n in range(10000)]",
            "glob('f*' + '[a-z0-9]*?' * 90 + 'x')",
        ],
        2,
    ),
)
def test_many_searches_through_many_files_end_soon(expression: str) -> None:
    """The evaluation of a submission of thousands of files with repeated searches is bounded."""
    files = [File(f"f{n % 10}/{'g/' * (n % 20)}h{n}", 0, read_nothing) for n in range(4000)]
    tree = make_tree("", files, [])
    with limited_work(200_000_000):
        code = parse(
            f"import os\nfrom glob import glob\nfrom pathlib import Path\nvalue = {expression}\n".encode(),
            "setup.py",
        )
        assert isinstance(code, Code)
        Interpreter(
            {**standard_functions("/root"), **file_functions(PackageListing(tree), "/root")}, {}
        ).run(code)
