"""The package around the samples of setup.py: its files, and what differs for a few samples."""

from collections.abc import Mapping
from pathlib import Path

SAMPLES = {
    path.name.removesuffix(".py.txt"): path
    for path in sorted(Path(__file__).parent.glob("setup_samples/*.txt"))
}

_XML = "<!-- {} -->\n"
_HASH = "# {}\n"
# Every file has a unique text, which identifies the source of an installed file.
FILES = {
    "README.md": _HASH,
    "config/params.yaml": _HASH,
    "launch/my_robot_rviz.launch.py": _HASH,
    "meshes/a/one.stl": "solid {}\n",
    "meshes/two.stl": "solid {}\n",
    "my_robot/__init__.py": _HASH,
    "my_robot/version.py": _HASH + "__version__ = '0.0.0'\n",
    "package.xml": """<?xml version="1.0"?>
<package format="3">
  <name>my_robot</name>
  <version>0.0.0</version>
  <description>A package: {}</description>
  <maintainer email="student@example.com">student</maintainer>
  <license>Apache-2.0</license>
  <export>
    <build_type>ament_python</build_type>
  </export>
</package>
""",
    "resource/my_robot": "{}\n",
    "rviz/my_robot.rviz": _HASH,
    "setup.cfg": _HASH
    + "[develop]\nscript_dir=$base/lib/my_robot\n[install]\ninstall_scripts=$base/lib/my_robot\n",
    "urdf/box.urdf": _XML,
    "urdf/my_robot.urdf": _XML,
}
ADDED = {
    "brackets_in_a_folder_name": ["[old]/my_robot.urdf", "o/my_robot.urdf"],
    "folder_in_urdf": ["urdf/old/my_robot.urdf"],
    "folder_in_urdf_passed_by": ["urdf/old/my_robot_1.urdf"],
    "hidden_file_named": ["urdf/.hidden.urdf"],
    "hidden_files": ["urdf/.hidden.urdf"],
    "ignored_by_ament": ["AMENT_IGNORE"],
    "same_target_twice": ["other/box.urdf"],
    "two_sources_for_one_target": ["meshes/a/two.stl"],
    "urdf_below_resource": ["resource/deep/README", "resource/deep/er/picture.png"],
}
INSTEAD = {
    "data_files_in_setup_cfg": {
        "setup.cfg": "[options.data_files]\nshare/my_robot = package.xml\n"
    },
    "own_module_named_glob": {"glob.py": "def glob(pattern):\n    return []\n"},
    "pyproject_that_is_no_toml": {"pyproject.toml": "name = \n"},
    "script_dir_in_install": {"setup.cfg": "[install]\nscript_dir=$base/lib/my_robot\n"},
    "setup_cfg_with_dashes": {
        "setup.cfg": "[develop]\nscript-dir=$base/lib/my_robot\n[install]\ninstall-scripts=$base/lib/my_robot\n"
    },
    "setup_cfg_without_a_section": {"setup.cfg": "script_dir=$base/lib/my_robot\n"},
    "packages_in_setup_cfg": {
        "setup.cfg": "[options]\npackages = find:\n[options.packages.find]\ninclude = my_robot\n"
    },
}
TAKEN_AWAY = {
    "no_launch_folder": ["launch/my_robot_rviz.launch.py"],
}


def make_package(sample: str, folder: Path) -> dict[str, str]:
    """Write the package with a sample as its setup.py; return the path of each file by the file's text."""
    texts = {
        path: text.format(path)
        for path, text in FILES.items()
        if path not in TAKEN_AWAY.get(sample, ())
    }
    texts |= {path: path + "\n" for path in ADDED.get(sample, ())}
    texts |= INSTEAD.get(sample, {})
    return write_package(folder, SAMPLES[sample].read_text(encoding="utf-8"), texts)


def write_package(
    folder: Path, setup: str, files: Mapping[str, str] | None = None
) -> dict[str, str]:
    """Write a package with this setup.py and these files, by default the usual ones; return their paths by their texts."""
    texts = (
        dict(files)
        if files is not None
        else {path: text.format(path) for path, text in FILES.items()}
    )
    texts["setup.py"] = setup
    for path, text in texts.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text, encoding="utf-8")
    return {text: path for path, text in texts.items()}
