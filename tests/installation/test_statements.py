"""Whatever statement is put at any place into a setup.py, nothing is stated that Python does not do."""

import json
from collections.abc import Iterator
from pathlib import Path
from random import Random

import pytest

from grader.files.folder import read_folder
from grader.ros.installation.installation import Installation
from grader.ros.installation.setup_py import read_setup
from tests.installation.my_robot import write_package
from tests.oracles.python_setups import Ran, run_all

_HEAD = "import os\nfrom glob import glob\nfrom pathlib import Path\nfrom setuptools import find_packages, setup\nname = 'my_robot'\n"
_LIST = "data_files = [\n    ('share/my_robot', ['package.xml']),\n    (os.path.join('share', name), glob('urdf/*')),\n    ('share/my_robot/launch', {launch}),\n]\n"
_CALL = "setup(name=name, version='0.1.0', packages=find_packages(), data_files=data_files)\n"
_BLOCKS = (
    "{}",
    "def work(data_files):\n    for path in data_files[:1]:\n        {}\n    return data_files\ndata_files = work(data_files)",
    "if data_files:\n    {}",
    "for number in range(2):\n    {}",
    "try:\n    {}\nexcept Exception:\n    data_files = data_files[:1]",
    "try:\n    {}\nfinally:\n    number = 1",
    "try:\n    {}\nexcept (FileNotFoundError, KeyError):\n    data_files = data_files[:1]\nexcept NameError:\n    pass",
    "class A:\n    {}",
    "def wrap(function):\n    {}\n    return function\n@wrap\ndef work():\n    pass",
    "with open('setup.cfg') as file:\n    {}",
    "while True:\n    {}\n    break",
    "more = [({}) for _ in 'ab']",
    "more = lambda: ({})\nmore()",
    "more = sorted([2, 1], key=lambda _: ({}) or 1)",
    "more = list(map(lambda _: ({}), [1, 2]))",
    "more = len(str(({})))",
    "more = {{1: ({})}}",
    "assert (({}) or True)",
)
# Correct and wrong files, and one whose list is a function's.
FILES = [
    _HEAD + _LIST.format(launch="glob('launch/*.py')") + "{}\n" + _CALL,
    _HEAD + "{}\n" + _LIST.format(launch="glob('launch/*.launch.xml')") + _CALL,
    _HEAD + _LIST.format(launch="['launch/my_robot.launch.py']") + "{}\n" + _CALL,
    _HEAD + _LIST.format(launch="glob('launch/*.py')") + _CALL + "{}\n",
]
STATEMENTS = [
    "data_files.clear()",
    "data_files.pop()",
    "data_files.append(1)",
    "data_files.append(('share/my_robot/x', glob('rviz/*')))",
    "data_files.reverse()",
    "data_files.extend([])",
    "data_files.insert(0, 'package.xml')",
    "data_files.remove(1)",
    "data_files.sort(key=len)",
    "data_files.index(3)",
    "del data_files[1]",
    "del data_files[1:]",
    "del os",
    "del nothing",
    "data_files.remove(data_files[0])",
    "x = set(data_files[0][1]); len(x)",
    "data_files[0] = ('share/my_robot', {'package.xml'})",
    "os.path.getsize('nothing')",
    "data_files[1] = ('share/my_robot', [])",
    "data_files[1:] = []",
    "data_files += [1]",
    "data_files *= 0",
    "data_files = data_files[:1]",
    "data_files = tuple(data_files)",
    "data_files = iter(data_files)",
    "data_files = {1}",
    "data_files, name = [], 'x'",
    "list.clear(data_files)",
    "exec('data_files.clear()')",
    "globals()['data_files'].clear()",
    "vars()",
    "setattr(os, 'sep', 'x')",
    "os.sep = 'x'",
    "os.path.join = None",
    "glob = None",
    "glob = lambda pattern: []",
    "os = 1",
    "import builtins; builtins.list = None",
    "import sys; sys.modules['__main__'] = None",
    "import sys; sys.exit()",
    "import sys; sys.exit(1)",
    "raise ValueError",
    "raise SystemExit(0)",
    "1 / 0",
    "[1][2]",
    "{}['a']",
    "undefined",
    "(1, 2).append(3)",
    "'a' + 1",
    "len(1)",
    "int('a')",
    "a, b = [1]",
    "next(iter([]))",
    "x = zip([1], [2]); list(x); y = list(x)[0]",
    "x = map(str, [1]); x[0]",
    "x = (i for i in [1]); len(x)",
    "print(1)",
    "import sys; print(1, file=sys.stderr)",
    "class A: data_files.clear()",
    "class A(list): pass",
    "import os as o; o.nothing",
    "from os import nothing",
    "from glob import iglob as glob",
    "import no_such_module",
    "from . import x",
    "import json; json.loads('[')",
    "x = os.environ['NO_SUCH']",
    "x = os.environ.get('A')",
    "x = os.environ.get('A') or data_files.clear()",
    "x = 1 if os.environ.get('A') else data_files.clear()",
    "x = data_files.clear() if glob('urdf/*') else 1",
    "x = glob('nothing/*') and data_files.clear()",
    "assert not data_files",
    "assert data_files",
    "name = name.replace('my', 'your')",
    "name = f'{name}x'",
    "name = 3",
    "open('nothing')",
    "open('package.xml').read()[:3] == '<?x' and data_files.clear()",
    "x = open('package.xml'); x.close(); x.read()",
    "Path('urdf').iterdir()",
    "x = list(Path('nothing').iterdir())",
    "os.listdir('nothing')",
    "os.path.join('a', 1)",
    "glob(Path('a'))",
    "glob()",
    "glob('a', nothing=1)",
    "os.walk('urdf')",
    "(lambda items: items.clear())(data_files)",
    "(lambda: data_files.clear())",
    "x = [data_files.pop() for _ in 'ab']",
    "x = (data_files.pop() for _ in 'ab')",
    "x = {data_files.pop()}",
    "x = data_files; x.clear()",
    "x = [data_files]; x[0].clear()",
    "x = dict(a=data_files); x['a'].clear()",
    "type(data_files)([])",
    "getattr(data_files, 'clear')()",
    "data_files.__init__()",
    "data_files.__class__",
    "x: undefined = 1",
    "x: int = 1",
    "def f(x: undefined): pass",
    "def f(): undefined",
    "global data_files",
    "nonlocal data_files",
    "pass",
    "...",
    "return",
    "continue",
    "yield",
    "await 1",
    "lambda: undefined",
    "f'{undefined}'",
    "f'{name!r}'",
    "(x := 1)",
]


def variations() -> Iterator[str]:
    """Yield each file with each statement in each block; what Python cannot parse is among them."""
    for file in FILES:
        for block in _BLOCKS:
            for statement in STATEMENTS:
                yield file.format(block.format(statement))


@pytest.fixture(scope="module")
def package(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a package."""
    folder = tmp_path_factory.mktemp("work") / "my_robot"
    write_package(folder, "")
    return folder


def wrong(setup: Installation, ran: Ran) -> str:
    """Return how what is stated of a file differs from what Python does with it; nothing if it does not."""
    if setup.fault is not None or setup.faults or setup.stops or not setup.is_called:
        what = setup.fault or [*setup.faults, *setup.stops, "no call"][0]
        return f"works, but fails by the grader: {what}" if ran.installed is not None else ""
    if setup.doubt is not None:
        return ""
    if ran.installed is None:
        return "fails, but works by the grader"
    differing = setup.installed().items() ^ ran.installed.items()
    return f"installs other files: {sorted(differing)}" if differing and not setup.unknown else ""


def compared(folder: Path, texts: list[str]) -> list[str]:
    """Return the differences of some files from what Python does with them."""
    tree = read_folder(folder)
    setups = [read_setup(text.encode(), "setup.py", tree) for text in texts]
    pairs = zip(texts, setups, run_all(folder, texts), strict=True)
    return [f"{found}:\n{text}" for text, setup, ran in pairs if (found := wrong(setup, ran))]


@pytest.mark.slow
def test_short_programs(package: Path) -> None:
    """Programs that change the list of files, read a file, or raise an error: before the list, and after it."""
    programs: list[str] = json.loads(Path(__file__).with_name("programs.json").read_text("utf-8"))
    assert (
        compared(
            package, [file.replace("{}", program) for program in programs for file in FILES[:2]]
        )
        == []
    )


@pytest.mark.slow
def test_statements_at_random_places(package: Path) -> None:
    """Some hundred of the variations, the same in every run; some are decided each way."""
    texts = Random(46).sample(list(variations()), 300)
    assert compared(package, texts) == []
    setups = [read_setup(text.encode(), "setup.py", read_folder(package)) for text in texts]
    assert sum(setup.doubt is None and not setup.faults for setup in setups) > 60


@pytest.mark.exhaustive
def test_statements_at_many_places(package: Path) -> None:
    """A seventh of the variations, with each statement in each file."""
    assert compared(package, list(variations())[::7]) == []
