"""An edge case, and the builders that keep each case to a line or two."""

from dataclasses import dataclass
from typing import Literal

Verdict = Literal["clean", "degraded", "rejected"]
Oracle = Literal["agrees", "hangs", "aborts"]


@dataclass(frozen=True, slots=True)
class EdgeCase:
    """One file and ROS 2's verdict on it; a program that hangs or crashes on a file has rejected it."""

    name: str
    rule: str
    text: bytes
    verdict: Verdict
    oracle: Oracle = "agrees"


def clean(name: str, rule: str, text: str | bytes) -> EdgeCase:
    """A file that loads whole."""
    return EdgeCase(name, rule, _encoded(text), "clean")


def degraded(name: str, rule: str, text: str | bytes) -> EdgeCase:
    """A file that loads, with an error in the log or with something left out."""
    return EdgeCase(name, rule, _encoded(text), "degraded")


def rejected(name: str, rule: str, text: str | bytes, oracle: Oracle = "agrees") -> EdgeCase:
    """A file that does not load."""
    return EdgeCase(name, rule, _encoded(text), "rejected", oracle)


def robot(body: str, attributes: str = 'name="r"') -> str:
    """A robot that holds these links and joints."""
    return f"<robot {attributes}>{body}</robot>"


def one_link(body: str = "") -> str:
    """A robot with a single link that holds this."""
    return robot(f'<link name="base">{body}</link>')


def joint(parent: str, child: str, name: str = "j", *, kind: str = "fixed", body: str = "") -> str:
    """A joint from link to link; the body follows its `<parent>` and `<child>`."""
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{body}</joint>'


def links(*names: str) -> str:
    """Bare links with these names."""
    return "".join(f'<link name="{name}"/>' for name in names)


def one_joint(body: str = "", kind: str = "fixed") -> str:
    """A robot of two links whose joint holds this."""
    return robot(links("a", "b") + joint("a", "b", kind=kind, body=body))


def reference(name: str, child: str) -> str:
    """A robot that loads if these two spell the same name: a link has the one, and a joint names the other."""
    return robot(links("root", name) + joint("root", child))


def visual(body: str) -> str:
    """A visual that holds this after a good geometry."""
    return f'<visual><geometry><box size="1 1 1"/></geometry>{body}</visual>'


def geometry(shape: str) -> str:
    """A robot whose link shows this shape."""
    return one_link(f"<visual><geometry>{shape}</geometry></visual>")


def with_bytes(text: str, raw: bytes) -> bytes:
    """This text with raw bytes for each @, to put what no text can hold into it."""
    return text.encode().replace(b"@", raw)


def _encoded(text: str | bytes) -> bytes:
    return text.encode() if isinstance(text, str) else text
