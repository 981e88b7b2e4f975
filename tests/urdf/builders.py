"""Builders of small URDFs."""


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
