"""The command line's entry: `grader` and `python -m grader`."""

import gc
import sys

_FAULT_OF_USE, _INTERRUPTED = 2, 130


def main() -> None:
    """Run the command line; exits with the code that the command gives."""
    try:
        code = _run(sys.argv[1:])
    except KeyboardInterrupt:
        code = _INTERRUPTED
    if code == _INTERRUPTED:
        print("grader: interrupted", file=sys.stderr)
    sys.exit(code)


def _run(arguments: list[str]) -> int:
    if arguments in (["--version"], ["-V"]):  # answered before anything is imported
        from grader import __version__

        try:
            print(f"grader {__version__}", flush=True)
        except OSError as error:
            print(f"grader: cannot write: {error.strerror}", file=sys.stderr)
            return _FAULT_OF_USE
        return 0
    # One command makes little garbage and ends soon; looking for cycles while modules load costs some 7 % of a run.
    gc.disable()
    from grader.cli.app import run

    return run(arguments)


if __name__ == "__main__":
    # `python -m` looks for modules in the current folder first, which may be a student's: nothing there may be imported.
    if not sys.flags.safe_path:
        del sys.path[0]
    main()
