"""Entry points: a program certainly does not start if its module or function is not there; all else is not known."""

import pytest

from grader.base.source import Source
from grader.files.tree import make_tree, overlaid
from grader.ros.nodes.python.package_slips import package_slips
from grader.ros.package.entry_points import entry_fault
from grader.ros.package.finding import read_packages
from grader.ros.package.package import Package

pytestmark = pytest.mark.slow

_SETUP = """
from setuptools import setup
setup(
    name='hub',
    entry_points={'console_scripts': [%s]},
)
"""


def package_of(scripts: str, **files: str) -> Package:
    """Return a package with these entry points, and these files: `a` is hub/a.py."""
    texts = {
        "package.xml": "<package format='3'><name>hub</name></package>",
        "setup.py": _SETUP % scripts,
    }
    texts |= {"hub/__init__.py": "", "resource/hub": ""}
    texts |= {
        path if path.startswith("hub/") else f"hub/{path}.py": text for path, text in files.items()
    }
    tree = overlaid(
        make_tree("work", (), ()),
        {f"src/hub/{path}": text.encode() for path, text in texts.items()},
    )
    [package] = read_packages(tree, "urdf/hub.urdf")
    return package


FAULTS = [
    ("'talk = hub.talker:main'", {}, "there is no module hub.talker"),
    (
        "'talk = hub.talker:main'",
        {"talkr": ""},
        "there is no module hub.talker; did you mean 'talkr'?",
    ),
    (
        "'talk = hub.node:main'",
        {"talk": "", "a": ""},
        "there is no module hub.node; did you mean 'talk'?",
    ),
    (
        "'talk = hub.node:main'",
        {"a": "", "b": ""},
        "there is no module hub.node; there is 'a' and 'b'",
    ),
    ("'talk = hub.a.node:main'", {"a": ""}, "there is no module hub.a.node"),
    ("'talk = hub.talker:main'", {"talker": ""}, "hub/talker.py has no 'main'"),
    (
        "'talk = hub.talker:mian'",
        {"talker": "def main(): pass"},
        "hub/talker.py has no 'mian'; did you mean 'main'?",
    ),
    (
        "'talk = hub.talker:run'",
        {"talker": "class Talker: pass"},
        "hub/talker.py has no 'run'; there is 'Talker'",
    ),
    ("'talk=hub:main [extra]'", {}, "hub/__init__.py has no 'main'"),
]


@pytest.mark.parametrize(("scripts", "files", "fault"), FAULTS)
def test_a_program_whose_function_is_not_there_does_not_start(
    scripts: str, files: dict[str, str], fault: str
) -> None:
    """The message says what is missing, at the entry point in setup.py, and what may be meant."""
    found = entry_fault(package_of(scripts, **files), "talk")
    assert found is not None
    assert (found[0], found[1].path, found[1].line) == (fault, "src/hub/setup.py", 5)


SLIPS = [
    ("'talk = hub.talker:mian'", {"talker": "def main(): pass"}, "'talk = hub.talker:main'"),
    ("'talk = hub.talker:start'", {"talker": "def main(): pass"}, "'talk = hub.talker:main'"),
    ("'talk = hub.talkr:main'", {"talker": "def main(): pass"}, "'talk = hub.talker:main'"),
    ("'talk = hub.node:main'", {"talk": "", "a": ""}, "'talk = hub.talk:main'"),
    ("'talk = hub.talker:start'", {"talker": "def main(): pass\ndef other(): pass"}, None),
    ("'talk = hub.talker:main'", {"talker": "def main(): pass"}, None),
    ("'talk = ' 'hub.talker:start'", {"talker": "def main(): pass"}, None),
]


@pytest.mark.parametrize(("scripts", "files", "meant"), SLIPS)
def test_a_function_that_is_surely_meant_is_read(
    scripts: str, files: dict[str, str], meant: str | None
) -> None:
    """It has nearly the same name, or is the only one."""
    package = package_of(scripts, **files)
    text = _SETUP % scripts
    for slip in package_slips(package):
        [edit] = slip.edits
        assert slip.is_refused
        assert meant is not None
        start = Source("setup.py", text).offset(edit.line, edit.column)
        assert text[:start] + edit.new + text[start + len(edit.old) :] == _SETUP % meant
        break
    else:
        assert meant is None


UNKNOWN = [
    ("'talk = hub.talker:main'", {"talker": "def main(): pass"}),
    ("'talk = hub.talker:Talker.main'", {"talker": "class Talker: pass"}),
    ("'talk = hub.talker:main'", {"talker": "from hub.other import main"}),
    ("'talk = hub.talker:main'", {"talker": "if True:\n    main = print"}),
    (
        "'talk = hub.talker:main'",
        {"talker": "try:\n    import rclpy as main\nexcept ImportError as error:\n    pass"},
    ),
    ("'talk = hub.talker:main'", {"talker": "from hub.other import *"}),
    ("'talk = hub.talker:main'", {"talker": "def f():\n    global main\n    main = 1"}),
    ("'talk = hub.talker:main'", {"talker": "globals()['main'] = print"}),
    ("'talk = hub.talker:main'", {"talker": "def __getattr__(name): return print"}),
    ("'talk = hub.talker:main'", {"talker": "def ("}),
    ("'talk = hub.talker:main'", {"__init__": "__path__.append('..')"}),
    ("'talk = hub.talker:main'", {"hub/talker/node.py": ""}),
    ("'talk = hub.talker:main'", {"hub/talker.cpython-312-x86_64-linux-gnu.so": ""}),
    ("'talk = hub.talker:main'", {"hub/src/hub/talker.py": ""}),
    ("'talk = tools.talker:main'", {}),
    ("'talk = hub.talker'", {"talker": ""}),
    ("'talk = hub.talker:main', 'talk = hub.other:main'", {}),
    ("'talk := hub.talker:main'", {}),
    ("open('x').read()", {}),
    ("'listen = hub.talker:main'", {}),
]


@pytest.mark.parametrize(("scripts", "files"), UNKNOWN)
def test_what_may_be_there_is_no_fault(scripts: str, files: dict[str, str]) -> None:
    """A name that may be bound, a module that may be elsewhere and a computed entry point are not known to be wrong."""
    assert entry_fault(package_of(scripts, **files), "talk") is None


def test_the_python_package_of_the_entry_point_may_be_missing_as_a_whole() -> None:
    """An entry point in a Python package with the package's own name, which has no folder, is wrong."""
    package = package_of("'talk = hub.talker:main'")
    tree = package.tree.only(lambda path: not path.startswith("hub/"))
    [renamed] = read_packages(tree, "urdf/hub.urdf")
    fault = entry_fault(renamed, "talk")
    assert fault is not None and fault[0] == "there is no module hub.talker"


@pytest.mark.parametrize(
    ("module", "fault"),
    [
        ("robot_moitor.talker", "there is no package robot_moitor; did you mean 'robot_monitor'?"),
        ("robot_tools.talker", None),  # another package may have it
        ("robot_monitors.talker", None),  # package.xml depends on it
        ("robot_monitorr.talker", None),  # there is a folder
    ],
)
def test_the_top_package_of_an_entry_point_is_one_that_is_installed(
    module: str, fault: str | None
) -> None:
    """A name that is like one of those that this setup.py installs, and is nowhere, is misspelt."""
    setup = _SETUP.replace("name='hub'", "name='hub', packages=['robot_monitor']")
    files = {
        "package.xml": "<package format='3'><name>hub</name><depend>robot_monitors</depend></package>",
        "setup.py": setup % f"'talk = {module}:main'",
        "robot_monitor/__init__.py": "",
        "robot_monitor/talker.py": "def main(): pass",
        "test/robot_monitorr/talker.py": "",
    }
    tree = overlaid(make_tree("hub", (), ()), {path: it.encode() for path, it in files.items()})
    [package] = read_packages(tree, "urdf/hub.urdf")
    found = entry_fault(package, "talk")
    assert (found.message if found is not None else None) == fault


@pytest.mark.parametrize(
    ("packages", "files", "fault"),
    [
        ("find_packages()", {}, "setup.py installs no package hub, a folder without __init__.py"),
        ("['tools']", {"hub/__init__.py": ""}, "setup.py installs no package hub"),
        ("['hub']", {}, None),
        ("['hub']", {"hub/__init__.py": ""}, None),
        ("[], package_data={'': ['*.py']}", {}, None),
    ],
)
def test_the_package_of_an_entry_point_is_installed(
    packages: str, files: dict[str, str], fault: str | None
) -> None:
    """What setup.py does not name and find_packages() does not find is not installed."""
    setup = f"from setuptools import find_packages, setup\nsetup(name='hub', packages={packages},"
    texts = {
        "package.xml": "<package format='3'><name>hub</name></package>",
        "setup.py": f"{setup}\n    entry_points={{'console_scripts': ['talk = hub.talker:main']}})\n",
        "hub/talker.py": "def main(): pass",
        "resource/hub": "",
        "tools/__init__.py": "",
        **files,
    }
    data = {f"src/hub/{path}": text.encode() for path, text in texts.items()}
    [package] = read_packages(overlaid(make_tree("work", (), ()), data), "urdf/hub.urdf")
    found = entry_fault(package, "talk")
    assert (found.message if found is not None else None) == fault


@pytest.mark.parametrize(
    ("entry", "installed", "found"),
    [
        (
            "talker:main",
            "packages=['hub']",
            "there is no module talker; did you mean 'hub.talker'?",
        ),
        ("talker:run", "packages=['hub']", None),
        ("talker:main", "packages=['hub'], py_modules=['talker']", None),
        ("talker:main", "packages=['hub', 'talker']", None),
        ("hub.talker", "packages=['hub']", "hub.talker is a module; write hub.talker:main"),
        ("hub.empty", "packages=['hub']", None),
    ],
)
def test_an_entry_point_names_a_function_of_a_module_in_a_package(
    entry: str, installed: str, found: str | None
) -> None:
    """Without the package, no module is found; without the function, a module is called."""
    texts = {
        "package.xml": "<package format='3'><name>hub</name></package>",
        "setup.py": f"from setuptools import setup\nsetup(name='hub', {installed},\n"
        f"    entry_points={{'console_scripts': ['talk = {entry}']}})\n",
        "hub/__init__.py": "",
        "hub/talker.py": "def main(): pass",
        "hub/empty.py": "print('works')",
        "resource/hub": "",
    }
    if "'hub', 'talker'" in installed:
        texts["talker/__init__.py"] = "def main(): pass"
    data = {f"src/hub/{path}": text.encode() for path, text in texts.items()}
    [package] = read_packages(overlaid(make_tree("work", (), ()), data), "urdf/hub.urdf")
    fault = entry_fault(package, "talk")
    assert (fault.message if fault is not None else None) == found
