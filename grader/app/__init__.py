"""The commands of one submission, the command line, the Python API, the Gradescope bundle."""
