"""What is read of a submission: what file names tell, parts that no student wrote, and limits.

Robots, packages and archives are known by their names.
"""

from grader.base.errors import FileError, InputError
from grader.base.patterns import on_use
from grader.base.text import size_text

ROBOT_ENDINGS = (".urdf", ".xacro")
PACKAGE_FILES = frozenset({"package.xml", "setup.py"})
ARCHIVES = (".zip", ".tar", ".gz", ".tgz", ".bz2", ".xz", ".7z", ".rar")
BUILD_FOLDERS = frozenset({"build", "install", "log"})
# And those with a pyvenv.cfg.
IGNORED_FOLDERS = BUILD_FOLDERS | {"node_modules", "site-packages", "__pycache__", "__MACOSX"}
# The ends of the names of files that a build copies, and that a submission may lack.
_COPIED = (
    ".urdf",
    ".xacro",
    ".rviz",
    "launch.py",
    "launch.xml",
    "launch.yaml",
    "launch.yml",
    "/package.xml",
)
LITTER = frozenset({"Thumbs.db", "desktop.ini", "Icon\r"})  # of an operating system
MAX_FILES = 50_000  # and as many folders, in a submission
MAX_FILE_SIZE = 64 * 1024 * 1024  # bytes of one file of a submission: a larger one is ignored
MAX_ARCHIVE_SIZE = 1024 * 1024 * 1024  # bytes of an archive, and of its decompressed data
MAX_UNPACKED_SIZE = (
    512 * 1024 * 1024
)  # bytes of the files in an archive, without those that are too large and ignored
MAX_ARCHIVES = 20  # in an archive or folder
MAX_NESTED = 3  # archives inside each other
MAX_RATIO = 200  # of the content of an archive to its own size
SETUP_ASSISTANT = ".setup_assistant"  # where a MoveIt configuration says which robot it is for
# Hidden files that say how a folder, or the only one in it, is built: workflows and containers.
_SETTING = on_use(
    r"(?:[^/]+/)?(?:\.gitlab-ci\.yml|\.env|\.gitmodules|\.github/workflows/[^/]+\.ya?ml"
    r"|\.(?:devcontainer|docker)/(?:[^/]+/)?[^/]+)"
)
_OF_SETTINGS = on_use(
    r"(?:[^./][^/]*/)?\.(?:github(?:/workflows)?|(?:devcontainer|docker)(?:/[^/]+)?)|[^./][^/]*"
)
HARMLESS_SIZE = 32 * 1024 * 1024  # bytes that an archive may contain regardless of the ratio
# Recordings of `ros2 bag record`, which are read as streams.
METADATA = "metadata.yaml"  # beside them
_RECORDINGS = (".mcap", ".db3", ".mcap.zstd", ".db3.zstd")  # endings of their files
MAX_RECORDING_SIZE = 1024 * 1024 * 1024  # bytes of a file; in an archive, MAX_UNPACKED_SIZE
MAX_RECORDING_UNPACKED = 256 * 1024 * 1024  # bytes of its decompressed chunks, messages and files
MAX_CHUNK_SIZE = 64 * 1024 * 1024  # bytes, compressed or not
MAX_MESSAGE_SIZE = 1024 * 1024  # bytes of a message that is decoded
MAX_TOPIC_SIZE = 16 * 1024 * 1024  # bytes of the messages of a topic that are kept
MAX_KEPT_SIZE = 64 * 1024 * 1024  # bytes of all messages that are kept
MAX_MESSAGES = 1_000_000
MAX_TOPICS = 1_000
MAX_METADATA_SIZE = 512 * 1024  # bytes of a metadata.yaml
MAX_QUERY_STEPS = 200_000  # thousands of instructions of SQLite
MAX_MESSAGE_VALUES = 200_000  # that are decoded of a message


def ignored_part(path: str) -> str | None:
    """Return how far a path leads to something ignored.

    This is a folder of tools or of a build, or a hidden folder or file.
    """
    *folders, name = path.split("/")
    for index, folder in enumerate(folders):
        if folder in IGNORED_FOLDERS or folder.startswith("."):
            return "/".join(folders[: index + 1])
    is_hidden = name.startswith(".") and name != SETUP_ASSISTANT
    return path if is_hidden or name in LITTER else None


def is_generated(path: str) -> bool:
    """Return whether a path is that of a file of a package which a build has copied."""
    return path.lower().endswith(_COPIED) and not BUILD_FOLDERS.isdisjoint(path.split("/")[:-1])


def is_recording(path: str) -> bool:
    """Return whether a path is that of a file of a recording, which may be larger than others."""
    return path.lower().endswith(_RECORDINGS)


def is_setting(path: str) -> bool:
    """Return whether a path is that of a hidden file which says how packages are built."""
    return _SETTING.fullmatch(path) is not None


def may_have_settings(folder: str) -> bool:
    """Return whether such a file may be in a folder."""
    return _OF_SETTINGS.fullmatch(folder) is not None


class Allowance:
    """The number of bytes that an archive may unpack to, together with the archives in it.

    `streamed` counts the decompressed bytes of a compressed tar, ignored files included.
    """

    def __init__(self) -> None:
        self.unpacked = MAX_UNPACKED_SIZE
        self.streamed = MAX_ARCHIVE_SIZE
        self.archives = MAX_ARCHIVES

    def spend(self, name: str, *, unpacked: int = 0, streamed: int = 0) -> None:
        """Use up some of it; raises FileError where there is not enough."""
        self.unpacked -= unpacked
        self.streamed -= streamed
        if self.unpacked < 0:
            raise unpacked_limit_error(name, MAX_UNPACKED_SIZE)
        if self.streamed < 0:
            raise unpacked_limit_error(name, MAX_ARCHIVE_SIZE)


def files_limit_error(name: str) -> InputError:
    """Return the error for a submission with more files than any student submits."""
    return FileError(name, f"contains more than {MAX_FILES} files: name the package or the URDF")


def archive_size_error(name: str) -> FileError:
    """Return the error for an archive of more than `MAX_ARCHIVE_SIZE` bytes."""
    return FileError(
        name, f"is larger than {size_text(MAX_ARCHIVE_SIZE)}, the limit for an archive"
    )


def unpacked_limit_error(name: str, limit: int) -> FileError:
    """Return the error for an archive that would unpack to more than a limit."""
    ratio = f", {MAX_RATIO} times its own size" if HARMLESS_SIZE < limit < MAX_UNPACKED_SIZE else ""
    reason = (
        f"would unpack to more than {size_text(limit)}, the limit for an archive{ratio}, and "
        "was not read"
    )
    return FileError(name, reason)
