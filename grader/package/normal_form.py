"""The normal form of a package's files: equal for files that differ in comments, white space and quotes only."""

import re
from collections.abc import Iterator
from contextlib import suppress
from hashlib import sha256

from grader.errors import InputError
from grader.package.package import PYTHON_LIMIT, SETUP, Package

_COMMENT = re.compile(rb"^[ \t]*+#.*", re.MULTILINE)
_WINDOW = re.compile(
    rb"^(?:Panels|Window Geometry):.*\n(?:[ \t-].*(?:\n|\Z))*", re.MULTILINE
)  # of RViz: differs by screen


def package_forms(package: Package) -> Iterator[tuple[str, str]]:
    """Yield the hash of the normal form of setup.py, of the launch files, and of the RViz files, each with its name."""
    kinds = {"setup.py": (SETUP,), "launch files": package.launch_files, "RViz files": package.rviz_files}
    for kind, paths in kinds.items():
        with suppress(InputError):
            files = [package.tree.files[path].read(PYTHON_LIMIT) for path in paths if path in package.tree.files]
            forms = sorted(_COMMENT.sub(b"", _WINDOW.sub(b"", data)).replace(b"'", b'"').split() for data in files)
            if any(forms):
                yield kind, sha256(repr((kind, forms)).encode()).hexdigest()
