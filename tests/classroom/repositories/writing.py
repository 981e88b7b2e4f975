"""Write the repositories of the table into a class folder."""

from collections.abc import Iterable
from pathlib import Path

from tests.classroom.repositories.contents import EXTRAS, Contents, package, robot, zipped
from tests.classroom.repositories.spellings import MAIN, SPELLINGS
from tests.classroom.repositories.table import Row, Work

LAUNCH_FILE = "launch/my_robot_rviz.launch.py"


def write_class(folder: Path, rows: Iterable[Row]) -> Path:
    """Write a repository for each row, and return the folder."""
    for row in rows:
        (folder / row.name).mkdir(parents=True)
        for path, data in _contents(row).items():
            target = folder / row.name / path
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(data)
    return folder


def _contents(row: Row) -> Contents:
    found: Contents = {}
    for kind, folder in row.extras:
        found |= _below(folder, EXTRAS[kind]())
    for work in row.works.values():
        found |= _of_work(work)
    if row.zipped:
        inside = {path: data for path, data in found.items() if path.startswith(f"{row.zipped}/")}
        found = {path: data for path, data in found.items() if path not in inside}
        found[f"{row.zipped}/{row.name}.zip"] = zipped(inside)
    return found


def _of_work(work: Work) -> Contents:
    folder, _, name = work.path.rpartition("/")
    files = SPELLINGS[work.spelling](robot(work.sample))
    found = _below(
        folder, {name if file == MAIN else file: text.encode() for file, text in files.items()}
    )
    if work.package is not None:
        content = package(work.launched, work.package_name)
        if work.installed_as:
            for path in ("setup.py", LAUNCH_FILE):
                content[path] = content[path].replace(
                    b"'my_robot'", f"'{work.installed_as}'".encode()
                )
            content[f"resource/{work.installed_as}"] = content.pop("resource/my_robot")
        if "launch-found" in work.lost:  # its extension was lost
            content[LAUNCH_FILE.removesuffix(".launch.py")] = content.pop(LAUNCH_FILE)
        found |= _below(work.package, content)
    return found


def _below(folder: str, contents: Contents) -> Contents:
    return {f"{folder}/{path}" if folder else path: data for path, data in contents.items()}
