"""The entry point of `grader` and `python -m grader`."""

import gc
import os
import sys
from types import ModuleType

_NOT_GRADED, _FAULT, _INTERRUPTED = 2, 3, 130  # as in grader.commands.exit_codes, which is not imported for --version

# Libraries import these modules of the standard library, and most commands use nothing of them.
_LATE = ("bz2", "ipaddress", "linecache", "lzma", "subprocess", "textwrap", "tokenize")


class _LateModule(ModuleType):
    """A module that is loaded when something of it is used. LazyLoader loads it when it is imported a second time."""

    def __getattr__(self, name: str) -> object:
        if sys.modules.get(self.__name__) is self:
            sys.modules.pop(self.__name__, None)  # another thread may be faster
        module = __import__(self.__name__)
        vars(self).update(vars(module))
        return getattr(module, name)


def main() -> None:
    """Run the command line and exit with its code, which no `os._exit` of a plug-in check changes."""
    code: int | None = None
    leave, process = os._exit, os.getpid()

    def end(status: int) -> None:
        if os.getpid() != process:
            leave(status)
        if code is None:
            print("grader: a plug-in check has ended the process", file=sys.stderr, flush=True)
        leave(_FAULT if code is None else code)

    os._exit = end  # type: ignore[assignment]  # importing NoReturn takes longer than printing the version
    try:
        code = _run(sys.argv[1:])
    except KeyboardInterrupt:
        code = _INTERRUPTED
    if code == _INTERRUPTED:
        print("grader: interrupted", file=sys.stderr)
    gc.freeze()  # else Python searches all objects for garbage before it ends: a fifth of a run
    sys.exit(code)


def _run(arguments: list[str]) -> int:
    if arguments in (["--version"], ["-V"]):  # needs no other import
        from grader import __version__

        try:
            print(f"grader {__version__}", flush=True)
        except OSError as error:
            print(f"grader: cannot write: {error.strerror}", file=sys.stderr)
            return _NOT_GRADED
        return 0
    # One command makes little garbage and ends soon; collecting it while modules load takes some 7 % of a run.
    gc.disable()
    for name in _LATE:
        sys.modules.setdefault(name, _LateModule(name))
    from grader.cli.app import run

    return run(arguments)


if __name__ == "__main__":
    if not sys.flags.safe_path:
        del sys.path[0]
    main()
