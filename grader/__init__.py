"""Grade robotics lab submissions by what the robot does.

The names below are the Python API, which docs/python.md describes; all others are private. Lengths
are in metres, angles in radians about fixed axes x, y, z (REP 103), and each pose is that of a
named frame in another one.
"""

from importlib import import_module

__version__ = "0.9.0"

_MODULES = {
    "Configuration": "ros.api",
    "GraderError": "base.errors",
    "Joint": "ros.api",
    "Link": "ros.api",
    "MissingElement": "base.errors",
    "Reading": "ros.api",
    "Report": "lab.grading.report",
    "Result": "lab.grading.report",
    "Robot": "ros.api",
    "Rubric": "lab.rubric.rubric",
    "RubricError": "base.errors",
    "Transform": "base.transforms",
    "grade": "app.api",
    "load_rubric": "lab.rubric.rubric",
    "read_urdf": "ros.api",
}
__all__ = list(_MODULES)


def __getattr__(name: str) -> object:
    """Return a public name, whose module is imported when it is used.

    Most commands need few of them.
    """
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({"__all__", "__doc__", "__version__", *_MODULES})
