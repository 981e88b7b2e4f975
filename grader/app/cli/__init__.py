"""The commands: parse arguments, call one function of `commands`, print, exit.

It imports `commands`, and is the only package with typer. Begin with `app.py`.
"""
