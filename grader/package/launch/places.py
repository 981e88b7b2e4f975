"""Stand-ins for folders that only a machine knows, and how launch files are named."""

from pathlib import PurePosixPath

# Paths below these are compared as texts.
PREFIX = "/<prefix>"  # where a build installs to
WORKING_FOLDER = "/<current folder>"
HOME = "/<home>"
SHARE = f"{PREFIX}/share"

# Folders at the top of a file system that are one person's or one machine's own.
_OWN = frozenset({"home", "Users", "root", "mnt", "media"})

ENDINGS = (".launch.py", ".launch.xml", ".launch.yaml", ".launch.yml", "_launch.py", "_launch.xml", "_launch.yaml")
_LANGUAGES = (".py", ".xml", ".yaml", ".yml")


def may_launch(path: str) -> bool:
    """Whether a file is a launch file by the folder that it stands in, whatever it is named."""
    folder, _, name = path.rpartition("/")
    suffix = PurePosixPath(name).suffix
    known = suffix in ("", ".launch", *_LANGUAGES) or (suffix == ".txt" and ".launch." in name)
    return folder.rpartition("/")[2] == "launch" and name != "__init__.py" and known


def is_launch_named(path: str, name: str) -> bool:
    """Whether a launch file has this name, in any of the three languages that ros2 launch reads."""
    own = path.rpartition("/")[2]
    return own == name or (launch_stem(own) == launch_stem(name) and own.endswith(ENDINGS[:4]))


def launch_stem(name: str) -> str:
    """The name of a launch file without what tells its language."""
    base = name.rpartition("/")[2]
    return base.split(".launch")[0] if ".launch" in base else base.rpartition("_launch.")[0] or base


def is_of_one_machine(path: str) -> bool:
    """Whether a path leads into somebody's home folder, or to a disk of one machine."""
    if path.startswith(HOME) or path[1:3] in (":\\", ":/"):
        return True
    top, _, rest = path.removeprefix("/").partition("/")
    return path.startswith("/") and top in _OWN and bool(rest)
