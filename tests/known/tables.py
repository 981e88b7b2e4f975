"""Write the tables of the files of packages that scripts make."""

from grader.ros.known.package_files import FOLDER


def write_tables(package: str, tables: str) -> None:
    """Write tables, which begin with a comment that says who makes them, to the file of a package:
    in place of those from this comment on, or at its end.
    """
    path = FOLDER / f"{package}.toml"
    before = path.read_text("utf-8") if path.is_file() else ""
    comment = tables.partition("\n")[0]
    kept = before.partition(comment)[0].rstrip("\n")
    path.write_text("\n\n".join(filter(None, [kept, tables])), encoding="utf-8")
