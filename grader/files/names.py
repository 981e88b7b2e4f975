"""What the names of files and folders tell: robots, packages, archives, what no student wrote."""

ROBOT_ENDINGS = (".urdf", ".xacro")
PACKAGE_FILES = frozenset({"package.xml", "setup.py"})
ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar")
BUILD_FOLDERS = frozenset({"build", "install", "log"})
# And those with a pyvenv.cfg.
IGNORED_FOLDERS = BUILD_FOLDERS | {"node_modules", "site-packages", "__pycache__", "__MACOSX"}
# The ends of the names of files that a build copies, and that a submission may lack.
_COPIED = (".urdf", ".xacro", ".rviz", "launch.py", "launch.xml", "launch.yaml", "launch.yml", "/package.xml")
LITTER = frozenset({"Thumbs.db", "desktop.ini", "Icon\r"})  # of an operating system


def ignored_part(path: str) -> str | None:
    """Return how far a path leads to something ignored: a folder of tools or of a build, or a hidden folder or file."""
    *folders, name = path.split("/")
    for index, folder in enumerate(folders):
        if folder in IGNORED_FOLDERS or folder.startswith("."):
            return "/".join(folders[: index + 1])
    return path if name.startswith(".") or name in LITTER else None


def is_generated(path: str) -> bool:
    """Return whether a path is that of a file of a package which a build has copied."""
    return path.lower().endswith(_COPIED) and not BUILD_FOLDERS.isdisjoint(path.split("/")[:-1])
