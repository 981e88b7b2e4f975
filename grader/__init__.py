"""Grade robotics lab submissions by what the robot does. The Python API is small: all other names are private."""

from importlib import import_module

__version__ = "1.0.0"

_MODULES = {
    "Configuration": "robot.kinematics", "GraderError": "errors", "MissingElement": "errors",
    "Reading": "robot.reader", "Report": "grading.report", "Result": "grading.report", "Rubric": "grading.rubric",
    "RubricError": "errors", "grade": "api", "load_rubric": "grading.rubric", "read_urdf": "robot.reader",
}  # fmt: skip


def __getattr__(name: str) -> object:
    """Return a public name; its module is imported when it is used, because most commands need few of them."""
    if name not in _MODULES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return sorted({"__doc__", "__version__", *_MODULES})
