"""Names of a module that other modules define, imported when they are first asked for."""

import sys
from collections.abc import Callable, Mapping
from importlib import import_module


def late_names(module: str, names_by_module: Mapping[str, str]) -> Callable[[str], object]:
    """Return the `__getattr__` of a module, which imports a name and keeps it.

    Args:
        module: The name of the module.
        names_by_module: The names, separated by blanks, of each module below its package.

    Raises AttributeError for any other name.
    """
    package = module.rpartition(".")[0]
    sources = {name: source for source, names in names_by_module.items() for name in names.split()}

    def import_name(name: str) -> object:
        if name not in sources:
            raise AttributeError(f"module {module!r} has no attribute {name!r}")
        value = getattr(import_module(f"{package}.{sources[name]}"), name)
        setattr(sys.modules[module], name, value)
        return value

    return import_name
