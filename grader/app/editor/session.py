"""A workspace that is open in an editor: what was seen of it last, and what to look at next."""

from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from threading import Lock

from grader.app.editor.edited_files import EditedFiles, SkippedText
from grader.app.editor.look import Graded, Look, look_at
from grader.app.editor.reading_limits import ReadingLimits
from grader.app.settings import Settings, read_settings
from grader.base.errors import GraderError
from grader.base.reuse import Memory
from grader.files.tree import Tree

_MOST = 20_000  # results that are kept of a look


class SupersededError(Exception):
    """The files have changed again: a look at them as they were is of no use."""


class EditorSession:
    """The state of a workspace in an editor.

    Its methods may be called from several threads. Looks are made one after another; a look ends
    early where the files change meanwhile.
    """

    def __init__(
        self,
        root: Path,
        rubric: str = "",
        limits: ReadingLimits | None = None,
        skipped: Mapping[str, SkippedText] | None = None,
    ) -> None:
        """Open a folder.

        Args:
            root: The folder.
            rubric: The rubric to grade with; default: that of the settings.
            limits: The limits of processor time; default: none.
            skipped: The texts that take too long to read, by the paths of their files.
        """
        self._limits = limits or ReadingLimits()
        inside = {}
        for path, text in (skipped or {}).items():
            if Path(path).is_relative_to(root):
                inside[Path(path).relative_to(root).as_posix()] = text
        self.files = EditedFiles(root, inside, self._begin_file)
        self.complaint = ""  # why the settings are not used
        self._rubric = rubric
        self._version = 0  # of the files
        self._seen = -1  # the version at which the last look was made
        self._looking = -1
        self._ends_anyway = False  # a look, although the files change meanwhile
        self._look: Look | None = None
        self._clean: dict[str, Look] = {}  # by the files that are typed
        self._memory = Memory(_MOST, self._check)
        self._lock = Lock()

    def change(self, change: Callable[[EditedFiles], None]) -> None:
        """Change the files: what was seen of them is out of date."""
        change(self.files)
        self._version += 1

    def _read_settings(self) -> Settings:
        """Return the settings of the workspace.

        They are None where they cannot be read: `complaint` says why.
        """
        self.complaint = ""
        try:
            return read_settings(str(self.files.root))
        except GraderError as error:
            self.complaint = str(error)
        return Settings()

    def look(self, *, ends_anyway: bool = False) -> Look:
        """Return a look at the files as they are now. Raises GraderError, SupersededError.

        With `ends_anyway` it does not end early.
        """
        with self._lock:
            if not self._look or self._seen != self._version:
                self._looking = self._version
                self._ends_anyway = ends_anyway
                before = self._look
                self._look = self._look_at(self.files.tree())
                self._memory.forget_unused()
                self._seen = self._looking
                self._keep_clean(before, self._look)
            return self._look

    def _keep_clean(self, before: Look | None, look: Look) -> None:
        """Keep the last look in which each file that is typed had no error."""
        kept = {}
        for path in self.files.typed:
            if not look.has_errors(path):
                kept[path] = look
            elif path in self._clean:
                kept[path] = self._clean[path]
            elif before and path in before.tree.files and not before.has_errors(path):
                kept[path] = before
        self._clean = kept

    def _find_clean(self, path: str) -> Look | None:
        return self._clean.get(path)

    def _look_again(self, tree: Tree) -> Look:
        """Return a look at other files, such as these after edits."""
        with self._lock:
            self._looking = self._version
            self._ends_anyway = False
            return self._look_at(tree)

    def _look_at(self, tree: Tree) -> Look:
        settings = self._read_settings()
        grade = partial(self._grade, settings)
        with self._limits.looking():
            return look_at(
                tree,
                self.files.root,
                settings,
                self._memory,
                grade,
                self._look_again,
                self._find_clean,
            )

    def _begin_file(self, path: str) -> None:
        self._limits.begin_file(str(self.files.root / path))

    def _check(self) -> None:
        self._limits.restart()
        if self._looking != self._version and not self._ends_anyway:
            raise SupersededError

    def _grade(self, settings: Settings, tree: Tree) -> Graded:
        name = self._rubric or settings.rubric
        if not name:
            return Graded()
        from grader.app.editor.criteria import grade_files  # late: most look without a rubric

        return grade_files(name, tree, self.files.root.name)
