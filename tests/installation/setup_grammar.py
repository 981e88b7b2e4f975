"""Random setup.py: the ways in which students and templates list data files, sometimes with a mistake."""

from collections.abc import Mapping
from random import Random

from tests.installation.my_robot import FILES

FOLDERS = ("urdf", "launch", "rviz", "meshes", "config", "resource", "meshes/a")
_PATTERNS = (
    "*",
    "*.*",
    "*.urdf",
    "*.launch.py",
    "*launch.[pxy][yma]*",
    "*.rviz",
    "*.stl",
    "my_*",
    "[a-m]*",
    "?ox.urdf",
    "*/*",
    "**/*",
    "**",
    "nothing*",
)
_LISTED = (
    "package.xml",
    "urdf/my_robot.urdf",
    "urdf/box.urdf",
    "rviz/my_robot.rviz",
    "launch/my_robot_rviz.launch.py",
    "config/params.yaml",
    "meshes/two.stl",
    "meshes/a/one.stl",
    "resource/my_robot",
    "README.md",
)
_HEADER = """\
import os
import sys
from glob import glob
from pathlib import Path
from setuptools import find_packages, setup

package_name = 'my_robot'
share = os.path.join('share', package_name)
"""
_HELPERS = """\


def files(folder, pattern='*'):
    return sorted(glob(os.path.join(folder, pattern)))


def entry(folder, *patterns):
    found = []
    for pattern in patterns or ('*',):
        found.extend(path for path in glob(f'{folder}/{pattern}') if os.path.isfile(path))
    return (f'{share}/{folder}', found)


def tree(root):
    found = []
    for path, folders, names in os.walk(root):
        if names:
            found.append((os.path.join(share, path), [os.path.join(path, name) for name in names]))
    return found


def walked(paths, end=''):
    for path in paths:
        for base, _, names in os.walk(path):
            for name in names:
                if name.endswith(end):
                    yield (os.path.join('share', package_name, base), [os.path.join(base, name)])


only = lambda folder, end: [path for path in glob(folder + '/*') if path.endswith(end)]
"""
_MISTAKES = (
    ("from glob import glob", "import glob"),
    ("import os\n", ""),
    ("from pathlib import Path\n", ""),
    ("package_name = ", "name = "),
    ("os.path.join('share'", "os.path.jion('share'"),
    ("setup(\n", "setup(\n    cmdclass={},\n"),
    ("find_packages, ", ""),
)

# Other arguments of setup(), sometimes wrong.
_ARGUMENTS = (
    "    entry_points={'console_scripts': []},\n",
    "    entry_points={'console_scripts': ['talk = my_robot.talk:main']},\n",
    "    entry_points={'console_scripts': ['talk']},\n",
    "    entry_points={'console_scripts': ['talk=my_robot.talk:main()']},\n",
    "    install_requires=['setuptools'],\n",
    "    tests_require=['pytest'],\n",
    "    extras_require={'test': ['pytest']},\n",
    "    python_requires='>=3.8',\n",
    "    license=['MIT'],\n",
    "    nothing=1,\n",
    "    install_requires=['a b'],\n",
    "    setup_requires=['setuptools'],\n",
    "    package_data={'my_robot': ['*.yaml']},\n",
    "    keywords=['ROS'],\n",
)

_ADD_EXTRA = (
    "for key, paths in extra.items():\n    data_files.append((f'share/my_robot/{key}', paths))\n"
)


# What else a package may have: the text of a file, None for one that it lacks.
_OTHERS: tuple[Mapping[str, str | None], ...] = (
    {"COLCON_IGNORE": "#1\n"},
    {"AMENT_IGNORE": "#2\n"},
    {"urdf/COLCON_IGNORE": "#3\n"},
    {"my_robot/__init__.py": None},
    {"pyproject.toml": "[build-system]\nrequires = ['setuptools']\n"},
    {"pyproject.toml": "[tool.black]\nline-length = 1\n"},
    {"pyproject.toml": "name = \n"},
    {"pyproject.toml": "[project]\nname = 'my_robot'\n"},
    {"setup.cfg": None},
    {"setup.cfg": ""},
    {"setup.cfg": "[install]\nscript_dir=$base/lib/my_robot\n"},
    {"setup.cfg": "[develop\nscript_dir=$base/lib/my_robot\n"},
    {"setup.cfg": "script_dir=$base/lib/my_robot\n"},
    {"setup.cfg": "[flake8]\nmax-line-length = 99\n"},
    {"setup.cfg": "[aliases]\ntest=pytest\n"},
    {"setup.cfg": "[install]\ninstall-scripts=$base/lib/my_robot\n"},
    {"setup.cfg": "[develop]\nscript-dir=$base/lib/my_robot\n"},
    {"setup.cfg": "[install]\nnothing=1\n"},
    {"setup.cfg": "[metadata]\nname = other\n"},
    {"setup.cfg": "[install]\ninstall_scripts=%x\n"},
    {"setup.cfg": "[install]\ninstall_scripts=a\ninstall_scripts=b\n"},
    {"glob.py": "def glob(*a): return []\n"},
    {"other/__init__.py": "#4\n"},
)


def other_files(seed: int) -> dict[str, str]:
    """Return the files of a package besides setup.py, by their paths; half of the seeds differ from the usual ones."""
    random = Random(~seed)
    changed = random.choice(_OTHERS) if random.random() < 0.4 else {}
    files = {**{path: text.format(path) for path, text in FILES.items()}, **changed}
    return {path: text for path, text in files.items() if text is not None}


def setup_py(seed: int) -> str:
    """Return the setup.py of a seed: the same in every run."""
    return _Writer(Random(seed)).text()


class _Writer:
    def __init__(self, random: Random) -> None:
        self._random, self._pick = random, random.choice

    def text(self) -> str:
        """Return the whole file."""
        entries = [self._entry() for _ in range(self._random.randint(0, 4))]
        listed = "".join(f"    {entry},\n" for entry in entries)
        first = "    ('share/ament_index/resource_index/packages', ['resource/' + package_name]),\n    (share, ['package.xml']),\n"
        first = first if self._random.random() < 0.7 else ""
        steps = "".join(self._step() for _ in range(self._pick((0, 1, 1, 2, 3))))
        added = "".join(f" + {self._several()}" for _ in range(self._pick((0, 0, 0, 1))))
        more = self._pick(
            ("",) * 20
            + (
                *_ARGUMENTS,
                "    zip_safe=True,\n",
                "    package_data={'': ['*.yaml']},\n",
                "    include_package_data=True,\n",
            )
        )
        text = f"{_HEADER}{_HELPERS}\n\ndata_files = [\n{first}{listed}]{added}\n{steps}\n"
        text += f"setup(\n    name=package_name,\n    version={self._version()},\n    {self._packages()}"
        text += f"    data_files={self._pick((*['data_files'] * 10, 'list(data_files)', 'data_files[:]'))},\n{more})\n"
        if self._random.random() < 0.12:
            text = text.replace(*self._pick(_MISTAKES), 1)
        return text

    def _version(self) -> str:
        usual = self._random.random() < 0.9
        return (
            "'0.0.0'"
            if usual
            else self._pick(
                ("'1'", "'v1.2-beta'", "'abc'", "'1.0.0-'", "1.0", "'1.2.3.4.dev5'", "''")
            )
        )

    def _packages(self) -> str:
        packages = self._pick(
            ("find_packages()", "[package_name]", "find_packages(exclude=['test'])", "[]")
        )
        if self._random.random() < 0.1:
            packages = self._pick(
                (
                    "['nothing']",
                    "'my_robot'",
                    "find_packages('.')",
                    "['my_robot', 'meshes']",
                    "None",
                    "find_packages(include=['x'])",
                )
            )
        return f"packages={packages},\n" if self._random.random() < 0.95 else ""

    def _folder(self) -> str:
        return (
            self._pick((*FOLDERS, *FOLDERS[:4], "missing"))
            if self._random.random() < 0.3
            else self._pick(FOLDERS[:4])
        )

    def _target(self, folder: str) -> str:
        inside = self._pick((f"/{folder}", f"/{folder}", "", f"/{folder}/", "//x", "/./y"))
        name = inside.strip("/") or "."
        return self._pick(
            (
                f"'share/my_robot{inside}'",
                f"f'share/{{package_name}}{inside}'",
                f"'share/' + package_name + '{inside}'",
                f"share + '{inside}'",
                f"os.path.join('share', package_name, '{name}')",
                f"os.path.join(share, '{name}')",
                f"'share/%s{inside}' % package_name",
                f"'share/{{}}{inside}'.format(package_name)",
                f"str(Path('share') / package_name / '{name}')",
                f"'/'.join(['share', package_name, '{name}'])",
                f"os.path.join(share, *'{name}'.split('/'))",
                f"os.path.normpath(f'{{share}}/{name}')",
                "share",
                "share",
                f"os.sep.join((share, '{name}'))",
            )
        )

    def _sources(self, folder: str) -> str:
        # What ** finds in a missing folder depends on the version of Python: docs/packages.md.
        patterns = tuple(
            pattern for pattern in _PATTERNS if folder != "missing" or "**" not in pattern
        )
        pattern, path, there = (
            self._pick(patterns),
            f"{folder}/{self._pick(patterns)}",
            folder.replace("missing", "urdf"),
        )
        listed = ", ".join(
            repr(path) for path in self._random.sample(_LISTED, self._pick((1, 1, 2, 3)))
        )
        if self._random.random() < 0.04:
            listed += self._pick((", 'missing.txt'", ", 'urdf'", ", 3"))
        return self._pick(
            (
                f"glob('{path}')",
                f"glob('{path}')",
                f"glob(os.path.join('{folder}', '{pattern}'))",
                f"sorted(glob('{path}'))",
                f"[{listed}]",
                f"[{listed}]",
                f"files('{folder}')",
                f"files('{folder}', '{pattern}')",
                f"[path for path in glob('{path}') if os.path.isfile(path)]",
                f"[path for path in sorted(glob('{there}/**', recursive=True)) if not os.path.isdir(path)]",
                f"glob('{there}/**/*.*', recursive=True)",
                f"[str(path) for path in Path('{folder}').glob('{pattern.replace('**', '*')}') if path.is_file()]",
                f"list(map(str, Path('{folder}').rglob('*.*')))",
                f"[os.path.join('{folder}', name) for name in os.listdir('{folder}')]",
                f"only('{folder}', '{self._pick(('.urdf', '.py', '', '.stl'))}')",
                f"glob('{path}') + glob('{self._folder()}/{self._pick(_PATTERNS)}')",
                f"[*glob('{path}'), {listed}]",
                f"glob('{path}') or [{listed}]",
                f"[path.as_posix() for path in sorted(Path('{folder}').iterdir()) if path.suffix in ('.urdf', '.py')]",
                f"list(filter(os.path.isfile, glob('{path}')))",
                f"glob(f'{folder}/*')[:{self._pick((1, 2))}]",
                "[f for f in os.listdir('.') if f.endswith('.xml')]",
                f"[f'{folder}/{{name}}' for name in sorted(os.listdir('{folder}')) if os.path.splitext(name)[1]]",
                f"list({{*glob('{path}')}})",
                f"({listed},)",
                f"glob('{path}') if os.path.exists('{folder}') else []",
                f"tuple(glob('{path}'))",
                "[]",
                f"glob('{path}', recursive={self._pick((True, False))})",
            )
        )

    def _entry(self) -> str:
        folder = self._folder()
        return self._pick(
            (
                *[f"({self._target(folder)}, {self._sources(folder)})"] * 5,
                f"entry('{folder}')",
                f"entry('{folder}', '{self._pick(_PATTERNS)}', '*.x')",
                f"[{self._target(folder)}, {self._sources(folder)}]"
                if self._random.random() < 0.2
                else f"({self._target(folder)}, {self._sources(folder)})",
            )
        )

    def _several(self) -> str:
        """Return an expression that is a list of entries."""
        one, other = self._folder(), self._folder()
        return self._pick(
            (
                f"[entry(folder) for folder in ('{one}', '{other}')]",
                f"tree('{one}')",
                f"[({self._target(one)}, [path]) for path in glob('{one}/*.*')]",
                f"[(os.path.join(share, os.path.dirname(path)), [path]) for path in glob('**/*.*', recursive=True) if path.startswith('{one}')]",
                f"[(f'{{share}}/{{folder}}', glob(f'{{folder}}/*.*')) for folder in ['{one}', '{other}'] if os.path.isdir(folder)]",
                f"[(target, glob(pattern)) for target, pattern in {{'share/my_robot/p': '{one}/*.*', share: '{other}/*.*'}}.items()]",
                f"list(walked(['{one}']))",
                f"[({self._target(one)}, {self._sources(one)})] * {self._pick((0, 1))}",
                f"[(share, paths) for paths in zip(glob('{one}/*.*'))]",
                f"[(f'{{share}}/{{index}}', [path]) for index, path in enumerate(sorted(glob('{one}/*.*')))]",
                f"[(str(path.parent.joinpath('x')).replace('{one}', share), [str(path)]) for path in Path('{one}').glob('*.*')]",
            )
        )

    def _step(self) -> str:
        """Return statements that change the list."""
        folder, entry = self._folder(), self._entry()
        return self._pick(
            (
                f"data_files.append({entry})\n",
                f"data_files += [{entry}]\n",
                f"data_files.extend({self._several()})\n",
                f"data_files = data_files + {self._several()}\n",
                f"for folder in ['{folder}', '{self._folder()}']:\n    data_files.append((os.path.join(share, folder), glob(folder + '/*.*')))\n",
                f"if os.path.isdir('{folder}'):\n    data_files.append({entry})\nelse:\n    data_files.insert(0, {self._entry()})\n",
                f"for path in sorted(glob('{folder}/*')):\n    if os.path.isdir(path):\n        continue\n    data_files.append((share, [path]))\n",
                f"try:\n    data_files.append({entry})\nexcept OSError:\n    pass\n",
                "data_files = [(a, b) for a, b in data_files if b]\n",
                f"extra = {{}}\nfor path in glob('{folder}/*.*'):\n    extra.setdefault(os.path.dirname(path), []).append(path)\n{_ADD_EXTRA}",
                f"count = 0\nwhile count < {self._pick((0, 1, 2))}:\n    data_files.append((f'share/my_robot/{{count}}', glob('{folder}/*.urdf')))\n    count += 1\n",
                f"with open('package.xml') as file:\n    if 'package' in file.read():\n        data_files.append({entry})\n",
                "del data_files[-1:]\n",
                f"for base, folders, names in os.walk('{folder}'):\n    for name in names:\n        data_files.append((os.path.join(share, base), [os.path.join(base, name)]))\n",
                f"here = os.path.abspath(os.path.dirname(__file__))\ndata_files.append(({self._target(folder)}, [os.path.relpath(p, here) for p in glob(here + '/{folder}/*.*')]))\n",
                f"assert os.path.exists('package.xml')\nprint('{folder}', file=sys.stderr)\n",
                f"data_files.pop()\ndata_files.append({entry})\n",
            )
        )
