"""The command line's entry: `grader` and `python -m grader`."""

import sys


def main() -> None:
    """Run the command line; exits with the code that the command gives."""
    if sys.argv[1:] == ["--version"]:  # answered before anything is imported
        from grader import __version__

        print(f"grader {__version__}")
        return
    from grader.cli.app import run

    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
