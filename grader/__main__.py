"""The entry point of `grader` and `python -m grader`."""

import gc
import sys

_NOT_GRADED, _INTERRUPTED = (
    2,
    130,
)  # as in grader.report.invocation, which is not imported for --version


def main() -> None:
    """Run the command line and exit with its code."""
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
    # One command makes little garbage and ends soon; collecting it while modules load takes some 7
    # % of a run.
    gc.disable()
    from grader.app.cli.app import run

    return run(arguments)


if __name__ == "__main__":
    if not sys.flags.safe_path:
        del sys.path[0]
    main()
