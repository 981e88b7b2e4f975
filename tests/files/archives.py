"""Build archives for tests: zips and tars with any members."""

import io
import stat
import tarfile
import warnings
import zipfile
from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import NamedTuple

ROBOT = b'<robot name="my_robot"/>\n'
FILES: Mapping[str, bytes | None] = {
    "my_robot/package.xml": b"<package/>\n",
    "my_robot/urdf/my_robot.urdf": ROBOT,
    "my_robot/meshes/": None,
}


class LinkMember(NamedTuple):
    """A link as a member of an archive, to a path relative to its folder or, if it is hard, to the root."""

    name: str
    target: str
    is_hard: bool = False


def make_zip(
    files: Mapping[str, bytes | None] = FILES,
    links: Iterable[LinkMember] = (),
    compression: int = zipfile.ZIP_DEFLATED,
) -> bytes:
    """Make a zip with these files; a name that ends in a slash is a folder."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", compression) as archive:
        for name, content in files.items():
            archive.writestr(name, content or b"")
        for link in links:
            info = zipfile.ZipInfo(link.name)
            info.create_system = 3
            info.external_attr = (stat.S_IFLNK | 0o777) << 16
            archive.writestr(info, link.target)
    return data.getvalue()


def make_named_zip(names: Mapping[bytes, bytes], flags: int = 0) -> bytes:
    """Make a zip whose members have names of these bytes, declared as UTF-8 only by `flags`."""
    stand_ins = {f"{index:06}".ljust(len(name), "_"): name for index, name in enumerate(names)}
    data = make_zip(
        {name: names[real] for name, real in stand_ins.items()}, compression=zipfile.ZIP_STORED
    )
    for stand_in, name in stand_ins.items():
        data = data.replace(stand_in.encode(), name)
    return set_flags(data, flags) if flags else data


def set_flags(data: bytes, flags: int) -> bytes:
    """Return a zip with flags set in every header, local and central."""
    made = bytearray(data)
    for signature, offset in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        start = -1
        while (start := made.find(signature, start + 1)) >= 0:
            made[start + offset] |= flags & 0xFF
            made[start + offset + 1] |= flags >> 8
    return bytes(made)


def make_tar(
    files: Mapping[str, bytes | None] = FILES,
    links: Iterable[LinkMember] = (),
    kind: str = "",
    style: int = tarfile.PAX_FORMAT,
    change: Callable[[tarfile.TarInfo], None] = lambda _: None,
) -> bytes:
    """Make a tar with these files, compressed by `kind` (gz, bz2, xz); `change` is applied to every entry."""
    data = io.BytesIO()
    mode = f"w:{kind}" if kind else "w"
    with tarfile.open(fileobj=data, mode=mode, format=style) as archive:  # type: ignore[call-overload]
        for name, content in files.items():
            info = tarfile.TarInfo(name.rstrip("/"))
            if content is None:
                info.type = tarfile.DIRTYPE
            info.size = len(content or b"")
            change(info)
            archive.addfile(info, io.BytesIO(content or b""))
        for link in links:
            info = tarfile.TarInfo(link.name)
            info.type, info.linkname = (
                (tarfile.LNKTYPE if link.is_hard else tarfile.SYMTYPE),
                link.target,
            )
            archive.addfile(info)
    return data.getvalue()


def twice(name: str, first: bytes, second: bytes) -> bytes:
    """Make a zip with two members of the same name."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        archive.writestr(name, first)
        archive.writestr(name, second)
    return data.getvalue()


MAKERS: dict[str, Callable[..., bytes]] = {
    ".zip": make_zip,
    ".tar": make_tar,
    ".tar.gz": partial(make_tar, kind="gz"),
    ".tar.bz2": partial(make_tar, kind="bz2"),
    ".tar.xz": partial(make_tar, kind="xz"),
}
