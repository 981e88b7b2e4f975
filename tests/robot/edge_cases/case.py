"""An edge case, and builders that keep each case to a line or two."""

from dataclasses import dataclass
from typing import Literal

Verdict = Literal["clean", "degraded", "rejected"]
Oracle = Literal["agrees", "hangs", "aborts"]


@dataclass(frozen=True, slots=True)
class EdgeCase:
    """A file and ROS 2's verdict on it; a program that hangs or crashes on a file has rejected it."""

    name: str
    rule: str
    text: bytes
    verdict: Verdict
    oracle: Oracle = "agrees"


def clean(name: str, rule: str, text: str | bytes) -> EdgeCase:
    """Return the case of a file that loads completely."""
    return EdgeCase(name, rule, _encoded(text), "clean")


def degraded(name: str, rule: str, text: str | bytes) -> EdgeCase:
    """Return the case of a file that loads with an error in the log or with something omitted."""
    return EdgeCase(name, rule, _encoded(text), "degraded")


def rejected(name: str, rule: str, text: str | bytes, oracle: Oracle = "agrees") -> EdgeCase:
    """Return the case of a file that does not load."""
    return EdgeCase(name, rule, _encoded(text), "rejected", oracle)


def robot(body: str, attributes: str = 'name="r"') -> str:
    """Return a robot with these links and joints."""
    return f"<robot {attributes}>{body}</robot>"


def one_link(body: str = "") -> str:
    """Return a robot with a single link with this content."""
    return robot(f'<link name="base">{body}</link>')


def joint(parent: str, child: str, name: str = "j", *, kind: str = "fixed", body: str = "") -> str:
    """Return a joint from link to link; the body follows its `<parent>` and `<child>`."""
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{body}</joint>'


def links(*names: str) -> str:
    """Return empty links with these names."""
    return "".join(f'<link name="{name}"/>' for name in names)


def one_joint(body: str = "", kind: str = "fixed") -> str:
    """Return a robot of two links whose joint has this content."""
    return robot(links("a", "b") + joint("a", "b", kind=kind, body=body))


def reference(name: str, child: str) -> str:
    """Return a robot that loads if both spell the same name: a link has one, and a joint names the other."""
    return robot(links("root", name) + joint("root", child))


def visual(body: str) -> str:
    """Return a visual with this content after a correct geometry."""
    return f'<visual><geometry><box size="1 1 1"/></geometry>{body}</visual>'


def geometry(shape: str) -> str:
    """Return a robot whose link shows this shape."""
    return one_link(f"<visual><geometry>{shape}</geometry></visual>")


def with_bytes(text: str, raw: bytes) -> bytes:
    """Return this text with raw bytes for each @, for bytes that no text can contain."""
    return text.encode().replace(b"@", raw)


def _encoded(text: str | bytes) -> bytes:
    return text.encode() if isinstance(text, str) else text
