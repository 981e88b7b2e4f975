"""The format of a URDF: the elements that urdfdom reads, their attributes, and the elements that may be in each."""

# What urdfdom reads: the attributes of each element, and the elements that may be in it.
ATTRIBUTES: dict[str, set[str] | frozenset[str]] = {
    "robot": {"name", "version"},
    **dict.fromkeys(("link", "material", "visual", "collision"), frozenset({"name"})),
    "joint": {"name", "type"},
    **dict.fromkeys(("inertial", "geometry"), frozenset[str]()),
    **dict.fromkeys(("parent", "child"), frozenset({"link"})),
    "origin": {"xyz", "rpy"},
    "box": {"size"},
    "cylinder": {"radius", "length"},
    "sphere": {"radius"},
    "mesh": {"filename", "scale"},
    "color": {"rgba"},
    "texture": {"filename"},
    "mass": {"value"},
    "inertia": {"ixx", "ixy", "ixz", "iyy", "iyz", "izz"},
    "axis": {"xyz"},
    "limit": {"lower", "upper", "effort", "velocity"},
    "dynamics": {"damping", "friction"},
    "mimic": {"joint", "multiplier", "offset"},
    "safety_controller": {"soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity"},
    "calibration": {"rising", "falling"},
}
CHILDREN: dict[str, tuple[str, ...]] = {
    "robot": ("link", "joint", "material"),
    "link": ("inertial", "visual", "collision"),
    "visual": ("origin", "geometry", "material"),
    "collision": ("origin", "geometry"),
    "inertial": ("origin", "mass", "inertia"),
    "geometry": ("box", "cylinder", "sphere", "mesh"),
    "material": ("color", "texture"),
    "joint": ("origin", "parent", "child", "axis", "limit", "dynamics", "mimic", "safety_controller", "calibration"),
}
