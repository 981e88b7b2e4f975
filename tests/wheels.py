"""Wheels that point to the packages installed here, so that tests of an installation need neither network nor time."""

import re
import sysconfig
import tomllib
import zipfile
from base64 import urlsafe_b64encode
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path

from packaging.requirements import Requirement

from tests.command_line import ROOT

LOCK = "requirements.lock"


def offline(folder: Path) -> dict[str, str]:
    """Make such wheels for all dependencies of the grader, with a lock of them; return the variables that make pip install
    only these.
    """
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    declared = project["project"]
    expected = [
        *project["build-system"]["requires"],
        *declared["dependencies"],
        *declared["optional-dependencies"]["documents"],
    ]
    for requirement in expected:
        _write_wheel(Requirement(requirement).name, folder)
    (folder / LOCK).write_text(_lock_of(folder), encoding="utf-8")
    return {"PIP_NO_INDEX": "1", "PIP_FIND_LINKS": str(folder), "PIP_CONFIG_FILE": "/dev/null"}


def _lock_of(folder: Path) -> str:
    """Return the lines of a lock with the hashes of these wheels."""
    lines = []
    for wheel in sorted(folder.glob("*.whl")):
        name, number, *_ = wheel.name.split("-")
        lines.append(f"{name}=={number} --hash=sha256:{sha256(wheel.read_bytes()).hexdigest()}\n")
    return "".join(lines)


def _write_wheel(package: str, folder: Path) -> None:
    """Write a wheel of a package's name and version whose modules are those installed here."""
    name, number = re.sub(r"[-_.]+", "_", package), version(package)
    about = f"{name}-{number}.dist-info"
    files = {
        f"installed_here_{name}.pth": f"{sysconfig.get_path('purelib')}\n",
        f"{about}/METADATA": f"Metadata-Version: 2.1\nName: {package}\nVersion: {number}\n",
        f"{about}/WHEEL": "Wheel-Version: 1.0\nGenerator: tests\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
    }
    record = "".join(
        f"{path},sha256={_digest(text)},{len(text.encode())}\n" for path, text in files.items()
    )
    with zipfile.ZipFile(folder / f"{name}-{number}-py3-none-any.whl", "w") as wheel:
        for path, text in {**files, f"{about}/RECORD": f"{record}{about}/RECORD,,\n"}.items():
            wheel.writestr(path, text)


def _digest(text: str) -> str:
    return urlsafe_b64encode(sha256(text.encode()).digest()).rstrip(b"=").decode()
